// Minimum cut between a source and a sink (Dinic 1970) on graphs of some hundred nodes.
// Whole-number capacities: exact and the same everywhere.
#pragma once

#include <cstdint>
#include <vector>

namespace trocar {

struct FlowArc {
  std::int32_t from = 0, to = 0;
  std::int64_t capacity = 0;  // both ways
};

// 1 for the nodes that the cheapest cut leaves on the source's side; of several cheapest cuts the
// one nearest to the source.
std::vector<std::uint8_t> minimum_cut(std::int32_t n_nodes, std::int32_t source, std::int32_t sink,
                                      const std::vector<FlowArc>& arcs);

}  // namespace trocar
