// From nodal fields that lie component by component to lanes in registers: of rows of a box
// (node_layout.h) whole registers are loaded, and nothing has to be put in order.
#pragma once

#include "solver/corner_gather.h"

namespace trocar {

// How the lanes of a register follow each other. Those of a block's second row skip some nodes; it
// begins early where that is within the first half.
enum class Following { in_a_row, in_two_rows, in_two_rows_early, anyhow };

// Bit l of `lanes`: lane l is `by`'s.
template <class Pack, std::size_t... l>
[[gnu::always_inline]] inline Pack replaced(const Pack& x, std::uint32_t lanes, const Pack& by,
                                            std::index_sequence<l...>) {
  using Real = RealOf<Pack>;
  if constexpr (sizeof(Pack) == 64 && sizeof(Real) == sizeof(double)) {
    return _mm512_mask_blend_pd(static_cast<std::uint8_t>(lanes), x, by);
  } else if constexpr (sizeof(Pack) == 64) {
    return _mm512_mask_blend_ps(static_cast<std::uint16_t>(lanes), x, by);
  } else if constexpr (sizeof...(l) == 1) {
    return (lanes & 1) != 0 ? by : x;
  } else {
    using Bit = std::conditional_t<sizeof(Real) == sizeof(double), std::uint64_t, std::uint32_t>;
    using Bits = PackOf<Bit, static_cast<int>(sizeof...(l))>;
    return ((Bits{} + Bit{lanes}) & Bits{Bit{1} << l...}) != 0 ? by : x;
  }
}
template <class Pack>
[[gnu::always_inline]] inline Pack replaced(const Pack& x, std::uint32_t lanes, const Pack& by) {
  return replaced(x, lanes, by, std::make_index_sequence<pack_width<Pack>>{});
}

// Lanes from `lane` on, of a block with this row_break.
template <class Pack>
[[gnu::always_inline]] inline Following following_of(int row_break, int lane) {
  if (pack_width<Pack> <= 2 || row_break == 0) return Following::anyhow;
  if (row_break <= lane || row_break >= lane + pack_width<Pack>) return Following::in_a_row;
  return Following::in_two_rows;
}

// Numbers of the nodes or places that the lanes of a group meet at each corner. In rows those of
// the block's first lane tell all: a list of 32 bytes a block in place of as many an element.
struct LaneNumbers {
  const std::int32_t* all;    // [corner][lane of the block], from the group's first lane on
  const std::int32_t* start;  // [corner] of the block's first lane
  int ahead;                  // of the group's first lane, behind `start`
  int skip;                   // of a second row

  // Of the group's first lane, which stands in a row.
  [[gnu::always_inline]] std::int64_t first(int a) const { return std::int64_t{start[a]} + ahead; }
};

// The group of the block that begins with `lane`; n corners.
template <class Pack, int n>
[[gnu::always_inline]] inline LaneNumbers lane_numbers(const std::int32_t* all,
                                                       const std::int32_t* start,
                                                       std::int64_t block, int lane,
                                                       std::uint32_t row_break) {
  constexpr bool is_whole = pack_width<Pack> == block_lanes<Pack>;
  const int skip = skip_of_break(row_break);
  return {all + block * n * block_lanes<Pack> + lane, start + block * n,
          is_whole || lane == 0 ? 0 : lane + (lane >= lane_of_break(row_break) ? skip : 0), skip};
}

// Component i of corner a at x[i * stride + number].
template <class Real>
struct ComponentField {
  const Real* x;
  std::int64_t stride;
  LaneNumbers number;
};

// What the lanes of a group meet at a corner.
template <class Group, Following following, class Real>
struct CornerLanes {
  const Real* at;           // in rows the first lane's, else the field's begin
  const std::int32_t* all;  // numbers of the lanes
  int k, skip;              // where a second row begins, and how many numbers it skips there

  // Doubles of single-precision elements.
  template <class Part>
  static constexpr bool is_half = !std::is_same_v<RealOf<Group>, Real> && pack_width<Part> > 1;

