// The elements' loops over blocks, written once for any pack and element.
#pragma once

#include "solver/component_scatter.h"
#include "solver/kernel_groups.h"
#include "solver/position_gather.h"

namespace trocar {

// Mean over the corners of an element's lanes of x[node * stride].
template <class Pack, int n>
[[gnu::always_inline]] inline Pack mean_of_corners(const double* x, std::int64_t stride,
                                                   const std::int32_t* corner) {
  constexpr int width = pack_width<Pack>;
  RealOf<Pack> mean[width];
  for (int lane = 0; lane < width; ++lane) {
    double sum = 0;
    for (int a = 0; a < n; ++a) sum += x[corner[a * block_lanes<Pack> + lane] * stride];
    mean[lane] = static_cast<RealOf<Pack>>(sum * (1.0 / n));
  }
  return load<Pack>(mean);
}

template <class Pack, class Element>
inline constexpr int n_values_of = [] {
  if constexpr (sizeof(RealOf<Pack>) == sizeof(float) &&
                requires { Element::values_spared_in_single; })
    return Element::n_values - Element::values_spared_in_single;
  return Element::n_values;
}();

template <class Pack, class Element>
inline constexpr bool reads_positions_v = [] {
  if constexpr (requires { Element::template reads_positions<Pack>; })
    return Element::template reads_positions<Pack>;
  return false;
}();

template <class Pack, class Element>
struct ElementLoops {
  static constexpr int n = Element::n_corners;
  static constexpr int lanes = block_lanes<Pack>;
  using AlignedLoops = ElementLoops<Pack, typename AlignedOf<Element>::type>;

  static void strain(const BlockTask& task) {
    if constexpr (n == 8)
      if (task.u_x != nullptr)
        return task.is_aligned ? AlignedLoops::strain_by_component(task)
                               : strain_by_component(task);
    for_elements(
        task, [&](const auto& value, const auto& stash, std::int64_t block,
                  int lane) __attribute__((always_inline)) {
          const std::int32_t* corner = corners(task, block, lane);
          Pack u[n][3];
          if constexpr (reads_positions_v<Pack, Element>) {
            if (task.position_stride > 0)
              load_positions(task, block, lane, u);
            else
              gather_positions(task.position, corner, rows(task, block, lane), u);
            Element::prepare(u, stash);
          } else if constexpr (requires { Element::prepare(value, stash); }) {
            Element::prepare(value, stash);
          }
          gather_corners(task.u, corner, rows(task, block, lane), u);
          Element::strain(value, u, stash);
          if constexpr (averages_volume_v<Element>)
            stash.put(tensor_values, mean_of_corners<Pack, n>(task.theta, task.n_fields, corner));
        });
  }

  static void force(const BlockTask& task, const std::int32_t* target, void* sum) {
    RealOf<Pack>* const to = static_cast<RealOf<Pack>*>(sum);
    if (task.sum_stride > 0)
      return task.is_aligned ? AlignedLoops::force_by_component(task, target, to)
                             : force_by_component(task, target, to);
    for_elements(
        task, [&](const auto& value, const auto& stash, std::int64_t block, int lane)
                  __attribute__((always_inline)) {
                    if (lane == 0) fetch(task, block + task.n_blocks);
                    Pack f[n][3];
                    find_force(value, stash, f);
                    add_corners(f, target + block * n * lanes + lane, rows(task, block, lane), to);
                  });
  }

  static void hourglass(const BlockTask& task, double* to) {
    for_elements(task, [&](const auto& value, const auto& stash, std::int64_t block, int lane) {
      store_in_double(to + block * lanes + lane, Element::hourglass_energy(value, stash));
    });
  }

  static void volume_change(const BlockTask& task, double* to) {
    // Blocks; what the machine finds by itself makes a step of a million elements a quarter longer.
    constexpr std::int64_t ahead = 12;
    for_groups<Pack>(task, [&](const Group<Pack>& group, std::int64_t block, int lane) {
      if (lane == 0) fetch(task, block + ahead);
      Pack u[n][3];
      gather_corners(task.u, corners(task, block, lane), rows(task, block, lane), u);
      const Tensor<Pack> H = ElementTet4::strain(behind_material(task, group), u);
      const Pack j = trocar::volume_change(H, cofactor(H));
      store_in_double(to + block * lanes + lane, Pack(group.value(value_K_V) * j));
    });
  }

