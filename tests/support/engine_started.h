// A scene as text, read and built by this process alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/log.h"
#include "base/threads.h"
#include "engine/build.h"
#include "engine/frame.h"
#include "engine_files.h"

namespace trocar {

struct Started {
  LoadedScene loaded;
  Communicator alone;
  std::unique_ptr<Simulation> s;
  Outputs outputs;
};

inline std::unique_ptr<Started> built(const std::string& text,
                                      const std::vector<std::string>& overrides = {}) {
  start_log(0, true);
  set_thread_count(1);
  const TestFolder folder;
  auto started = std::make_unique<Started>();
  started->loaded = load_scene(write_text(folder.file("s.toml"), text), overrides);
  started->s = build(started->loaded, started->alone);
  return started;
}

}  // namespace trocar