  // Those from `lane` on.
  template <class Part>
  [[gnu::always_inline]] Part load_from(int lane) const {
    if constexpr (following == Following::anyhow) {
      Real of_lane[pack_width<Part>];
      for (int l = 0; l < pack_width<Part>; ++l) of_lane[l] = at[all[lane + l]];
      return load<Part>(of_lane);
    }
    if constexpr (is_half<Part> && following == Following::in_two_rows_early)
      if (lane > 0) return load<Part>(at + lane + skip);
    const Part row = load<Part>(at + lane);
    if constexpr (is_half<Part> && following == Following::in_two_rows)
      if (lane == 0) return row;
    if constexpr (following != Following::in_a_row) {
      const auto second = static_cast<std::uint32_t>(0xFFFF << k >> lane);
      const Real* const behind = at + lane + skip;
      if constexpr (sizeof(Part) < 64)
        return replaced(row, second, load<Part>(behind));
      else if constexpr (sizeof(Real) == sizeof(double))
        return _mm512_mask_loadu_pd(row, static_cast<std::uint8_t>(second), behind);
      else
        return _mm512_mask_loadu_ps(row, static_cast<std::uint16_t>(second), behind);
    }
    return row;
  }
};

// Of corner a; x: a component of the field.
template <class Pack, Following following, class Real>
[[gnu::always_inline]] inline CornerLanes<Pack, following, Real> corner_lanes(
    const Real* x, const LaneNumbers& number, int a, int k) {
  return {following == Following::anyhow ? x : x + number.first(a),
          number.all + a * block_lanes<Pack>, k, number.skip};
}

// One component at a corner; of displacements in single precision the difference to the first one,
// rounded.
template <class Pack, class Lanes>
[[gnu::always_inline]] inline Pack load_component(const Lanes& corner, const Lanes& first) {
  using Real = std::remove_cvref_t<decltype(*corner.at)>;
  if constexpr (sizeof(RealOf<Pack>) == sizeof(Real)) {
    return corner.template load_from<Pack>(0);
  } else if constexpr (pack_width<Pack> == 1) {
    return Pack{static_cast<float>(corner.template load_from<double>(0) -
                                   first.template load_from<double>(0))};
  } else {
    constexpr int width = pack_width<Pack> / 2;
    using Half = PackOf<double, width>;
    const auto half = [&](int lane) __attribute__((always_inline)) {
      return in_single(
          Half(corner.template load_from<Half>(lane) - first.template load_from<Half>(lane)));
    };
    return join<Pack>(half(0), half(width), std::make_index_sequence<pack_width<Pack>>{});
  }
}

// Edges along x, y and z of a row of boxes along the axes, from reference positions.
template <Following following, class Pack>
[[gnu::always_inline]] inline void load_edges(const ComponentField<float>& field, int k,
                                              Pack (&edge)[3]) {
  constexpr int end[3] = {1, 3, 4};  // of the edge from corner 0 on
  for (int i = 0; i < 3; ++i) {
    const auto corner = [&](int a) __attribute__((always_inline)) {
      const float* const x = field.x + i * field.stride;
      return corner_lanes<Pack, following>(x, field.number, a, k).template load_from<Pack>(0);
    };
    edge[i] = corner(end[i]) - corner(0);
  }
}

// All corners, displacements or reference positions.
template <Following following, class Pack, class Real, int n>
[[gnu::always_inline]] inline void load_components(const ComponentField<Real>& field, int k,
                                                   Pack (&x)[n][3]) {
  const Real* of[3] = {field.x, field.x + field.stride, field.x + 2 * field.stride};
  // Hidden, so that the stride is not added to each corner's number instead.
  asm("" : "+r"(of[1]), "+r"(of[2]));
  const auto lanes = [&](int a, int i) __attribute__((always_inline)) {
    return corner_lanes<Pack, following>(of[i], field.number, a, k);
  };
  const auto load_corner = [&](int a, int i) __attribute__((always_inline)) {
    x[a][i] = load_component<Pack>(lanes(a, i), lanes(0, i));
  };
  if constexpr (following == Following::anyhow) {  // seldom: short rather than quick
#pragma GCC unroll 1
    for (int at = 0; at < 3 * n; ++at) load_corner(at / 3, at % 3);
  } else if constexpr (sizeof(Real) == sizeof(double)) {
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i)
#pragma GCC unroll 8
      for (int a = 0; a < n; ++a) load_corner(a, i);
  } else {
#pragma GCC unroll 8
    for (int a = 0; a < n; ++a)
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) load_corner(a, i);
  }
}

}  // namespace trocar
