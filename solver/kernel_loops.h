// The loops over blocks, written once for any pack, element and material.
#pragma once

#include "solver/corner_access.h"
#include "solver/kernels.h"
#include "solver/material_law.h"
#include "solver/viscosity.h"

namespace trocar {

// Mean over the corners of an element's lanes of x[node * stride].
template <class Pack, int n>
[[gnu::always_inline]] inline Pack mean_of_corners(const double* x, std::int64_t stride,
                                                   const std::int32_t* corner) {
  RealOf<Pack> mean[pack_width<Pack>];
  for (int lane = 0; lane < pack_width<Pack>; ++lane) {
    double sum = 0;
    for (int a = 0; a < n; ++a) sum += x[stride * corner[a * block_lanes<Pack> + lane]];
    mean[lane] = static_cast<RealOf<Pack>>(sum * (1.0 / n));
  }
  return load<Pack>(mean);
}

// A pack's worth of elements: their constants and where their corners are.
template <class Pack, class Element, class Material>
struct Group {
  static constexpr int n_values = Material::n_values + Element::n_values;
  Law<Material, Pack> law;
  BlockValues<Pack> value;
  const std::int32_t* corner;  // [corner][lane], from the group's first lane on

  [[gnu::always_inline]] Group(const BlockTask& task, std::int64_t block, int lane)
      : law{static_cast<const RealOf<Pack>*>(task.data) + block * n_values * block_lanes<Pack> +
            lane},
        value{law.value.at + Material::n_values * block_lanes<Pack>},
        corner(task.corner + block * Element::n_corners * block_lanes<Pack> + lane) {}
};

// What the element asks for stress.
template <class Pack, class Element, class Material>
[[gnu::always_inline]] inline auto law_of(const BlockTask& task,
                                          const Group<Pack, Element, Material>& group) {
  if constexpr (averages_volume_v<Element>)
    return LawAtPressure<Law<Material, Pack>, Pack>{
        group.law,
        mean_of_corners<Pack, Element::n_corners>(task.theta, task.n_fields, group.corner),
        static_cast<RealOf<Pack>>(task.element_share)};
  else
    return group.law;
}

template <class Pack, class Element, class Material>
struct BlockLoops {
  static constexpr int n = Element::n_corners;
  static constexpr int lanes = block_lanes<Pack>;

  // Calls body(group, u, block, lane) for every group with the displacements of its corners.
  template <class Body>
  [[gnu::always_inline]] static void for_groups(const BlockTask& task, const Body& body) {
    for (std::int64_t block = 0; block < task.n_blocks; ++block)
      for (int lane = 0; lane < lanes; lane += pack_width<Pack>) {
        const Group<Pack, Element, Material> group(task, block, lane);
        Pack u[n][3];
        gather_corners(task.u, group.corner, u);
        body(group, u, block, lane);
      }
  }

  static void force(const BlockTask& task, void* slot) {
    for_groups(
        task, [&](const auto& group, const auto& u, std::int64_t block, int lane)
                  __attribute__((always_inline)) {
                    Pack f[n][3];
                    Element::force(group.value, law_of(task, group), u, f);
                    RealOf<Pack>* to =
                        static_cast<RealOf<Pack>*>(slot) + (block * n * lanes + lane) * slot_width;
                    for (int a = 0; a < n; ++a) store_corner(to + a * lanes * slot_width, f[a]);
                  });
  }

  static void viscous_force(const BlockTask& task, const ViscousStep& step, double* history,
                            void* slot) {
    const std::int64_t width = Element::n_points * history_of_point(step.n_branches);
    for_groups(task, [&](const auto& group, const auto& u, std::int64_t block, int lane) {
      const ViscousLaw<Material, Pack> law{group.law.value, step,
                                           history + block * width * lanes + lane};
      Pack f[n][3];
      Element::force(group.value, law, u, f);
      RealOf<Pack>* to = static_cast<RealOf<Pack>*>(slot) + (block * n * lanes + lane) * slot_width;
      for (int a = 0; a < n; ++a) store_corner(to + a * lanes * slot_width, f[a]);
    });
  }

