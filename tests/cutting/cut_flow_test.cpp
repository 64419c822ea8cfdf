#include "cutting/cut_flow.h"

#include <gtest/gtest.h>

#include <random>

namespace trocar {
namespace {

std::int64_t cost_of(const std::vector<FlowArc>& arcs, const std::vector<std::uint8_t>& side) {
  std::int64_t cost = 0;
  for (const FlowArc& arc : arcs)
    if (side[arc.from] != side[arc.to]) cost += arc.capacity;
  return cost;
}

std::vector<FlowArc> random_arcs(int n_nodes, int n_arcs, std::mt19937& random) {
  std::vector<FlowArc> arcs;
  for (int k = 0; k < n_arcs; ++k) {
    const auto from = std::int32_t(random() % unsigned(n_nodes));
    const auto to = std::int32_t(random() % unsigned(n_nodes));
    if (from != to) arcs.push_back({from, to, std::int64_t(1 + random() % 9)});
  }
  return arcs;
}

TEST(MinimumCut, costs_what_the_cheapest_of_all_partitions_costs) {
  std::mt19937 random(1);
  constexpr int n = 9;
  for (int graph = 0; graph < 200; ++graph) {
    const std::vector<FlowArc> arcs = random_arcs(n, 20, random);
    std::int64_t least = 1 << 30;
    for (unsigned bits = 0; bits < 1U << (n - 2); ++bits) {
      std::vector<std::uint8_t> side{1, 0};
      for (int i = 0; i < n - 2; ++i) side.push_back(bits >> i & 1);
      least = std::min(least, cost_of(arcs, side));
    }
    const std::vector<std::uint8_t> side = minimum_cut(n, 0, 1, arcs);
    EXPECT_EQ(side[0], 1);
    EXPECT_EQ(side[1], 0);
    EXPECT_EQ(cost_of(arcs, side), least) << "graph " << graph;
  }
}

TEST(MinimumCut, leaves_what_hangs_on_neither_terminal_on_the_sinks_side) {
  const std::vector<std::uint8_t> side = minimum_cut(4, 0, 1, {{2, 3, 5}});
  EXPECT_EQ(side, (std::vector<std::uint8_t>{1, 0, 0, 0}));
}

}  // namespace
}  // namespace trocar
