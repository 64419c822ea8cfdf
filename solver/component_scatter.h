// From lanes in registers to sums in memory that lie component by component: of rows of a box
// (node_layout.h) whole registers are added, others number by number; in the order of the elements
// at each node, so that sums have the bits of corner_scatter.h's.
#pragma once

#include "solver/component_gather.h"
#include "solver/corner_scatter.h"

namespace trocar {

// Lanes one further up, the first one the last of `before`.
template <class Pack, std::size_t... k>
[[gnu::always_inline]] inline Pack a_lane_up(const Pack& before, const Pack& x,
                                             std::index_sequence<k...>) {
  return __builtin_shufflevector(before, x, (sizeof...(k) - 1 + k)...);
}
template <class Pack>
[[gnu::always_inline]] inline Pack a_lane_up(const Pack& before, const Pack& x) {
  return a_lane_up(before, x, std::make_index_sequence<pack_width<Pack>>{});
}

// Lanes from the k-th on one further up, which holds `between`. All lanes stay if k is none.
template <class Pack>
[[gnu::always_inline]] inline Pack spread(const Pack& x, int k, const Pack& between) {
  using Real = RealOf<Pack>;
  const std::uint32_t at = 1U << k, behind = 0xFFFEU << k;
  if constexpr (sizeof(Pack) == 64 && sizeof(Real) == sizeof(double))
    return _mm512_mask_expand_pd(between, static_cast<std::uint8_t>(~at), x);
  else if constexpr (sizeof(Pack) == 64)
    return _mm512_mask_expand_ps(between, static_cast<std::uint16_t>(~at), x);
  else
    return replaced(replaced(x, behind, a_lane_up(x, x)), at, between);
}

// Adds the forces of groups one behind the other. Corners of a hexahedron in a box come in pairs
// (a, b), of which a node gets a's force of one element and then b's of the next one. What the last
// lane has for a waits until the next lanes are there: if they go on in the row, they add it with
// their own.
template <class Pack, int n>
class ComponentSums {
 public:
  using Real = RealOf<Pack>;

  // Component i of place p is at sum[i * stride + p].
  [[gnu::always_inline]] ComponentSums(Real* sum, std::int64_t stride)
      : sum_(sum), stride_(stride) {}

  // target: of the group that begins with the lane-th of a block with this row_break; corners(i, f)
  // gives component i at each corner.
  template <class Corners>
  [[gnu::always_inline]] void add(const LaneNumbers& target, std::uint32_t row_break, int lane,
                                  const Corners& corners) {
    const int k = lane_of_break(row_break) - lane;
    const Following following = following_of<Pack>(lane_of_break(row_break), lane);
    const bool is_paired = following != Following::anyhow && unpaired_of_break(row_break) == 0;
    if constexpr (has_pairs)
      if (is_paired) {
        if (following == Following::in_a_row)
          return add_rows<Following::in_a_row>(target, k, corners);
        if (target.skip == 1) return add_rows<Following::in_two_rows>(target, k, corners);
      }
    Real of_lane[3][n][width];
    for (int i = 0; i < 3; ++i) {
      Pack f[n];
      corners(i, f);
      for (int a = 0; a < n; ++a) store(of_lane[i][a], f[a]);
    }
    if constexpr (has_pairs)
      if (is_paired) return add_rows_apart(of_lane, target, k);
    add_seldom(of_lane, target, {following, k}, unpaired_of_break(row_break));
  }

  // What still waits.
  [[gnu::always_inline]] void finish() {
    if constexpr (has_pairs) {
      if (next_[0] == nullptr) return;
      for (int i = 0; i < 3; ++i)
        for (int pair = 0; pair < n_pairs; ++pair)
          next_[pair][i * stride_] += waiting_[i][pair][width - 1];
      next_[0] = nullptr;
    }
  }

 private:
  static constexpr int width = pack_width<Pack>, n_pairs = 4, lanes = block_lanes<Pack>;
  static constexpr bool has_pairs = n == 8 && width > 2;

  struct Rows {
    Following following;
    int k;  // where the second one begins
  };

  Real* sum_;
  std::int64_t stride_;
  Real* next_[n_pairs] = {};  // where the last lane of what waits goes, if something waits
  alignas(64) Real waiting_[3][n_pairs][width];

  // Nodes from the first lane's to the next one's behind the last.
  [[gnu::always_inline]] static int n_met(Following following, const LaneNumbers& target) {
    return width + (following == Following::in_two_rows ? target.skip : 0);
  }
  [[gnu::always_inline]] static int a_of(int pair) { return corner_of_row(box_row, 2 * pair); }
  [[gnu::always_inline]] static int b_of(int pair) { return corner_of_row(box_row, 2 * pair + 1); }

  template <Following following, class Corners>
  [[gnu::always_inline]] void add_rows(const LaneNumbers& target, int k, const Corners& corners) {
    const std::int64_t stride = stride_;
    Real* to[n_pairs];
    find_pairs(target, to);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      Pack f[n];
      corners(i, f);
#pragma GCC unroll 4
      for (int pair = 0; pair < n_pairs; ++pair)
        add_pair<following>(f[a_of(pair)], f[b_of(pair)], k, waiting_[i][pair],
                            to[pair] + i * stride);
    }
    for (int pair = 0; pair < n_pairs; ++pair) next_[pair] = to[pair] + n_met(following, target);
  }
  [[gnu::always_inline]] void find_pairs(const LaneNumbers& target, Real* (&to)[n_pairs]) {
    for (int pair = 0; pair < n_pairs; ++pair) to[pair] = sum_ + target.first(b_of(pair));
    bool goes_on = true;
    for (int pair = 0; pair < n_pairs; ++pair) goes_on = goes_on & (to[pair] == next_[pair]);
    if (!goes_on) begin_anew();
  }

