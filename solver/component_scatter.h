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
  [[gnu::always_inline]] void add(const LaneNumbers& target, std::uint16_t row_break, int lane,
                                  const Corners& corners) {
    if constexpr (n == 8 && width > 2)
      if (unpaired_of_break(row_break) != 0) {
        Real of_lane[3][n][width];
        for (int i = 0; i < 3; ++i) {
          Pack f[n];
          corners(i, f);
          for (int a = 0; a < n; ++a) store(of_lane[i][a], f[a]);
        }
        return add_unpaired(of_lane, target, row_break, lane);
      }
    const Step step = next_step(target, row_break, lane);
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      Pack f[n];
      corners(i, f);
      add_component(f, step, i);
    }
    last_ = step.is_paired ? target.start : nullptr;
    next_ = target.ahead + n_met(step);
  }

  // What still waits.
  [[gnu::always_inline]] void finish() {
    if constexpr (n == 8 && width > 2) {
      if (last_ == nullptr) return;
      for (int i = 0; i < 3; ++i) add_waiting(i);
      last_ = nullptr;
    }
  }

 private:
  static constexpr int width = pack_width<Pack>, n_pairs = 4, lanes = block_lanes<Pack>;

  struct Step {
    LaneNumbers target;
    Following following;
    int k;           // where the second row begins
    bool is_paired;  // and in rows
    bool goes_on;    // the row of what waits
  };

  Real* sum_;
  std::int64_t stride_;
  // Of the block one of whose lanes has a force that waits, for the next place of its row.
  const std::int32_t* last_ = nullptr;
  int next_ = 0;
  alignas(64) Real waiting_[3][n_pairs][width];

  // Nodes from the first lane's to the next one's behind the last.
  [[gnu::always_inline]] static int n_met(const Step& step) {
    return width + (step.following == Following::in_two_rows ? 1 : 0);
  }
  [[gnu::always_inline]] static int a_of(int pair) {
    return corner_of_row(box_row, 2 * pair);
  }
  [[gnu::always_inline]] static int b_of(int pair) {
    return corner_of_row(box_row, 2 * pair + 1);
  }

  [[gnu::always_inline]] Step next_step(const LaneNumbers& target, std::uint16_t row_break,
                                        int lane) const {
    const int k = lane_of_break(row_break);
    const Following following = following_of<Pack>(k, lane);
    const bool is_paired = following != Following::anyhow;
    Step step{target, following, k - lane, is_paired, false};
    if (n != 8 || last_ == nullptr || !is_paired) return step;
    std::int64_t apart = 0;
    for (int pair = 0; pair < n_pairs; ++pair)
      apart |= target.first(b_of(pair)) - (last_[b_of(pair)] + next_);
    step.goes_on = apart == 0;
    return step;
  }

  [[gnu::always_inline]] void add_component(const Pack (&f)[n], const Step& step, int i) {
    if constexpr (n == 8 && width > 2) {
      if (last_ != nullptr && !step.goes_on) add_waiting(i);
      if (step.is_paired && step.following == Following::in_a_row) return add_row(f, step, i);
      if (step.is_paired) return add_two_rows(f, step, i);
    }
    Real lane[n][width];
    for (int a = 0; a < n; ++a) store(lane[a], f[a]);
    add_others(lane, step, i);
  }

  [[gnu::always_inline]] void add_waiting(int i) {
    for (int pair = 0; pair < n_pairs; ++pair)
      sum_[i * stride_ + last_[b_of(pair)] + next_] += waiting_[i][pair][width - 1];
  }

  // What waits for the first lane, and room for what will wait.
  [[gnu::always_inline]] Pack before_first(const Step& step, int i, int pair, const Pack& a) {
    Pack before = -zero_of(a);  // adds nothing, not even to -0
    if (step.goes_on) before = load<Pack>(waiting_[i][pair]);
    store(waiting_[i][pair], a);
    return before;
  }

  [[gnu::always_inline]] void add_row(const Pack (&f)[8], const Step& step, int i) {
#pragma GCC unroll 4
    for (int pair = 0; pair < n_pairs; ++pair)
      add_row_of_pair(f[a_of(pair)], f[b_of(pair)], step, i, pair);
  }
  [[gnu::always_inline]] void add_row_of_pair(const Pack& a, const Pack& b, const Step& step, int i,
                                              int pair) {
    const Pack before = a_lane_up(before_first(step, i, pair, a), a);
    Real* const to = sum_ + (i * stride_ + step.target.first(b_of(pair)));
    store(to, Pack((load<Pack>(to) + before) + b));
  }

  // The lanes meet one node more than they are, of which the k-th, where the first row ends, gets
  // nothing from a b and the next one nothing from an a.
  [[gnu::always_inline]] void add_two_rows(const Pack (&f)[8], const Step& step, int i) {
#pragma GCC unroll 4
    for (int pair = 0; pair < n_pairs; ++pair)
      add_two_rows_of_pair(f[a_of(pair)], f[b_of(pair)], step, i, pair);
  }
  [[gnu::always_inline]] void add_two_rows_of_pair(const Pack& a, const Pack& b, const Step& step,
                                                   int i, int pair) {
    const auto at = static_cast<std::uint16_t>(1 << step.k),
               next = static_cast<std::uint16_t>(at << 1),
               behind = static_cast<std::uint16_t>(0xFFFE << step.k);
    const Pack nothing = -zero_of(a);
    Pack before = a_lane_up(before_first(step, i, pair, a), a);
    before = replaced(before, behind, a_lane_up(before, before));
    before = replaced(before, next, nothing);
    const Pack own = replaced(replaced(b, behind, a_lane_up(b, b)), at, nothing);
    Real* const to = sum_ + (i * stride_ + step.target.first(b_of(pair)));
    store(to, Pack((load<Pack>(to) + before) + own));
    const Real last_a = step.k == width - 1 ? nothing[0] : a[width - 2];
    to[width] = (to[width] + last_a) + b[width - 1];
  }

  // Element after element; seldom, so out of line.
  [[gnu::noinline]] void add_others(const Real (&of_lane)[n][width], const Step& step, int i) {
    Real* const sum = sum_ + i * stride_;
    for (int l = 0; l < width; ++l)
      for (int a = 0; a < n; ++a) sum[step.target.all[a * lanes + l]] += of_lane[a][l];
  }

  // Of a row some of whose pairs are none: these number by number, and nothing waits. As seldom.
  [[gnu::noinline]] void add_unpaired(const Real (&of_lane)[3][n][width], const LaneNumbers& target,
                                      std::uint16_t row_break, int lane) {
    finish();
    const Step step = next_step(target, row_break, lane);
    for (int i = 0; i < 3; ++i)
      if (step.is_paired)
        for (int pair = 0; pair < n_pairs; ++pair)
          add_pair(of_lane[i], step, (unpaired_of_break(row_break) >> pair & 1) == 0, i, pair);
      else
        add_others(of_lane[i], step, i);
  }
  [[gnu::always_inline]] void add_pair(const Real (&of_lane)[n][width], const Step& step,
                                       bool is_paired, int i, int pair) {
    const auto& of_a = of_lane[a_of(pair)];
    const auto& of_b = of_lane[b_of(pair)];
    if (!is_paired) {
      for (const int a : {a_of(pair), b_of(pair)})
        for (int l = 0; l < width; ++l)
          sum_[i * stride_ + step.target.all[a * lanes + l]] += of_lane[a][l];
      return;
    }
    if (step.following == Following::in_a_row) {
      add_row_of_pair(load<Pack>(of_a), load<Pack>(of_b), step, i, pair);
    } else {
      add_two_rows_of_pair(load<Pack>(of_a), load<Pack>(of_b), step, i, pair);
    }
    sum_[i * stride_ + step.target.first(b_of(pair)) + n_met(step)] += of_a[width - 1];
  }
};

}  // namespace trocar
