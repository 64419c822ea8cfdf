// Threads of this rank. The only OpenMP pragma of the program is here.
#pragma once

#include <cstdint>

namespace trocar {

// Number of threads of parallel_for from now on (>= 1).
void set_thread_count(int n_threads);
int thread_count();
// Cores that this process may run on (affinity mask).
int available_cores();

// Calls body(begin, end) for consecutive chunks of [0, n), one per thread. Which thread runs a
// chunk and how many chunks there are must not matter to the result. No exception may leave `body`.
template <class Body>
void parallel_for(std::int64_t n, const Body& body) {
  const int n_chunks = n < 64 ? 1 : thread_count();
  if (n_chunks == 1) return body(std::int64_t{0}, n);
#pragma omp parallel for schedule(static, 1) num_threads(n_chunks)
  for (int chunk = 0; chunk < n_chunks; ++chunk)
    body(n * chunk / n_chunks, n * (chunk + 1) / n_chunks);
}

}  // namespace trocar
