#include "cutting/cut_clusters.h"

#include <algorithm>
#include <cmath>

#include "cutting/cut_index.h"

namespace trocar {

// Takes in what has no cluster of the nodes around `from`, `way` from the middle; returns the
// longest way to one of them.
static double add_around(const Mesh& mesh, const CutIndex& index, std::int32_t from, double way,
                         NodeClusters& clusters) {
  const auto c = static_cast<std::int32_t>(clusters.middle.size());
  double longest = 0;  // squared
  for (const std::int32_t e : index.star(from))
    for (const std::int32_t i : mesh.corners(e)) {
      if (clusters.of_node[i] >= 0) continue;
      clusters.of_node[i] = c;
      clusters.node.push_back(i);
      longest = std::max(longest, (mesh.X[i] - mesh.X[from]).squaredNorm());
    }
  return way + std::sqrt(longest);
}

// Takes in what has no cluster within two edges of node `middle`. (One edge saves 10 of 120 ms of
// set-up and costs the cut of a million tetrahedra 0.5 of 5.5 ms.)
static void add_cluster(const Mesh& mesh, const CutIndex& index, std::int32_t middle,
                        NodeClusters& clusters) {
  clusters.of_node[middle] = static_cast<std::int32_t>(clusters.middle.size());
  const std::size_t first = clusters.node.size();
  clusters.node.push_back(middle);
  double reach = add_around(mesh, index, middle, 0, clusters);
  const std::size_t last = clusters.node.size();
  for (std::size_t k = first + 1; k < last; ++k) {
    const std::int32_t i = clusters.node[k];
    const double way = (mesh.X[i] - mesh.X[middle]).norm();
    reach = std::max(reach, add_around(mesh, index, i, way, clusters));
  }
  clusters.middle.push_back(middle);
  clusters.reach.push_back(reach);
  clusters.begin.push_back(static_cast<std::int32_t>(clusters.node.size()));
}

NodeClusters make_clusters(const Mesh& mesh, const CutIndex& index) {
  NodeClusters clusters;
  clusters.of_node.assign(mesh.X.size(), -1);
  clusters.begin.push_back(0);
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (index.is_surface[i] != 0 && clusters.of_node[i] < 0) add_cluster(mesh, index, i, clusters);
  clusters.n_with_surface = clusters.middle.size();
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (clusters.of_node[i] < 0) add_cluster(mesh, index, i, clusters);
  return clusters;
}

void dissolve_cluster_of(std::int32_t node, NodeClusters& clusters) {
  const std::int32_t c = clusters.of_node[node];
  if (c < 0) return;
  clusters.middle[c] = -1;
  for (const std::int32_t i : clusters.nodes(static_cast<std::size_t>(c))) {
    clusters.of_node[i] = -1;
    clusters.loose.push_back(i);
  }
}

void add_loose_nodes(std::size_t n_nodes, NodeClusters& clusters) {
  for (std::size_t i = clusters.of_node.size(); i < n_nodes; ++i)
    clusters.loose.push_back(static_cast<std::int32_t>(i));
  clusters.of_node.resize(n_nodes, -1);
}

}  // namespace trocar
