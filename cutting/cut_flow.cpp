// Dinic's algorithm: blocking flows on level graphs.
#include "cutting/cut_flow.h"

#include <algorithm>
#include <limits>

namespace trocar {

namespace {

struct Graph {
  std::vector<std::int32_t> offset, head;  // arcs leaving each node
  std::vector<std::int32_t> twin;          // the same arc backwards
  std::vector<std::int64_t> residual;
};

}  // namespace

static Graph make_graph(std::int32_t n_nodes, const std::vector<FlowArc>& arcs) {
  Graph graph;
  graph.offset.assign(static_cast<std::size_t>(n_nodes) + 1, 0);
  for (const FlowArc& arc : arcs) {
    ++graph.offset[arc.from + 1];
    ++graph.offset[arc.to + 1];
  }
  for (std::int32_t i = 0; i < n_nodes; ++i) graph.offset[i + 1] += graph.offset[i];
  std::vector<std::int32_t> next(graph.offset.begin(), graph.offset.end() - 1);
  graph.head.resize(arcs.size() * 2);
  graph.twin.resize(arcs.size() * 2);
  graph.residual.resize(arcs.size() * 2);
  for (const FlowArc& arc : arcs) {
    const std::int32_t forth = next[arc.from]++, back = next[arc.to]++;
    graph.head[forth] = arc.to;
    graph.head[back] = arc.from;
    graph.twin[forth] = back;
    graph.twin[back] = forth;
    graph.residual[forth] = graph.residual[back] = arc.capacity;
  }
  return graph;
}

// Steps from the source over arcs with capacity left; -1 where it can't be reached.
static std::vector<std::int32_t> levels(const Graph& graph, std::int32_t source) {
  std::vector<std::int32_t> level(graph.offset.size() - 1, -1), queue{source};
  level[source] = 0;
  for (std::size_t at = 0; at < queue.size(); ++at) {
    const std::int32_t i = queue[at];
    for (std::int32_t k = graph.offset[i]; k < graph.offset[i + 1]; ++k)
      if (graph.residual[k] > 0 && level[graph.head[k]] < 0) {
        level[graph.head[k]] = level[i] + 1;
        queue.push_back(graph.head[k]);
      }
  }
  return level;
}

// Fills the level graph path by path; `next` remembers dead ends.
static void block(Graph& graph, std::int32_t source, std::int32_t sink,
                  const std::vector<std::int32_t>& level) {
  std::vector<std::int32_t> next(graph.offset.begin(), graph.offset.end() - 1), path;
  std::int32_t i = source;
  while (true) {
    if (i == sink) {
      std::int64_t amount = std::numeric_limits<std::int64_t>::max();
      for (const std::int32_t k : path) amount = std::min(amount, graph.residual[k]);
      for (const std::int32_t k : path) {
        graph.residual[k] -= amount;
        graph.residual[graph.twin[k]] += amount;
      }
      path.clear();
      i = source;
      continue;
    }
    std::int32_t& k = next[i];
    while (k < graph.offset[i + 1] &&
           !(graph.residual[k] > 0 && level[graph.head[k]] == level[i] + 1))
      ++k;
    if (k < graph.offset[i + 1]) {
      path.push_back(k);
      i = graph.head[k];
    } else {
      if (path.empty()) return;
      i = graph.head[graph.twin[path.back()]];
      path.pop_back();
      ++next[i];
    }
  }
}

std::vector<std::uint8_t> minimum_cut(std::int32_t n_nodes, std::int32_t source, std::int32_t sink,
                                      const std::vector<FlowArc>& arcs) {
  Graph graph = make_graph(n_nodes, arcs);
  std::vector<std::int32_t> level = levels(graph, source);
  while (level[sink] >= 0) {
    block(graph, source, sink, level);
    level = levels(graph, source);
  }
  std::vector<std::uint8_t> is_source_side(static_cast<std::size_t>(n_nodes));
  for (std::int32_t i = 0; i < n_nodes; ++i) is_source_side[i] = level[i] >= 0 ? 1 : 0;
  return is_source_side;
}

}  // namespace trocar
