// A step's parts, each to be measured on its own.
#pragma once

#include <array>
#include <cstdio>
#include <functional>
#include <utility>

#include "bench/jittered_body.h"
#include "solver/block_ranges.h"
#include "solver/sum_order.h"

namespace trocar {

// A step's element kernels up to a part.
enum class Until { strain, law, force };

// Displacements by component, if the model's fields lie so; it has one run.
inline Components components_of(Body& body) {
  if (!body.model.is_by_component) return {};
  const std::int64_t stride = component_stride(body.model.n_local);
  static AlignedVector<double> u;
  u.resize(static_cast<std::size_t>(3 * stride));
  active_kernels().nodes.split(body.state.u.data(), body.model.n_local, u.data(), stride);
  return {u.data(), stride};
}

inline void run_elements(Body& body, Until last) {
  const Components components = components_of(body);
  for (const ElementBlocks& blocks : body.model.blocks)
    for_strained_blocks(
        body.model, blocks, body.state, components, 0, blocks.n_blocks,
        [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t block) {
          if (last == Until::strain) return;
          kernels.law.stress(task);
          if (last == Until::law) return;
          with_sums(body.model, body.scratch, [&](auto& sum) {
            kernels.element.force(task, targets(blocks, block), sum.data());
          });
        });
}

inline void run_nodes(Body& body) {
  finish_nodes(body.model, body.model.sums.node, body.scratch);
}

constexpr int n_step_parts = 6;

// Strain, strain and law, these and force, nodes, motion, all: law and force are told apart by
// leaving out what comes behind, so that what overlaps counts once.
inline std::array<std::function<void()>, n_step_parts> parts_of_step(Body& body) {
  return {[&] { run_elements(body, Until::strain); },
          [&] { run_elements(body, Until::law); },
          [&] { run_elements(body, Until::force); },
          [&] { run_nodes(body); },
          [&] { integrate(body.model, body.scratch, {}, 1e-12, body.state); },
          [&] { step_freely(body, 1e-12); }};
}

struct PartsCase {
  Formulation formulation = Formulation::tet4;
  Numbering numbering = Numbering::box;
  Precision precision = Precision::in_double;
};

// As JSON, of what was measured of each part per element.
inline void print_parts(const PartsCase& c, int n_elements,
                        const std::array<double, n_step_parts>& of) {
  std::printf(
      "\n  {\"element\": \"%s\", \"numbering\": \"%s\", \"precision\": \"%s\", \"elements\": %d, "
      "\"strain\": %.2f, "
      "\"law\": %.2f, \"force\": %.2f, \"nodes\": %.2f, \"motion\": %.2f, \"step\": %.2f}",
      name_of(c.formulation), numbering_name[static_cast<int>(c.numbering)], name_of(c.precision),
      n_elements, of[0], of[1] - of[0], of[2] - of[1], of[3], of[4], of[5]);
}

inline Body sheared_body(const Mesh& mesh, Formulation formulation, Precision precision) {
  Body body = make_body(mesh, {.solver = with(formulation, {.precision = precision})});
  displace(body, [](const Vec3& X) { return Vec3(0.05 * X.y(), 0, 0); });
  return body;
}

// Calls measure(parts) for the elements that have a target, sheared, neo-Hookean; it returns
// what print_parts takes, of the whole body.
template <class Measure>
void report_parts(int n_elements, const Measure& measure) {
  const char* separator = "";
  for (const auto& [formulation, numbering] :
       {std::pair(Formulation::hex8_one_point, Numbering::box),
        std::pair(Formulation::hex8_one_point, Numbering::aligned),
        std::pair(Formulation::hex8_one_point, Numbering::near_box),
        std::pair(Formulation::hex8_one_point, Numbering::any),
        std::pair(Formulation::hex8_one_point, Numbering::renumbered),
        std::pair(Formulation::tet4, Numbering::box), std::pair(Formulation::tet4, Numbering::any),
        std::pair(Formulation::tet4, Numbering::renumbered)})
    for (const Precision precision : precisions) {
      const Mesh mesh = numbered_body(numbering, formulation, n_elements);
      Body body = sheared_body(mesh, formulation, precision);
      std::array<double, n_step_parts> of = measure(parts_of_step(body));
      for (double& value : of) value /= mesh.n_elements();
      std::printf("%s", separator);
      print_parts({formulation, numbering, precision}, mesh.n_elements(), of);
      separator = ",";
    }
}

}  // namespace trocar
