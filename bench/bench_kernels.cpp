// Nanoseconds of one whole step (forces, sums, integration) per element, by element, material,
// precision and instruction set, for bodies that a cache holds and for others; beside the
// multiply-add peak and the memory bandwidth of the same core in the same run, and beside what
// these allow (roofline: Williams, Waterman and Patterson 2009). JSON to stdout. bench_kernels
// [elements, about (default 8000)] [material, or "all"] [threads]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "bench/jittered_body.h"
#include "bench/machine.h"
#include "bench/usage.h"
#include "solver_body.h"

using namespace trocar;

namespace {

// Operations of a neo-Hookean element and its share of the nodes, additions and multiplications,
// counted in the formulas:
// stress (material_neo_hookean.h): cofactor 27, J - 1 11, tr 2E 19, root 37 (isochoric.h), factors
//   11, P 9 x 4 + 3. Single precision takes a longer form (material_neo_hookean.h), whose surplus
//   is not counted as work.
// hex8 one-point: b 9 + 18 x 7 (single makes them of positions: 90 more, no work), modes 3 x 23, H
// 9 x 11, q 12 x 6 (element_hex8.h); stress; g 12,
//   P' 9 x 8, w 18 x 5 + 9, corners 3 x 23, sums 8 x 3; a node 6 for its force, 16 for its motion.
// tet4: differences 9, H 9 x 5; stress; f 9 x 5 + 6, sums 4 x 3; a node for 5.5 of them.
constexpr double flops_of_stress = 27 + 11 + 19 + 37 + 11 + 39;
constexpr double flops_of_node = 6 + 16;
constexpr double flops_of_hex8 =
    135 + 69 + 99 + 72 + flops_of_stress + 12 + 72 + 99 + 69 + 24 + flops_of_node;
constexpr double flops_of_tet4 = 9 + 45 + flops_of_stress + 51 + 12 + flops_of_node / 5.5;

// In the order of MaterialModel.
constexpr const char* model_names[n_material_models] = {
    "linear", "st-venant-kirchhoff",    "neo-hookean",           "mooney-rivlin", "yeoh",
    "ogden",  "transversely-isotropic", "holzapfel-gasser-ogden"};

struct Case {
  Formulation formulation;
  MaterialModel model;
  Precision precision;
};

struct Timing {
  double ns = 0, bytes = 0, moved = 0;  // per element
};

// Bytes that one step must move if no cache holds the body: what is constant once, what changes
// once in and once out.
double moved_bytes(const Body& body) {
  const auto bytes = [](const auto& values) {
    return static_cast<double>(values.size() * sizeof(values[0]));
  };
  const Model& model = body.model;
  double sum = bytes(model.mass) + bytes(model.inertia) + bytes(model.fixed) +
               bytes(model.position) + bytes(model.sums.node) + bytes(model.sums.stride_first) +
               2 * (bytes(body.state.u) + bytes(body.state.v) + bytes(body.scratch.sum) +
                    bytes(body.scratch.sum_single) + bytes(body.scratch.u_by_component));
  for (const ElementBlocks& blocks : model.blocks)
    sum += bytes(blocks.data) + bytes(blocks.data_single) +
           (model.is_by_component
                ? bytes(blocks.row_break) + bytes(blocks.row_start) + bytes(blocks.row_target)
                : bytes(blocks.corner) + bytes(blocks.target) + bytes(blocks.target_block) +
                      bytes(blocks.row));
  return sum;
}

Timing measure(const Case& c, const Mesh& mesh) {
  const Material base;
  Body body = make_body(
      mesh, {.materials = {material_of(c.model, lame_mu(base), bulk_modulus(base), base.density)},
             .solver = with(c.formulation, {.precision = c.precision})});
  displace(body, [](const Vec3& X) { return Vec3(0.05 * X.y(), 0, 0); });
  // So short a step stays near the deformation it starts from.
  const double seconds = best_seconds([&] { step_freely(body, 1e-9); });
  const double n = mesh.n_elements();
  const double state_bytes =
      static_cast<double>((body.state.u.size() + body.state.v.size()) * sizeof(double));
  return {1e9 * seconds / n,
          (static_cast<double>(memory_bytes(body.model, body.scratch)) + state_bytes) / n,
          moved_bytes(body) / n};
}

// What the core can do, in double. [10^9 1/s]
struct Machine {
  double gflops = 0, gbytes = 0;
};

double flops_of(const Case& c) {
  if (c.model != MaterialModel::neo_hookean) return 0;
  if (c.formulation == Formulation::hex8_one_point) return flops_of_hex8;
  return c.formulation == Formulation::tet4 ? flops_of_tet4 : 0;
}

void report_roofline(const Case& c, const Timing& t, const Machine& machine) {
  const double flops = flops_of(c);
  if (flops == 0 || machine.gflops == 0) return;
  const double peak = machine.gflops * (c.precision == Precision::in_single ? 2 : 1);
  const double roof_ns = std::max(flops / peak, t.moved / machine.gbytes);
  std::printf(
      ", \"flops\": %.0f, \"moved_bytes\": %.0f, \"roofline_ns\": %.2f, \"share_of_roofline\": "
      "%.3f, \"share_of_peak\": %.3f",
      flops, t.moved, roof_ns, roof_ns / t.ns, flops / t.ns / peak);
}

void report(const Case& c, int n_elements, const Machine& machine, bool& is_first) {
  const Mesh mesh = jittered_body(c.formulation, n_elements);
  const Timing t = measure(c, mesh);
  std::printf(
      "%s\n  {\"element\": \"%s\", \"material\": \"%s\", \"precision\": \"%s\", \"simd\": \"%s\", "
      "\"elements\": %d, \"step_ns\": %.2f, \"bytes\": %.0f",
      is_first ? "" : ",", name_of(c.formulation), model_names[static_cast<int>(c.model)],
      name_of(c.precision), simd_name(), mesh.n_elements(), t.ns, t.bytes);
  report_roofline(c, t, machine);
  std::printf("}");
  std::fflush(stdout);
  is_first = false;
}

void report_all(int n_elements, const std::string& material, const Machine& machine) {
  bool is_first = true;
  for (int f = 0; f < n_formulations; ++f)
    for (int m = 0; m < n_material_models; ++m)
      for (const Precision precision : {Precision::in_double, Precision::in_single}) {
        const Case c{static_cast<Formulation>(f), static_cast<MaterialModel>(m), precision};
        if (material != "all" && material != model_names[static_cast<int>(c.model)]) continue;
        if (!is_possible(c.formulation, c.model)) continue;
        report(c, n_elements, machine, is_first);
      }
}

}  // namespace

