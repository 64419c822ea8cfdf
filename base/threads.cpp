// The number of threads lives in OpenMP's own setting of the calling thread; nothing is stored
// here.
#include "base/threads.h"

#include <omp.h>
#include <sched.h>

#include <cerrno>

#include "base/check.h"

namespace trocar {

void set_thread_count(int n_threads) {
  CHECK_OP(n_threads, >=, 1);
  omp_set_num_threads(n_threads);
}

int thread_count() {
  return omp_get_max_threads();
}

int available_cores() {
  // The kernel refuses a mask that is too small for the machine; 1024 cores fit most.
  for (int n_cores = 1024; n_cores <= 1 << 20; n_cores *= 2) {
    cpu_set_t* mask = CPU_ALLOC(n_cores);
    CHECK(mask != nullptr);
    const std::size_t size = CPU_ALLOC_SIZE(n_cores);
    const bool is_known = sched_getaffinity(0, size, mask) == 0;
    const bool is_too_small = !is_known && errno == EINVAL;
    const int n_available = is_known ? CPU_COUNT_S(size, mask) : 1;
    CPU_FREE(mask);
    if (!is_too_small) return n_available;
  }
  return 1;
}

}  // namespace trocar
