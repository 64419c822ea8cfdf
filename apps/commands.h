// The sub-commands of `trocar`, each with its options; they return an exit code.
#pragma once

#include <string>
#include <vector>

#include "base/communicator.h"
#include "engine/replay.h"
#include "engine/run.h"

namespace trocar {

// How much of the machine to use.
struct MachineOptions {
  int threads = 0;  // 0: cores of this host / ranks on it
  std::string simd = "auto";
  bool is_quiet = false;
  int patience = 60;  // with a rank of this host that is stopped [s]
};

void use_machine(const MachineOptions& machine, const Communicator& communicator);

ExitCode command_run(const RunOptions& options, Communicator& communicator);
ExitCode command_check(const RunOptions& options, Communicator& communicator);
ExitCode command_replay(const ReplayOptions& options);
// Sizes, quality, stable step with the default material; all broken invariants of a mesh that can
// be read (flat, inverted and doubled corners can not: the first one is told).
ExitCode command_mesh(const std::string& file, const std::string& scale);
ExitCode command_doctor(const Communicator& communicator);
// All keys of a scene file; as Markdown for docs/scene.md.
ExitCode command_help_scene(bool is_markdown);
// The tissues that a scene can name; as Markdown for docs/tissues.md.
ExitCode command_help_tissues(bool is_markdown);

}  // namespace trocar
