// Signals that ask a run to stop: SIGTERM, SIGINT, SIGHUP, SIGUSR1. The first is remembered, so
// that the run can end where all is kept; a second one ends the process.
#pragma once

#include <atomic>

namespace trocar {

// From now on; SIGHUP only where nohup has not switched it off. SIGXFSZ, a file grown to its limit,
// becomes a write that fails. First thing in the program: starting MPI takes a while, in which a
// batch system may already signal.
void listen_to_stop_signals();

// Whether one has come, for whoever looks again and again.
const std::atomic<bool>& stop_asked();

}  // namespace trocar