  static void energy(const BlockTask& task, double* strain, double* hourglass) {
    for_groups(task, [&](const auto& group, const auto& u, std::int64_t block, int lane) {
      const auto energy = Element::energy(group.value, law_of(task, group), u);
      store_in_double(strain + block * lanes + lane, energy.strain);
      store_in_double(hourglass + block * lanes + lane, energy.hourglass);
    });
  }

  static void watch(const BlockTask& task, double* J, double* stiffening) {
    for_groups(task, [&](const auto& group, const auto& u, std::int64_t block, int lane) {
      const auto watch = Element::watch(group.value, law_of(task, group), u);
      store_in_double(J + block * lanes + lane, watch.J);
      store_in_double(stiffening + block * lanes + lane, watch.stiffening);
    });
  }

  static void volume_change(const BlockTask& task, double* K_V_j) {
    for_groups(task, [&](const auto& group, const auto& u, std::int64_t block, int lane) {
      const Tensor<Pack> H = ElementTet4::strain(group.value, u).H;
      const Pack j = trocar::volume_change(H, cofactor(H));
      store_in_double(K_V_j + block * lanes + lane, Pack(group.law.value(value_K_V) * j));
    });
  }
};

// The Pack of doubles is the sum's; Slot is the precision of the corner forces.
template <class Pack, class Slot>
void sum_corner_forces(const SumTask& task) {
  const Slot* const slot = static_cast<const Slot*>(task.slot);
  constexpr int width = pack_width<Pack> < slot_width ? pack_width<Pack> : slot_width;
  using Part = PackOf<double, width>;
  for (std::int64_t k = 0; k < task.n_nodes; ++k) {
    const std::int64_t i = task.node[k];
    const std::int64_t first = task.slot_offset[i], last = task.slot_offset[i + 1];
    Part sum[slot_width / width] = {};
    for (std::int64_t at = first; at < last; ++at)
      for (int j = 0; j < slot_width; j += width)
        sum[j / width] += load_in_double<Part>(slot + task.slot_index[at] * slot_width + j);
    double total[slot_width];
    for (int j = 0; j < slot_width; j += width) store(total + j, sum[j / width]);
    for (int j = 0; j < 3; ++j) task.force[3 * i + j] = task.mass[i] * task.gravity[j] - total[j];
  }
}

// Viscosity is for elements that ask for one stress at each of n_points; others lack n_points.
template <class Pack, class Element, class Material>
BlockKernels block_kernels() {
  BlockKernels kernels{.n_corners = Element::n_corners,
                       .n_values = Group<Pack, Element, Material>::n_values,
                       .n_material_values = Material::n_values};
  using Loops = BlockLoops<Pack, Element, Material>;
  if constexpr (!averages_volume_v<Element> || Material::is_decoupled) {
    kernels.force = Loops::force;
    kernels.energy = Loops::energy;
    kernels.watch = Loops::watch;
    if constexpr (averages_volume_v<Element>)
      kernels.volume_change = Loops::volume_change;
    else if constexpr (requires { Element::n_points; }) {
      kernels.n_points = Element::n_points;
      kernels.viscous_force = Loops::viscous_force;
    }
  }
  return kernels;
}

template <class Pack, class Element, class... Materials>
void fill_element(BlockKernels* row, TypeList<Materials...>) {
  ((row[static_cast<int>(Materials::model)] = block_kernels<Pack, Element, Materials>()), ...);
}

// One element's kernels in both precisions; `doubles` is the width of a register.
template <class Element, int doubles, int singles>
void fill_formulation(Kernels& kernels) {
  const int f = static_cast<int>(Element::formulation);
  fill_element<PackOf<double, doubles>, Element>(kernels.of[0].block[f], MaterialList{});
  fill_element<PackOf<float, singles>, Element>(kernels.of[1].block[f], MaterialList{});
}

}  // namespace trocar