  static void strain_by_component(const BlockTask& task) {
    for_elements(
        task, [&](const auto& value, const auto& stash, std::int64_t block,
                  int lane) __attribute__((always_inline)) {
          const Following following =
              following_of<Pack>(lane_of_break(task.row_break[block]), lane);
          if (following == Following::in_a_row)
            strain_of_group<Following::in_a_row>(task, value, stash, block, lane);
          else if (following == Following::anyhow)
            strain_of_seldom<Following::anyhow>(task, value, stash, block, lane);
          else if (sizeof(RealOf<Pack>) == sizeof(float) &&
                   lane_of_break(task.row_break[block]) - lane < pack_width<Pack> / 2)
            strain_of_seldom<Following::in_two_rows_early>(task, value, stash, block, lane);
          else
            strain_of_seldom<Following::in_two_rows>(task, value, stash, block, lane);
        });
  }
  static void force_by_component(const BlockTask& task, const std::int32_t* target,
                                 RealOf<Pack>* sum) {
    ComponentSums<Pack, n> sums(sum, task.sum_stride);
    for_elements(
        task, [&](const auto& value, const auto& stash, std::int64_t block,
                  int lane) __attribute__((always_inline)) {
          if (lane == 0) fetch(task, block + task.n_blocks);
          const std::uint32_t row_break = task.row_break[block];
          const LaneNumbers to =
              lane_numbers<Pack, n>(target, task.row_target, block, lane, row_break);
          if constexpr (n == 8) {
            Pack w[3][n_hex_modes];
            Element::force_modes(value, stash, w);
            sums.add(
                to, row_break, lane, [&](int i, Pack(&f)[n]) __attribute__((always_inline)) {
                  corners_of_modes(w[i], f);
                });
          } else {
            Pack of_all[n][3];
            Element::force(value, stash, of_all);
            sums.add(
                to, row_break, lane, [&](int i, Pack(&f)[n]) __attribute__((always_inline)) {
                  for (int a = 0; a < n; ++a) f[a] = of_all[a][i];
                });
          }
        });
    sums.finish();
  }

 private:
  static constexpr bool is_aligned = requires { Element::is_read(0); };

