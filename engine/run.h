// A whole run: from the scene file to summary.json.
#pragma once

#include <string>
#include <vector>

#include "base/communicator.h"
#include "engine/scene.h"

namespace trocar {

struct RunOptions {
  std::string scene_file;
  std::string folder = "out";
  std::vector<std::string> overrides;  // "key.path=value"
  bool is_resumed = false;             // from the checkpoint in `folder`
};

// Rank 0 reads and checks; every rank gets the same scene. Collective; InputErrors are thrown on
// every rank.
LoadedScene share_scene(const std::string& file, const std::vector<std::string>& overrides,
                        Communicator& communicator);

// Runs it and writes everything, summary.json last. Collective. Throws SimulationError, and
// SharedMachineError where an output can't be written, after writing what there is. Returns true if
// the run went through, false if a signal (base/stop_signals.h) stopped it at a frame's end.
bool run_scene(const RunOptions& options, Communicator& communicator);

}  // namespace trocar
