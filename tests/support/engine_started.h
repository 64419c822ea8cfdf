// A scene as text, read and built by this process alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/build.h"
#include "engine/frame.h"
#include "engine_files.h"

namespace trocar {

struct Started {
  Started();
  ~Started();
  LoadedScene loaded;
  Communicator alone;
  std::unique_ptr<Simulation> s;
  Outputs outputs;
};

std::unique_ptr<Started> built(const std::string& text,
                               const std::vector<std::string>& overrides = {});

}  // namespace trocar
