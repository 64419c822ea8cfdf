// Threads of this rank. The only OpenMP pragma of the program is here.
#pragma once

#include <cstdint>

namespace trocar {

// Number of threads of parallel_for from now on (>= 1).
void set_thread_count(int n_threads);
int thread_count();
// Cores that this process may run on (affinity mask).
int available_cores();

// Chunks that parallel_for makes of n items.
inline int chunk_count(std::int64_t n) {
  return n < 64 ? 1 : thread_count();
}
// Calls body(chunk) for each of n_chunks, one per thread. No exception may leave `body`.
template <class Body>
void parallel_for_chunks(int n_chunks, const Body& body) {
#pragma omp parallel for schedule(static, 1) num_threads(n_chunks) if (n_chunks > 1)
  for (int chunk = 0; chunk < n_chunks; ++chunk) body(chunk);
}

// Calls body(begin, end) for consecutive chunks of [0, n), one per thread. Which thread runs a
// chunk and how many chunks there are must not matter to the result. No exception may leave `body`.
template <class Body>
void parallel_for(std::int64_t n, const Body& body) {
  const int n_chunks = chunk_count(n);
  if (n_chunks == 1) return body(std::int64_t{0}, n);
  parallel_for_chunks(n_chunks,
                      [&](int chunk) { body(n * chunk / n_chunks, n * (chunk + 1) / n_chunks); });
}

}  // namespace trocar
