// A scene as text, read and built by this process alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/apply_cut.h"
#include "engine/build.h"
#include "engine/frame.h"
#include "error_of.h"
#include "test_files.h"

namespace trocar {

struct Started {
  Started();
  ~Started();
  TestFolder folder;  // of the scene and what it writes
  LoadedScene loaded;
  Communicator alone;
  std::unique_ptr<Simulation> s;
  Outputs outputs;
};

std::unique_ptr<Started> built(const std::string& text,
                               const std::vector<std::string>& overrides = {});

// A block of n^3 irregular tetrahedra or hexahedra, at rest.
std::unique_ptr<Started> block_of(const std::string& elements, int n = 4);

// What a blade would do to the body, not done: it goes at once through all of a body within 2 cm of
// the z axis, 18 degrees off the level, at z = 15 mm.
MeshEdit cut_across(const Simulation& s, const GlobalState& global, CutFigures& figures);

}  // namespace trocar
