// From sides to opened facets and partner nodes, such that the body stays a body: the outer surface
// is a 2-manifold.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cutting/cut_duplicate.h"
#include "cutting/cut_label.h"

namespace trocar {

using TetFacet = std::array<std::int32_t, 2>;  // local element, facet

// All numbers local. A facet between nodes that all keep one piece is marked, but joined until one
// of them is parted.
struct CutOpening {
  std::vector<TetFacet> facet;                      // both sides, ascending
  Duplication duplication;                          // the k-th duplicate is node n_nodes + k
  std::vector<std::array<std::int32_t, 4>> corner;  // of each element afterwards
  std::vector<TetFacet> refused;  // lower side of facets that must stay joined for now
};

// A patch as openings of it read it, all of them the same.
struct PatchMesh {
  Mesh mesh;
  NodeElements around;
  FacetNeighbours across;
};
PatchMesh make_patch_mesh(const CutPatch& patch);

// Closes facets, from the rim inwards, until every node's link is one disc and no node of
// `stays_whole` (n_nodes) is parted.
CutOpening open_facets(const CutSurroundings& around, const PatchMesh& mesh,
                       const CutLabels& labels, const std::vector<std::uint8_t>& stays_whole);

// Nodes whose link would be no disc if all facets between the sides were opened, ascending.
std::vector<std::int32_t> pinched_nodes(const CutSurroundings& around, const PatchMesh& mesh,
                                        const CutLabels& labels);

// Nodes of the front that stand beside the surface: a node can only be pulled onto it before it is
// parted.
std::vector<std::uint8_t> unripe_nodes(const CutSurroundings& around, const CutLabels& labels);

// Whether element e is joined across facet f once the corners are as in `corner`.
bool is_joined(const CutPatch& patch, const std::vector<std::array<std::int32_t, 4>>& corner,
               std::int32_t e, int f);

}  // namespace trocar