  // By component, for elements whose displacements lie node by node.
  [[gnu::noinline]] static void load_positions(const BlockTask& task, std::int64_t block, int lane,
                                               Pack (&X)[n][3]) {
    const std::uint32_t row_break = task.row_break[block];
    const int k = lane_of_break(row_break) - lane;
    const ComponentField<float> field{
        task.position, task.position_stride,
        lane_numbers<Pack, n>(task.corner, task.row_start, block, lane, row_break)};
    const Following following = following_of<Pack>(lane_of_break(row_break), lane);
    if (following == Following::in_a_row)
      load_components<Following::in_a_row>(field, k, X);
    else if (following == Following::anyhow)
      load_components<Following::anyhow>(field, k, X);
    else
      load_components<Following::in_two_rows>(field, k, X);
  }
  // Out of line, so that what is seldom leaves the instruction cache to the others.
  template <Following following>
  [[gnu::noinline]] static void strain_of_seldom(const BlockTask& task,
                                                 const BlockValues<Pack>& value,
                                                 const Stash<Pack>& stash, std::int64_t block,
                                                 int lane) {
    strain_of_group<following>(task, value, stash, block, lane);
  }
  template <Following following>
  [[gnu::always_inline]] static void strain_of_group(const BlockTask& task,
                                                     const BlockValues<Pack>& value,
                                                     const Stash<Pack>& stash, std::int64_t block,
                                                     int lane) {
    const std::uint32_t row_break = task.row_break[block];
    const int k = lane_of_break(row_break) - lane;
    // Made twice: what is held across prepare lies in memory.
    const auto node = [&]() __attribute__((always_inline)) {
      return lane_numbers<Pack, n>(task.corner, task.row_start, block, lane, row_break);
    };
    Pack u[n][3];
    if constexpr (reads_positions_v<Pack, Element>) {
      const ComponentField<float> position{task.position, task.position_stride, node()};
      if constexpr (is_aligned) {
        Pack edge[3];
        load_edges<following>(position, k, edge);
        Element::prepare(edge, stash);
      } else {
        load_components<following>(position, k, u);
        Element::prepare(u, stash);
      }
    } else if constexpr (requires { Element::prepare(value, stash); }) {
      Element::prepare(value, stash);
    }
    load_components<following>(ComponentField<double>{task.u_x, task.u_stride, node()}, k, u);
    Element::strain(value, u, stash);
  }
  [[gnu::always_inline]] static void find_force(const BlockValues<Pack>& value,
                                                const Stash<Pack>& stash, Pack (&f)[n][3]) {
    if constexpr (n == 8) {
      Pack w[3][n_hex_modes], of_corner[n];
      Element::force_modes(value, stash, w);
      for (int i = 0; i < 3; ++i) {
        corners_of_modes(w[i], of_corner);
        for (int a = 0; a < n; ++a) f[a][i] = of_corner[a];
      }
    } else {
      Element::force(value, stash, f);
    }
  }
  [[gnu::always_inline]] static BlockValues<Pack> behind_material(const BlockTask& task,
                                                                  const Group<Pack>& group) {
    return {group.value.at + task.n_material_values * lanes};
  }
  [[gnu::always_inline]] static const std::int32_t* corners(const BlockTask& task,
                                                            std::int64_t block, int lane) {
    return task.corner + block * n * lanes + lane;
  }
  [[gnu::always_inline]] static const std::uint32_t* rows(const BlockTask& task, std::int64_t block,
                                                          int lane) {
    return task.row + (block * lanes + lane) / row_lanes;
  }
  // Asks for the constants of a block that the next task will read, of most materials all, two of
  // which are the material's; behind the last one nothing happens.
  [[gnu::always_inline]] static void fetch(const BlockTask& task, std::int64_t block) {
    constexpr int line = 64, of_material = 2, n_lines = n_values_of<Pack, Element> + of_material;
    const char* const at = static_cast<const char*>(task.data) + block * task.n_values * line;
#pragma GCC unroll 128
    for (int k = 0; k < n_lines; ++k) {
      if constexpr (is_aligned)
        if (!Element::is_read(k - of_material)) continue;
      __builtin_prefetch(at + k * line, 0, 3);
    }
  }
  // Calls body(the element's constants, stash, block, lane) for every group.
  template <class Body>
  [[gnu::always_inline]] static void for_elements(const BlockTask& task, const Body& body) {
    for_groups<Pack>(
        task, [&](const Group<Pack>& group, std::int64_t block, int lane)
                  __attribute__((always_inline)) {
                    body(behind_material(task, group), group.stash, block, lane);
                  });
  }
};

template <class Pack, class Element>
ElementKernels element_kernels() {
  using Loops = ElementLoops<Pack, Element>;
  int n_kept = Element::n_kept;
  constexpr bool is_single = sizeof(RealOf<Pack>) == sizeof(float);
  if constexpr (is_single && requires { Element::kept_added_in_single; })
    n_kept += Element::kept_added_in_single;
  ElementKernels kernels{.n_corners = Element::n_corners,
                         .n_points = Element::n_points,
                         .n_values = n_values_of<Pack, Element>,
                         .n_stash = tensor_values * Element::n_points + n_kept,
                         .law = Element::law,
                         .reads_positions = reads_positions_v<Pack, Element>,
                         .strain = Loops::strain,
                         .force = Loops::force,
                         .hourglass = Loops::hourglass};
  if constexpr (requires { Element::value_share; }) {
    kernels.share = Element::value_share;
    kernels.share_stride = Element::values_of_point;
  }
  if constexpr (averages_volume_v<Element>) kernels.volume_change = Loops::volume_change;
  return kernels;
}

template <class Pack, class... Elements>
void fill_elements(KernelsOfPrecision& kernels, TypeList<Elements...>) {
  ((kernels.element[static_cast<int>(Elements::formulation)] = element_kernels<Pack, Elements>()),
   ...);
}

}  // namespace trocar
