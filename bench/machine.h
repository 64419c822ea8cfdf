// What the cores of this rank's threads can do at the moment, all at once, measured beside whatever
// is compared with it: others may use the machine.
#pragma once

#include <algorithm>

#include "base/communicator.h"
#include "base/threads.h"
#include "base/timers.h"

namespace trocar {

// One thread is timed by its processor time, several by the wall clock. [s]
inline double bench_seconds() {
  return thread_count() > 1 ? monotonic_seconds() : thread_seconds();
}

// Best of 7 runs of at least 20 ms.
template <class Body>
double best_seconds(const Body& body) {
  double best = 1e300;
  for (int run = 0; run < 7; ++run) {
    int n = 0;
    const double start = bench_seconds();
    double elapsed = 0;
    while (elapsed < 0.02) {
      body();
      ++n;
      elapsed = bench_seconds() - start;
    }
    best = std::min(best, elapsed / n);
  }
  return best;
}

// Of the slowest rank, best of some rounds; clock() [s].
template <class Work>
double best_of_ranks(const Communicator& ranks, int n_rounds, const Work& work,
                     double (*clock)() = monotonic_seconds) {
  double best = 1e300;
  for (int round = 0; round < n_rounds; ++round) {
    ranks.barrier();
    const double start = clock();
    work();
    best = std::min(best, ranks.all_max(clock() - start));
  }
  return best;
}

// 10^9 double-precision operations a second with AVX-512; 0 without.
double peak_gflops();
// a = b + c s over arrays that no cache holds, 24 bytes a number. [10^9 bytes/s]
double triad_gbytes();

}  // namespace trocar