int main(int argc, char** argv) {
  std::string usage =
      "bench_kernels [elements (8000)] [material (neo-hookean), or all] [threads (1)]; materials:";
  for (const char* name : model_names) usage += std::string(" ") + name;
  if (const int code = answer_options(argc, argv, usage.c_str()); code >= 0) return code;
  const int n_elements = argc > 1 ? std::atoi(argv[1]) : 8000;
  const std::string material = argc > 2 ? argv[2] : "neo-hookean";
  set_thread_count(argc > 3 ? std::atoi(argv[3]) : 1);
  const bool is_known =
      material == "all" ||
      std::find(std::begin(model_names), std::end(model_names), material) != std::end(model_names);
  if (n_elements < 1 || thread_count() < 1 || !is_known) return print_usage(usage.c_str(), stderr);
  const Machine machine{peak_gflops(), triad_gbytes()};
  std::printf("{\"threads\": %d, \"peak_gflops\": %.1f, \"triad_gbytes\": %.1f, \"steps\": [",
              thread_count(), machine.gflops, machine.gbytes);
  for (const Simd simd : {Simd::sse2, Simd::avx2, Simd::avx512})
    if (is_supported(simd)) {
      if (simd != Simd::sse2) std::printf(",");
      select_simd(name_of(simd));
      report_all(n_elements, material, machine);
    }
  std::printf("\n]}\n");
}
