// From nodal fields that lie component by component to lanes in registers: of rows of a box
// (node_layout.h) whole registers are loaded, and nothing has to be put in order.
#pragma once

#include "solver/corner_gather.h"

namespace trocar {

// How the lanes of a register follow each other. Those of a block's second row skip a node.
enum class Following { in_a_row, in_two_rows, anyhow };

// Lanes from `lane` on, of a block with this row_break.
template <class Pack>
[[gnu::always_inline]] inline Following following_of(int row_break, int lane) {
  if (pack_width<Pack> <= 2 || row_break == 0) return Following::anyhow;
  if (row_break <= lane || row_break >= lane + pack_width<Pack>) return Following::in_a_row;
  return sizeof(Pack) == 64 ? Following::in_two_rows : Following::anyhow;
}

// Component i of corner a of lane l at x[i * stride + corner[a * block_lanes + l]].
template <class Real>
struct ComponentField {
  const Real* x;
  std::int64_t stride;
  const std::int32_t* corner;
};

// Numbers of the lanes from `first` on; node: of all lanes; k: where the second row begins.
template <Following following, class Part>
[[gnu::always_inline]] inline Part load_row(const RealOf<Part>* x, const std::int32_t* node,
                                            int first, int k) {
  if constexpr (following == Following::anyhow) {
    RealOf<Part> lane[pack_width<Part>];
    for (int l = 0; l < pack_width<Part>; ++l) lane[l] = x[node[first + l]];
    return load<Part>(lane);
  }
  const RealOf<Part>* const at = x + node[0] + first;
  const Part all = load<Part>(at);
  if constexpr (following == Following::in_two_rows) {
    const auto second = static_cast<std::uint32_t>(0xFFFF << k >> first);
    if constexpr (sizeof(RealOf<Part>) == sizeof(double))
      return _mm512_mask_loadu_pd(all, static_cast<std::uint8_t>(second), at + 1);
    else
      return _mm512_mask_loadu_ps(all, static_cast<std::uint16_t>(second), at + 1);
  }
  return all;
}

// One component at one corner; of displacements in single precision the difference to `first`,
// rounded.
template <Following following, class Pack>
[[gnu::always_inline]] inline Pack load_lanes(const double* u, const std::int32_t* node,
                                              const std::int32_t* first, int k) {
  if constexpr (sizeof(RealOf<Pack>) == sizeof(double)) {
    return load_row<following, Pack>(u, node, 0, k);
  } else if constexpr (pack_width<Pack> == 1) {
    return Pack{static_cast<float>(u[node[0]] - u[first[0]])};
  } else {
    constexpr int width = pack_width<Pack> / 2;
    using Half = PackOf<double, width>;
    const auto half = [&](int lane) __attribute__((always_inline)) {
      return in_single(Half(load_row<following, Half>(u, node, lane, k) -
                            load_row<following, Half>(u, first, lane, k)));
    };
    return join<Pack>(half(0), half(width), std::make_index_sequence<pack_width<Pack>>{});
  }
}
template <Following following, class Pack>
[[gnu::always_inline]] inline Pack load_lanes(const float* X, const std::int32_t* node,
                                              const std::int32_t*, int k) {
  return load_row<following, Pack>(X, node, 0, k);
}

// All corners, displacements or reference positions.
template <Following following, class Pack, class Real, int n>
[[gnu::always_inline]] inline void load_components(const ComponentField<Real>& field, int k,
                                                   Pack (&x)[n][3]) {
  const auto load_corner = [&](int a, int i) __attribute__((always_inline)) {
    x[a][i] = load_lanes<following, Pack>(field.x + i * field.stride,
                                          field.corner + a * block_lanes<Pack>, field.corner, k);
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
