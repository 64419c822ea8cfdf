// Where a step's time goes: nanoseconds of its parts per element, one thread, neo-Hookean. JSON to
// stdout. bench_parts [elements, about (default 8000)] [instruction set (default the widest)]
#include <cstdlib>

#include "bench/machine.h"
#include "bench/step_parts.h"
#include "bench/usage.h"

using namespace trocar;

int main(int argc, char** argv) {
  constexpr const char* usage = "bench_parts [elements (8000)] [instruction set (auto)]";
  if (const int code = answer_options(argc, argv, usage); code >= 0) return code;
  const int n_elements = argc > 1 ? std::atoi(argv[1]) : 8000;
  if (n_elements < 1) return print_usage(usage, stderr);
  select_simd(argc > 2 ? argv[2] : "auto");
  std::printf("{\"simd\": \"%s\", \"peak_gflops\": %.1f, \"triad_gbytes\": %.1f, \"parts\": [",
              simd_name(), peak_gflops(), triad_gbytes());
  report_parts(n_elements, [](const auto& parts) {
    // In turn, so that all have met the machine at its best.
    std::array<double, n_step_parts> ns;
    ns.fill(1e300);
    for (int round = 0; round < 5; ++round)
      for (std::size_t k = 0; k < ns.size(); ++k)
        ns[k] = std::min(ns[k], 1e9 * best_seconds(parts[k]));
    return ns;
  });
  std::printf("\n]}\n");
}
