// Nanoseconds of one whole step per element, neo-Hookean: tet4 and hex8 in double by instruction
// set, or every formulation and precision; and the multiply-add peak of this core in the same run,
// because others may use the machine. One thread is timed by its processor time, several by the
// wall clock. JSON to stdout.
// bench_step [threads] [cells along an edge of the hexahedral cube] [formulations]
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/machine.h"
#include "solver_body.h"

using namespace trocar;

struct Timing {
  double force = 0, integrate = 0, watch = 0, build = 0;  // [s], best of several
};

static Timing measure(const Mesh& mesh, const SolverOptions& options) {
  Body body = make_body(mesh, {.solver = options});
  displace(body, [](const Vec3& X) { return Vec3(0.05 * X.y(), 0, 0); });
  const std::vector<FixedMask> fixed(mesh.X.size(), 0);
  const double dt = 1e-9;  // stays near the deformation it starts from
  Timing timing;
  timing.build = best_seconds(
      [&] { build_model(mesh, body.part, body.materials, fixed, body.mass, options); });
  timing.force = best_seconds([&] {
    average_volume_change(body.model, body.state, body.scratch);
    compute_force(body.model, body.state, body.scratch);
  });
  timing.integrate = best_seconds([&] { integrate(body.model, body.scratch, {}, dt, body.state); });
  timing.watch = best_seconds([&] { watch(body.model, body.part, body.state); });
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
      const SolverOptions options = with(f, {.precision = precision});
      const ElementType shape = shape_of(f);
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
