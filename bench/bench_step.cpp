// Nanoseconds of one whole step per element, neo-Hookean: tet4 and hex8 in double by instruction
// set, or every formulation and precision; and the multiply-add peak of this core in the same run,
// because others may use the machine. One thread is timed by its processor time, several by the
// wall clock. JSON to stdout.
// bench_step [threads] [cells along an edge of the hexahedral cube] [formulations]
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/threads.h"
#include "base/timers.h"
#include "mesh/generate.h"
#include "solver/element_setup.h"
#include "solver/simd.h"
#include "solver/step.h"
#include "solver/watch.h"

using namespace trocar;

static double seconds() {
  if (thread_count() > 1) return monotonic_seconds();
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Timing {
  double force = 0, integrate = 0, watch = 0, build = 0;  // [s], best of several
};

// Best of 7 runs of at least 20 ms: others may use the machine.
template <class Body>
static double best_seconds(const Body& body) {
  double best = 1e300;
  for (int run = 0; run < 7; ++run) {
    int n = 0;
    const double start = seconds();
    double elapsed = 0;
    while (elapsed < 0.02) {
      body();
      ++n;
      elapsed = seconds() - start;
    }
    best = std::min(best, elapsed / n);
  }
  return best;
}

constexpr int n_chains = 8, n_rounds = 20000;

// Eight independent chains of fused multiply-adds: two units with a latency of four cycles.
[[gnu::target("avx512f"), gnu::noinline]] static double run_chains() {
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

// 10^9 double-precision operations a second of this core, with AVX-512.
static double peak_gflops() {
  volatile double sink = 0;
  const double best = best_seconds([&] { sink = run_chains(); });
  return 1e-9 * n_chains * n_rounds * 8 * 2 / best;
}

static Timing measure(const Mesh& mesh, const SolverOptions& options) {
  const std::vector<Material> materials = {Material{}};
  const std::vector<FixedMask> fixed(mesh.X.size(), 0);
  const std::vector<double> density = {materials[0].density};
  const std::vector<double> mass = lumped_mass(mesh, density, 1e-3);
  const Part part = make_part(mesh, std::vector<std::int32_t>(mesh.X.size(), 0), 0);
  const Model model = build_model(mesh, part, materials, fixed, mass, options);
  State state = make_state(model);
  Scratch scratch = make_scratch(model);
  for (std::size_t i = 0; i < mesh.X.size(); ++i) state.u[3 * i] = 0.05 * mesh.X[i].y();
  const double dt = 1e-9;  // stays near the deformation it starts from
  Timing timing;
  timing.build = best_seconds([&] { build_model(mesh, part, materials, fixed, mass, options); });
  timing.force = best_seconds([&] {
    average_volume_change(model, state, scratch);
    compute_force(model, state, scratch);
  });
  timing.integrate = best_seconds([&] { integrate(model, scratch, {}, dt, state); });
  timing.watch = best_seconds([&] { watch(model, part, state); });
  return timing;
}

static void report(const char* name, const Mesh& mesh, const SolverOptions& options,
                   bool& is_first) {
  const Timing t = measure(mesh, options);
  const double ns = 1e9 / mesh.n_elements();
  std::printf(
      "%s\n  {\"element\": \"%s\", \"precision\": \"%s\", \"simd\": \"%s\", \"threads\": %d, "
      "\"elements\": %d, \"nodes\": %d, \"step_ns\": %.2f, \"force_ns\": %.2f, "
      "\"integrate_ns\": %.2f, \"watch_ns\": %.2f, \"build_ns\": %.1f}",
      is_first ? "" : ",", name, name_of(options.precision), simd_name(), thread_count(),
      mesh.n_elements(), mesh.n_nodes(), (t.force + t.integrate) * ns, t.force * ns,
      t.integrate * ns, t.watch * ns, t.build * ns);
  is_first = false;
}

static void report_instruction_sets(const char* name, const Mesh& mesh, bool& is_first) {
  for (int i = 0; i < n_simd; ++i) {
    if (!is_supported(static_cast<Simd>(i))) continue;
    select_simd(name_of(static_cast<Simd>(i)));
    report(name, mesh, {}, is_first);
  }
}

// With the widest instruction set.
static void report_formulations(const Mesh& tet, const Mesh& hex, int n, bool& is_first) {
  const Mesh plane = make_rectangle(.1, .1, 4 * n, 4 * n);
  for (const Precision precision : {Precision::in_double, Precision::in_single})
    for (int k = 0; k < n_formulations; ++k) {
      const auto f = static_cast<Formulation>(k);
      SolverOptions options{.precision = precision};
      const ElementType shape = shape_of(f);
      if (shape == ElementType::tri3) options.tri3 = f;
      if (shape == ElementType::tet4) options.tet4 = f;
      if (shape == ElementType::hex8) options.hex8 = f;
      report(name_of(f),
             shape == ElementType::tri3 ? plane : (shape == ElementType::tet4 ? tet : hex), options,
             is_first);
    }
}

int main(int argc, char** argv) {
  set_thread_count(argc > 1 ? std::atoi(argv[1]) : 1);
  const int n = argc > 2 ? std::atoi(argv[2]) : 37;
  const int n_tet = std::max(1, n * 20 / 37);  // about as many tetrahedra as hexahedra
  const Vec3 low(0, 0, 0), high(.1, .1, .1);
  const Mesh tet = make_box(low, high, {n_tet, n_tet, n_tet}, BoxElements::tet4_kuhn);
  const Mesh hex = make_box(low, high, {n, n, n}, BoxElements::hex8);
  bool is_first = true;
  if (is_supported(Simd::avx512)) std::printf("{\"peak_gflops\": %.1f,\n", peak_gflops());
  std::printf("%s\"steps\": [", is_supported(Simd::avx512) ? "" : "{");
  if (argc > 3 && std::string(argv[3]) == "formulations") {
    report_formulations(tet, hex, n, is_first);
  } else {
    report_instruction_sets("tet4", tet, is_first);
    report_instruction_sets("hex8", hex, is_first);
  }
  std::printf("\n]}\n");
}
