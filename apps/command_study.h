// `trocar study`: run time against error of a built-in problem or a scene.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "base/communicator.h"
#include "base/error.h"
#include "study/study_sweep.h"

namespace trocar {

struct StudyOptions {
  std::string subject;  // name of a problem, or a scene file
  std::string folder = "study";
  std::string target;  // "1 mm", "1 %"; empty: the median error
  SweepOptions sweep;
  std::vector<std::string> meshes, sleeps, overrides;  // of a scene
  bool list = false, all = false;
  std::string docs;  // folder for accuracy.md of --all
};

// On one rank and one thread. Throws InputError.
ExitCode command_study(const StudyOptions& options, Communicator& communicator);

}  // namespace trocar
