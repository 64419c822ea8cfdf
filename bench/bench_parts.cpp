// Where a step's time goes: nanoseconds of its parts per element, one thread, widest registers,
// neo-Hookean. Strain, law and force are told apart by leaving out what comes behind, so that what
// overlaps counts once. JSON to stdout. bench_parts [elements, about (default 8000)]
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "bench/jittered_body.h"
#include "bench/machine.h"
#include "solver/block_ranges.h"
#include "solver/sum_order.h"

using namespace trocar;

namespace {

// A step's element kernels up to a part.
enum class Until { strain, law, force };

void run_elements(Body& body, Until last) {
  for (const ElementBlocks& blocks : body.model.blocks)
    for_strained_blocks(
        body.model, blocks, body.state, 0, blocks.n_blocks,
        [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t block) {
          if (last == Until::strain) return;
          kernels.law.stress(task);
          if (last == Until::law) return;
          const std::int64_t corner = block * kernels.element.n_corners * blocks.lanes;
          kernels.element.force(task, targets(blocks).data() + corner, body.scratch.sum.data());
        });
}

void run_nodes(Body& body) {
  const NodeForces nodes{.mass = body.model.mass.data(),
                         .gravity = {0, 0, 0, 0},
                         .sum = body.scratch.sum.data(),
                         .force = body.scratch.force.data()};
  active_kernels().nodes.force(nodes, body.model.sums.node.data(),
                               std::ssize(body.model.sums.node));
}

void report(Formulation formulation, Precision precision, int n_elements) {
  const Mesh mesh = jittered_body(formulation, n_elements);
  Body body = make_body(mesh, {.solver = with(formulation, {.precision = precision})});
  displace(body, [](const Vec3& X) { return Vec3(0.05 * X.y(), 0, 0); });
  const std::function<void()> parts[] = {
      [&] { run_elements(body, Until::strain); },
      [&] { run_elements(body, Until::law); },
      [&] { run_elements(body, Until::force); },
      [&] { run_nodes(body); },
      [&] { integrate(body.model, body.scratch, {}, 1e-12, body.state); },
      [&] { step(body, 1e-12); }};
  // In turn, so that all have met the machine at its best.
  std::array<double, std::size(parts)> ns;
  ns.fill(1e300);
  for (int round = 0; round < 5; ++round)
    for (std::size_t k = 0; k < ns.size(); ++k)
      ns[k] = std::min(ns[k], 1e9 * best_seconds(parts[k]) / mesh.n_elements());
  std::printf(
      "\n  {\"element\": \"%s\", \"precision\": \"%s\", \"elements\": %d, \"strain\": %.2f, "
      "\"law\": "
      "%.2f, \"force\": %.2f, \"nodes\": %.2f, \"motion\": %.2f, \"step\": %.2f}",
      name_of(formulation), name_of(precision), mesh.n_elements(), ns[0], ns[1] - ns[0],
      ns[2] - ns[1], ns[3], ns[4], ns[5]);
}

}  // namespace

int main(int argc, char** argv) {
  const int n_elements = argc > 1 ? std::atoi(argv[1]) : 8000;
  if (n_elements < 1) {
    std::fprintf(stderr, "bench_parts [elements]\n");
    return 2;
  }
  std::printf("{\"simd\": \"%s\", \"peak_gflops\": %.1f, \"parts\": [", simd_name(), peak_gflops());
  const char* separator = "";
  for (const Formulation formulation : {Formulation::hex8_one_point, Formulation::tet4})
    for (const Precision precision : precisions) {
      std::printf("%s", separator);
      report(formulation, precision, n_elements);
      separator = ",";
    }
  std::printf("\n]}\n");
}
