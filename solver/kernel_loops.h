// The loops over blocks, written once for any pack, element and material.
#pragma once

#include "solver/corner_access.h"
#include "solver/kernels.h"

namespace trocar {

// A pack's worth of elements: their constants and where their corners are.
template <class Pack, class Element>
struct Group {
  BlockValues<Pack> value;
  const std::int32_t* corner;  // [corner][lane], from the group's first lane on

  Group(const BlockTask& task, std::int64_t block, int lane)
      : value{task.data + block * Element::n_values * block_lanes + lane},
        corner(task.corner + block * Element::n_corners * block_lanes + lane) {}
};

template <class Pack, class Element>
[[gnu::always_inline]] inline auto group_strain(const Group<Pack, Element>& group,
                                                const double* u) {
  Pack corner_u[Element::n_corners][3];
  for (int a = 0; a < Element::n_corners; ++a)
    gather_corner(u, group.corner + a * block_lanes, corner_u[a]);
  return Element::strain(group.value, corner_u);
}

template <class Pack, class Element, class Material>
struct BlockLoops {
  static void force(const BlockTask& task, double* slot) {
    constexpr int n = Element::n_corners;
    for (std::int64_t block = 0; block < task.n_blocks; ++block)
      for (int lane = 0; lane < block_lanes; lane += pack_width<Pack>) {
        const Group<Pack, Element> group(task, block, lane);
        const auto strain = group_strain(group, task.u);
        const Tensor<Pack> VP =
            Material::stress(strain.H, group.value(value_lambda_V), group.value(value_mu_V));
        Pack f[n][3];
        Element::forces(group.value, strain, VP, f);
        double* to = slot + (block * n * block_lanes + lane) * slot_width;
        for (int a = 0; a < n; ++a) store_corner(to + a * block_lanes * slot_width, f[a]);
      }
  }

  static void energy(const BlockTask& task, double* strain_energy, double* hourglass) {
    for (std::int64_t block = 0; block < task.n_blocks; ++block)
      for (int lane = 0; lane < block_lanes; lane += pack_width<Pack>) {
        const Group<Pack, Element> group(task, block, lane);
        const auto strain = group_strain(group, task.u);
        const Pack W =
            Material::energy(strain.H, group.value(value_lambda_V), group.value(value_mu_V));
        store(strain_energy + block * block_lanes + lane, W);
        store(hourglass + block * block_lanes + lane,
              Element::hourglass_energy(group.value, strain));
      }
  }

  static void watch(const BlockTask& task, double* J, double* stiffening) {
    for (std::int64_t block = 0; block < task.n_blocks; ++block)
      for (int lane = 0; lane < block_lanes; lane += pack_width<Pack>) {
        const Group<Pack, Element> group(task, block, lane);
        const Tensor<Pack> H = group_strain(group, task.u).H;
        store(J + block * block_lanes + lane, Pack(1.0 + volume_change(H, cofactor(H))));
        store(stiffening + block * block_lanes + lane,
              Material::stiffening(H, group.value(value_lambda_V), group.value(value_mu_V)));
      }
  }
};

template <class Pack>
void sum_corner_forces(const SumTask& task) {
  for (std::int64_t k = 0; k < task.n_nodes; ++k) {
    const std::int64_t i = task.node[k];
    const std::int64_t first = task.slot_offset[i], last = task.slot_offset[i + 1];
    constexpr int width = pack_width<Pack> < slot_width ? pack_width<Pack> : slot_width;
    using Part = typename PackOf<width>::Real;
    Part sum[slot_width / width] = {};
    for (std::int64_t at = first; at < last; ++at)
      for (int j = 0; j < slot_width; j += width)
        sum[j / width] += load<Part>(task.slot + task.slot_index[at] * slot_width + j);
    double total[slot_width];
    for (int j = 0; j < slot_width; j += width) store(total + j, sum[j / width]);
    for (int j = 0; j < 3; ++j) task.force[3 * i + j] = task.mass[i] * task.gravity[j] - total[j];
  }
}

template <class Pack, class Element, class... Materials>
constexpr void fill_materials(BlockKernels* row, TypeList<Materials...>) {
  ((row[static_cast<int>(Materials::model)] = {Element::n_corners, Element::n_values,
                                               BlockLoops<Pack, Element, Materials>::force,
                                               BlockLoops<Pack, Element, Materials>::energy,
                                               BlockLoops<Pack, Element, Materials>::watch}),
   ...);
}

template <class Pack, class... Elements>
constexpr Kernels make_kernels(TypeList<Elements...>) {
  Kernels kernels{};
  kernels.sum = sum_corner_forces<Pack>;
  int type = 0;
  ((fill_materials<Pack, Elements>(kernels.block[type++], MaterialList{})), ...);
  return kernels;
}

}  // namespace trocar
