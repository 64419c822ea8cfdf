// Trouble that is not our mistake, each kind with the exit code that main gives it.
#pragma once

#include <stdexcept>
#include <string>

namespace trocar {

enum class ExitCode { done = 0, input = 2, simulation = 3, machine = 4, stopped = 75 };

// Where a value stands in the user's file; line and column count from 1, 0 means unknown.
struct SourcePlace {
  std::string file;
  int line = 0;
  int column = 0;
};

// What the user gave is wrong. what() is "file:line:column: what is wrong, what is allowed".
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& sentence) : std::runtime_error(sentence) {}
  InputError(const SourcePlace& place, const std::string& sentence);
};

// The physics went wrong (inversion, non-finite values) and can't be continued.
class SimulationError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Disk, memory, a rank, the renderer or another program failed; on one rank unless it says
// otherwise.
class MachineError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The same, thrown on every rank alike: all can leave in good order.
class SharedMachineError : public MachineError {
  using MachineError::MachineError;
};

}  // namespace trocar
