// Threads of this rank: one team, made when it is first needed. The steps of a body are a few
// hundred microseconds long, so that threads hand over to each other by looking, not by sleeping;
// but they look politely, so that whoever else wants the core gets it (docs/performance.md).
#pragma once

#include <cstdint>
#include <string>

namespace trocar {

// Number of threads of this thread's parallel_for from now on (>= 1; 1 until it is set).
void set_thread_count(int n_threads);
int thread_count();
// Cores that this process may run on (affinity mask), and their numbers: "0 1 4".
int available_cores();
std::string core_list();

// Calls call(body, chunk) for each of n_chunks on as many threads, the caller's among them; on the
// caller's alone if another thread has the team, or from within such a call.
void run_chunks(int n_chunks, void (*call)(const void* body, int chunk), const void* body);

// Chunks that parallel_for makes of n items.
inline int chunk_count(std::int64_t n) {
  return n < 64 ? 1 : thread_count();
}
// Calls body(chunk) for each of n_chunks, one per thread. No exception may leave `body`.
template <class Body>
void parallel_for_chunks(int n_chunks, const Body& body) {
  if (n_chunks > 1)
    run_chunks(
        n_chunks, [](const void* it, int chunk) { (*static_cast<const Body*>(it))(chunk); }, &body);
  else if (n_chunks == 1)
    body(0);
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
