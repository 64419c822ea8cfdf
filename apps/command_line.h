// The command line as data. CLI11 is seen by command_line.cpp alone.
#pragma once

#include <string>

#include "apps/command_cut2d.h"
#include "apps/command_study.h"
#include "apps/commands.h"
#include "base/error.h"

namespace trocar {

enum class Command { run, check, study, cut2d, replay, mesh, doctor, help_scene, help_tissues };

struct CommandLine {
  Command command = Command::run;
  MachineOptions machine;
  RunOptions run;
  ReplayOptions replay;
  StudyOptions study;
  Cut2dCommand cut2d;
  std::string mesh_file, mesh_scale = "1 m";
  bool is_markdown = false;
};

// False if the program should end at once with `code`: help was printed, or the line is wrong (exit
// code 2, one sentence, the nearest known word).
bool parse_command_line(int argc, char** argv, CommandLine& line, ExitCode& code);

ExitCode run_command(const CommandLine& line, Communicator& communicator);

}  // namespace trocar
