// Nodes in clusters, two edges at most from their middles, to find those near a blade without a
// look at each: as far as edges stretch, a node is near its middle in any deformation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

struct CutIndex;

struct NodeClusters {
  std::vector<std::int32_t> middle;  // (n_clusters) a node; -1: dissolved
  std::vector<double> reach;         // (n_clusters) longest way to a node of it, reference [m]
  std::vector<std::int32_t> begin;   // (n_clusters + 1) into node
  std::vector<std::int32_t> node;
  std::vector<std::int32_t> of_node;  // (n_nodes) cluster, -1: none
  std::vector<std::int32_t> loose;    // nodes of no cluster, in any order
  std::size_t n_with_surface = 0;     // the first clusters, which hold all clustered surface nodes

  std::span<const std::int32_t> nodes(std::size_t c) const {
    return std::span(node).subspan(begin[c], begin[c + 1] - begin[c]);
  }
};

// Of a mesh whose stars and surface are in `index`.
NodeClusters make_clusters(const Mesh& mesh, const CutIndex& index);
// What an edit moves, parts or brings to the surface has no cluster from then on.
void dissolve_cluster_of(std::int32_t node, NodeClusters& clusters);
// Up to n_nodes.
void add_loose_nodes(std::size_t n_nodes, NodeClusters& clusters);

}  // namespace trocar
