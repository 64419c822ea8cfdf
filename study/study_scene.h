// A scene as a problem: the sweep changes its cells (or its mesh file), elements, precision and
// step, runs it without outputs, and compares the surface's displacements with the finest run's.
#pragma once

#include <string>
#include <vector>

#include "base/communicator.h"
#include "study/study_problem.h"

namespace trocar {

struct SceneStudyOptions {
  std::string scene_file;
  std::vector<std::string> overrides;  // "key.path=value"
  // Coarse to fine, for scenes whose body is a mesh file; relative to the working folder.
  std::vector<std::string> meshes;
  std::vector<std::string> sleeps;  // solver.sleep: "0", "0.1 mm"; empty: the scene's
  std::vector<int>
      sizes;  // cells along the direction with most, for generated bodies; may be empty
};

// The communicator (of one rank) must outlive the problem. Throws InputError, for bodies that are
// cut too: a cut through another mesh has other nodes on its sides, so displacements can't be
// compared.
Problem problem_of_scene(const SceneStudyOptions& options, Communicator& communicator);

}  // namespace trocar
