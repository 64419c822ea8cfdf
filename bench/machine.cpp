#include "bench/machine.h"

#include <vector>

#include "solver/simd.h"

namespace trocar {

namespace {

constexpr int n_chains = 8, n_rounds = 1'000'000;  // 2 ms: waking a thread takes 50 us

// Eight independent chains of fused multiply-adds: two units with a latency of four cycles.
[[gnu::target("avx512f"), gnu::noinline]] double run_chains() {
  using Pack = double __attribute__((vector_size(64)));
  const Pack m = Pack{} + 1e-9;
  Pack a = m, b = m, c = m, d = m, e = m, f = m, g = m, h = m;
  for (int round = 0; round < n_rounds; ++round)
    asm volatile(
        "vfmadd213pd %8, %8, %0\n vfmadd213pd %8, %8, %1\n vfmadd213pd %8, %8, %2\n"
        "vfmadd213pd %8, %8, %3\n vfmadd213pd %8, %8, %4\n vfmadd213pd %8, %8, %5\n"
        "vfmadd213pd %8, %8, %6\n vfmadd213pd %8, %8, %7"
        : "+v"(a), "+v"(b), "+v"(c), "+v"(d), "+v"(e), "+v"(f), "+v"(g), "+v"(h)
        : "v"(m));
  return (a + b + c + d + e + f + g + h)[0];
}

}  // namespace

double peak_gflops() {
  if (!is_supported(Simd::avx512)) return 0;
  const int n_threads = thread_count();
  const double best = best_seconds([&] {
    parallel_for_chunks(n_threads,
                        [](int) { [[maybe_unused]] volatile double sink = run_chains(); });
  });
  return 1e-9 * n_threads * n_chains * n_rounds * 8 * 2 / best;
}

double triad_gbytes() {
  constexpr std::int64_t n = 20'000'000;
  std::vector<double> a(n), b(n, 1.0), c(n, 2.0);
  const double best = best_seconds([&] {
    parallel_for(n, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) a[i] = b[i] + 3 * c[i];
    });
    asm volatile("" ::"r"(a.data()) : "memory");
  });
  return 1e-9 * 24 * n / best;
}

}  // namespace trocar
