// Nanoseconds of one whole step per element on ranks x threads, by the wall clock of the slowest
// rank: forces, motion, exchange with the neighbours. Beside it what travels, how long a rank waits
// for it, how much of the elements is computed twice, and the multiply-add peak and the memory
// bandwidth of all cores at once (ranks times the slowest). JSON to stdout.
// [mpirun -np RANKS] bench_step [elements, about (default 100000)] [threads of a rank]
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/communicator.h"
#include "bench/jittered_body.h"
#include "bench/machine.h"
#include "bench/usage.h"

using namespace trocar;

namespace {

struct Timing {
  double step = 0, waited = 0;  // of a step [s]
};

void run_steps(Body& body, Neighbours& neighbours, int n) {
  for (int k = 0; k < n; ++k) {
    start_exchange(neighbours, body.state);
    step_freely(body.model, neighbours, 1e-9, body.state, body.scratch);
  }
}

// Best of many rounds, each shorter than a slice of a core's time: others may use the machine, but
// not all the time.
Timing measure(Body& body, Neighbours& neighbours, const Communicator& ranks) {
  Timing best{.step = 1e300};
  int n = 1;
  for (int round = 0; round < 600; ++round) {
    ranks.barrier();
    const double start = monotonic_seconds(), waited = neighbours.waited;
    run_steps(body, neighbours, n);
    const double elapsed = ranks.all_max(monotonic_seconds() - start);
    const double wait = ranks.all_max(neighbours.waited - waited);
    if (elapsed / n < best.step) best = {elapsed / n, wait / n};
    n = static_cast<int>(std::ceil(.002 / best.step));
  }
  return best;
}

void report(Formulation formulation, Precision precision, int n_elements, Communicator& ranks,
            bool is_first) {
  const Mesh mesh = jittered_body(formulation, n_elements, 0);
  const std::vector<std::int32_t> owner = partition_nodes(mesh, ranks);
  Body body =
      make_body(mesh, {.solver = with(formulation, {.precision = precision})}, owner, ranks.rank());
  const Halo halo = make_halo(mesh, owner, body.part);
  Neighbours neighbours = make_neighbours(halo, body.model, ranks);
  displace(body, [](const Vec3& X) { return Vec3(0.05 * X.y(), 0, 0); });
  const Timing t = measure(body, neighbours, ranks);
  const Traffic before = ranks.traffic();
  run_steps(body, neighbours, 1);
  const Traffic after = ranks.traffic();
  const std::uint64_t computed = ranks.all_sum(body.part.element_global.size());
  const std::uint64_t bytes = ranks.all_sum(after.n_bytes - before.n_bytes);
  if (!ranks.is_root()) return;
  std::printf(
      "%s\n  {\"element\": \"%s\", \"precision\": \"%s\", \"elements\": %d, \"nodes\": %d, "
      "\"step_us\": %.2f, \"step_ns_per_element\": %.3f, \"waited_us\": %.2f, "
      "\"bytes_per_step\": %llu, \"computed_twice\": %.4f}",
      is_first ? "" : ",", name_of(formulation), name_of(precision), mesh.n_elements(),
      mesh.n_nodes(), 1e6 * t.step, 1e9 * t.step / mesh.n_elements(), 1e6 * t.waited,
      static_cast<unsigned long long>(bytes),
      static_cast<double>(computed) / mesh.n_elements() - 1);
  std::fflush(stdout);
}

// What a rank reaches while all others measure too.
double of_all_ranks(const Communicator& ranks, double (*measured)()) {
  ranks.barrier();
  return -ranks.size() * ranks.all_max(-measured());
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* usage =
      "[mpirun -np RANKS] bench_step [elements (100000)] [threads of a rank (1)]";
  if (const int code = answer_options(argc, argv, usage); code >= 0) return code;
  MpiSession session(&argc, &argv);
  Communicator& ranks = session.world();
  const int n_elements = argc > 1 ? std::atoi(argv[1]) : 100000;
  const int n_threads = argc > 2 ? std::atoi(argv[2]) : 1;
  if (n_elements < 1 || n_threads < 1) return ranks.is_root() ? print_usage(usage, stderr) : 2;
  set_thread_count(n_threads);
  const double peak = of_all_ranks(ranks, peak_gflops), triad = of_all_ranks(ranks, triad_gbytes);
  if (ranks.is_root())
    std::printf(
        "{\"ranks\": %d, \"threads\": %d, \"simd\": \"%s\", \"peak_gflops\": %.1f, "
        "\"triad_gbytes\": %.1f, \"steps\": [",
        ranks.size(), n_threads, simd_name(), peak, triad);
  report(Formulation::hex8_one_point, Precision::in_double, n_elements, ranks, true);
  report(Formulation::hex8_one_point, Precision::in_single, n_elements, ranks, false);
  report(Formulation::tet4, Precision::in_double, n_elements, ranks, false);
  if (ranks.is_root()) std::printf("\n]}\n");
}
