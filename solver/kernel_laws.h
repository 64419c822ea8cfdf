// The materials' loops over blocks, written once for any pack, material and kind of law.
#pragma once

#include <limits>

#include "solver/in_double.h"
#include "solver/kernel_groups.h"
#include "solver/law_averaged_pressure.h"
#include "solver/law_plane_stress.h"
#include "solver/material_law.h"
#include "solver/viscosity.h"

namespace trocar {

// A law at what its element kept behind the strains, or at its constants behind the material's.
template <LawKind kind, class Law, class Pack>
[[gnu::always_inline]] inline auto law_of_kind(const Law& law, const BlockTask& task,
                                               const Group<Pack>& group) {
  if constexpr (kind == LawKind::averaged_pressure)
    return LawAveragedPressure<Law, Pack>{law, group.stash.get(tensor_values * task.n_points),
                                          static_cast<RealOf<Pack>>(task.element_share)};
  else if constexpr (kind == LawKind::plane_stress)
    return LawPlaneStress<Law, Pack>{law,
                                     {group.value.at + task.n_material_values * block_lanes<Pack>}};
  else
    return law;
}

template <class Pack, class Material, LawKind kind>
struct LawLoops {
  static constexpr int lanes = block_lanes<Pack>;

  static void stress(const BlockTask& task) {
    if constexpr (Material::is_decoupled && kind != LawKind::plane_stress)
      put_decoupled_stress(task);
    else
      for_groups<Pack>(
          task, [&](const Group<Pack>& group, std::int64_t, int) __attribute__((always_inline)) {
            put_stress(task, group,
                       law_of_kind<kind>(Law<Material, Pack>{group.value}, task, group));
          });
  }

  static void viscous_stress(const BlockTask& task, const ViscousStep& step, double* history) {
    const std::int64_t width = task.n_points * history_of_point(step.n_branches);
    for_groups<Pack>(task, [&](const Group<Pack>& group, std::int64_t block, int lane) {
      const ViscousLaw<Material, Pack> law{group.value, step,
                                           history + block * width * lanes + lane};
      put_stress(task, group, law_of_kind<kind>(law, task, group));
    });
  }

  static void energy(const BlockTask& task, double* to) {
    for_groups<Pack>(task, [&](const Group<Pack>& group, std::int64_t block, int lane) {
      const auto law = law_of_kind<kind>(Law<Material, Pack>{group.value}, task, group);
      Pack sum = zero_of(group.stash.get(0));
      for (std::int64_t k = 0; k < task.n_points; ++k) {
        const Pack energy = law.energy(group.stash.get_tensor(k));
        sum += task.share > 0 ? group.value(task.share + k * task.share_stride) * energy : energy;
      }
      store_in_double(to + block * lanes + lane, sum);
    });
  }

  // The bound of elements with several points grows at most as at the worst one.
  static bool watch(const BlockTask& task, const WatchLimits& limits, double* J,
                    double* stiffening) {
    constexpr bool is_single = sizeof(RealOf<Pack>) == sizeof(float);
    constexpr auto rounding = real<Pack>(1 + (is_single ? 2e-7 : 1e-12));
    constexpr auto infinite = std::numeric_limits<RealOf<Pack>>::infinity();
    const auto least_J = real<Pack>(limits.J), at_rest = real<Pack>(limits.at_rest);
    bool is_beyond = false;
    for_groups<Pack>(task, [&](const Group<Pack>& group, std::int64_t block, int lane) {
      const auto law = law_of_kind<kind>(Law<Material, Pack>{group.value}, task, group);
      const Pack limit = load_rounded<Pack>(limits.enough + block * lanes + lane);
      Pack least = zero_of(group.value(0)), most = least;
      for (std::int64_t k = 0; k < task.n_points; ++k) {
        const Tensor<Pack> H = law.full_strain(group.stash.get_tensor(k));
        const Pack j = volume_change(H, cofactor(H));
        const Pack s = may_exceed(H, group.value, limit) ? law.stiffening(H) : zero_of(j) + 1.0;
        // The order of the operands keeps a NaN.
        least = k == 0 ? j : (least < j ? least : j);
        most = k == 0 ? s : (most > s ? most : s);
      }
      least += 1.0;
      store_in_double(J + block * lanes + lane, least);
      store_in_double(stiffening + block * lanes + lane, most);
      const Pack zero = zero_of(most), growth = larger(Pack(zero + at_rest), most);
      const auto is_within = (least > least_J) & (least < infinite) & (rounding * growth < limit);
      is_beyond |= is_any((is_within ? zero : zero + 1.0) > 0.0);
    });
    return is_beyond;
  }

 private:
  // The powers of J are one long chain of operations: those of several groups go side by side.
  static void put_decoupled_stress(const BlockTask& task) {
    constexpr int most = 8;
    const std::int64_t n_groups = task.n_blocks * groups_of_block<Pack>;
    Pack j[most];
    Isochoric<Pack> iso[most];
    for (std::int64_t point = 0; point < task.n_points; ++point)
      for (std::int64_t first = 0; first < n_groups; first += most) {
        const int n = static_cast<int>(n_groups - first < most ? n_groups - first : most);
        for (int k = 0; k < n; ++k) {
          const Tensor<Pack> H = group_of<Pack>(task, first + k).stash.get_tensor(point);
          j[k] = volume_change(H, cofactor(H));
        }
        for (int k = 0; k < n; ++k) iso[k] = isochoric(j[k]);
        for (int k = 0; k < n; ++k) {
          const Group<Pack> group = group_of<Pack>(task, first + k);
          const Deformation<Pack> d = deformation_of(group.stash.get_tensor(point), j[k], iso[k]);
          const auto law = law_of_kind<kind>(Law<Material, Pack>{group.value}, task, group);
          group.stash.put_tensor(point, law.stress(d));
        }
      }
  }

  // Whether any lane's stiffening is above the limit, for all that is known without computing it.
  [[gnu::always_inline]] static bool may_exceed(const Tensor<Pack>& H,
                                                const BlockValues<Pack>& value, const Pack& limit) {
    if constexpr (kind != LawKind::averaged_pressure &&
                  requires { Material::excess(H, value, limit); })
      return is_any(Material::excess(H, value, limit) > 0.0);
    else
      return true;
  }

  template <class AnyLaw>
  [[gnu::always_inline]] static void put_stress(const BlockTask& task, const Group<Pack>& group,
                                                const AnyLaw& law) {
    for (std::int64_t k = 0; k < task.n_points; ++k)
      group.stash.put_tensor(k, law.stress(group.stash.get_tensor(k)));
  }
};

template <class Pack, class Material, LawKind kind>
LawKernels law_kernels() {
  LawKernels kernels{};
  if constexpr (kind != LawKind::averaged_pressure || Material::is_decoupled) {
    using Loops = LawLoops<Pack, Material, kind>;
    kernels = {.stress = Loops::stress,
               .viscous_stress = Loops::viscous_stress,
               .energy = Loops::energy,
               .watch = Loops::watch};
  }
  return kernels;
}

template <class Pack, LawKind kind, class... Materials>
void fill_laws(KernelsOfPrecision& kernels, TypeList<Materials...>) {
  ((kernels.law[static_cast<int>(kind)][static_cast<int>(Materials::model)] =
        law_kernels<Pack, Materials, kind>()),
   ...);
}

}  // namespace trocar
