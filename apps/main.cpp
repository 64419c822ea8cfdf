// trocar: headless real-time surgical simulation. Reads the command line, calls one command, turns
// trouble into exit codes.
#include <cstdio>
#include <exception>
#include <new>

#include "apps/command_line.h"
#include "base/communicator.h"
#include "base/error.h"
#include "base/heap.h"
#include "base/log.h"
#include "base/peer_watch.h"
#include "base/stop_signals.h"

// What was asked for on standard output must not be lost in silence, e.g. on a full disk.
static bool was_printed() {
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

static constexpr const char* not_printed = "standard output can't be written";

int main(int argc, char** argv) {
  using namespace trocar;
  keep_freed_memory();
  CommandLine line;
  ExitCode code = ExitCode::done;
  if (!parse_command_line(argc, argv, line, code)) {
    if (was_printed()) return static_cast<int>(code);
    std::fprintf(stderr, "trocar: error: %s\n", not_printed);
    return static_cast<int>(ExitCode::machine);
  }

  if (line.command == Command::run) listen_to_stop_signals();
  MpiSession session(&argc, &argv);
  const int rank = session.world().rank();
  start_log(rank, line.machine.is_quiet);
  const PeerWatch watch(session.world(), line.machine.patience);
  try {
    code = run_command(line, session.world());
    if (!was_printed()) throw MachineError(not_printed);
    return static_cast<int>(code);
  } catch (const InputError& trouble) {  // thrown on every rank alike
    code = ExitCode::input;
    log_error(trouble.what());
  } catch (const SimulationError& trouble) {  // thrown on every rank alike
    code = ExitCode::simulation;
    log_error(trouble.what());
  } catch (const SharedMachineError& trouble) {
    code = ExitCode::machine;
    log_error(trouble.what());
  } catch (const std::bad_alloc&) {  // this rank alone may know of it, or of what else there is
    std::fprintf(stderr,
                 "trocar: error: rank %d is out of memory: take a coarser mesh, "
                 "solver.precision = \"single\", or more hosts\n",
                 rank);
    abort_all_ranks(static_cast<int>(ExitCode::machine));
  } catch (const std::exception& trouble) {
    std::fprintf(stderr, "trocar: error: %s\n", trouble.what());
    abort_all_ranks(static_cast<int>(ExitCode::machine));
  }
  return static_cast<int>(code);
}