  // Two rows that do not follow each other, as at the end of a layer: 0.3 us less than number by
  // number, which 13 blocks of each half of 8,000 elements felt.
  [[gnu::noinline]] void add_rows_apart(const Real (&of_lane)[3][n][width],
                                        const LaneNumbers& target, int k) {
    Real* to[n_pairs];
    find_pairs(target, to);
    for (int i = 0; i < 3; ++i)
      for (int pair = 0; pair < n_pairs; ++pair)
        add_pair_apart(load<Pack>(of_lane[i][a_of(pair)]), load<Pack>(of_lane[i][b_of(pair)]), k,
                       target.skip, waiting_[i][pair], to[pair] + i * stride_);
    for (int pair = 0; pair < n_pairs; ++pair)
      next_[pair] = to[pair] + n_met(Following::in_two_rows, target);
  }

  // Two rows meet one node more than they have lanes, of which the k-th, where the first row ends,
  // gets nothing from a b and the next one nothing from an a.
  template <Following following>
  [[gnu::always_inline]] static void add_pair(const Pack& a, const Pack& b, int k, Real* waiting,
                                              Real* to) {
    const Pack before = a_lane_up(load<Pack>(waiting), a);
    store(waiting, a);
    if constexpr (following == Following::in_a_row) {
      store(to, Pack((load<Pack>(to) + before) + b));
    } else {
      const Pack nothing = -zero_of(a);  // adds nothing, not even to -0
      store(to, Pack((load<Pack>(to) + spread(before, k + 1, nothing)) + spread(b, k, nothing)));
      const Real last_a = k == width - 1 ? nothing[0] : a[width - 2];
      to[width] = (to[width] + last_a) + b[width - 1];
    }
  }

  [[gnu::noinline]] void begin_anew() {
    finish();
    for (int i = 0; i < 3; ++i)
      for (int pair = 0; pair < n_pairs; ++pair) store(waiting_[i][pair], -Pack{});
  }

  // The same where the second row begins `skip` nodes further on.
  [[gnu::always_inline]] static void add_pair_apart(const Pack& a, const Pack& b, int k, int skip,
                                                    Real* waiting, Real* to) {
    const Pack before = a_lane_up(load<Pack>(waiting), a), nothing = -zero_of(a);
    store(waiting, a);
    const std::uint32_t of_first = (2U << k) - 1, second = ~0U << k;
    add_lanes(replaced(before, ~of_first, nothing), replaced(b, second, nothing), of_first, to);
    add_lanes(replaced(before, of_first, nothing), replaced(b, ~second, nothing), second,
              to + skip);
  }
  // a, then b; other lanes than these stay unwritten.
  [[gnu::always_inline]] static void add_lanes(const Pack& a, const Pack& b, std::uint32_t lanes,
                                               Real* to) {
    const Pack sum = (load<Pack>(to) + a) + b;
    if constexpr (sizeof(Pack) == 64 && sizeof(Real) == sizeof(double)) {
      _mm512_mask_storeu_pd(to, static_cast<std::uint8_t>(lanes), sum);
    } else if constexpr (sizeof(Pack) == 64) {
      _mm512_mask_storeu_ps(to, static_cast<std::uint16_t>(lanes), sum);
    } else {
      Real of_lane[width];
      store(of_lane, sum);
      for (int l = 0; l < width; ++l)
        if ((lanes >> l & 1) != 0) to[l] = of_lane[l];
    }
  }

  // Element after element, or of a row some of whose pairs are none these so. Nothing waits.
  [[gnu::noinline]] void add_seldom(const Real (&of_lane)[3][n][width], const LaneNumbers& target,
                                    const Rows& rows, unsigned unpaired) {
    if constexpr (has_pairs)
      if (rows.following != Following::anyhow) {
        begin_anew();
        for (int i = 0; i < 3; ++i)
          for (int pair = 0; pair < n_pairs; ++pair)
            if ((unpaired >> pair & 1) == 0)
              add_whole_pair(of_lane[i], target, rows, i, pair);
            else
              for (const int a : {a_of(pair), b_of(pair)})
                for (int l = 0; l < width; ++l) sum_at(i, target, a, l) += of_lane[i][a][l];
        return;
      }
    finish();
    for (int i = 0; i < 3; ++i)
      for (int l = 0; l < width; ++l)
        for (int a = 0; a < n; ++a) sum_at(i, target, a, l) += of_lane[i][a][l];
  }
  [[gnu::always_inline]] void add_whole_pair(const Real (&of_lane)[n][width],
                                             const LaneNumbers& target, const Rows& rows, int i,
                                             int pair) {
    const auto& of_a = of_lane[a_of(pair)];
    const Pack a = load<Pack>(of_a), b = load<Pack>(of_lane[b_of(pair)]);
    Real* const to = sum_ + (i * stride_ + target.first(b_of(pair)));
    if (rows.following == Following::in_a_row)
      add_pair<Following::in_a_row>(a, b, rows.k, waiting_[i][pair], to);
    else if (target.skip == 1)
      add_pair<Following::in_two_rows>(a, b, rows.k, waiting_[i][pair], to);
    else
      add_pair_apart(a, b, rows.k, target.skip, waiting_[i][pair], to);
    to[n_met(rows.following, target)] += of_a[width - 1];
  }
  [[gnu::always_inline]] Real& sum_at(int i, const LaneNumbers& target, int a, int l) {
    return sum_[i * stride_ + target.all[a * lanes + l]];
  }
};

}  // namespace trocar
