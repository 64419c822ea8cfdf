// Says so when a rank on this host is gone: mpirun then ends the others within a second or two, and
// its own message is about MPI. Or when one is stopped (SIGSTOP, a debugger), for which the others
// would wait for ever. Linux; other hosts' ranks are told by those beside them.
#pragma once

#include <memory>

#include "base/communicator.h"

namespace trocar {

// A thread that sleeps until a rank of this host ends (two of a host look once a second for stopped
// ones), and then writes one line to standard error,
// by the lowest rank that is left. It ends this rank with ExitCode::machine if mpirun has not done
// so in ten seconds (Open MPI's own end can hang), or if a rank has been stopped for as long as
// patience allows while this one was not. For as long as ranks may not end: from behind MPI_Init to
// before MPI_Finalize, which waits for all.
class PeerWatch {
 public:
  // Collective.
  PeerWatch(const Communicator& communicator, int patience_seconds);
  ~PeerWatch();
  PeerWatch(const PeerWatch&) = delete;
  PeerWatch& operator=(const PeerWatch&) = delete;

 private:
  struct Thread;
  std::unique_ptr<Thread> thread_;  // none where this rank is alone on its host
};

}  // namespace trocar
