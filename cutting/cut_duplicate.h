// Partner nodes: a node whose star falls into several components once facets are opened gets one
// duplicate for each further component. Purely topological, so polylines, branches, crossing cuts
// and closed cut fronts (one component, no duplicate) need no special case. Plane and solid.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/edit.h"
#include "mesh/facets.h"
#include "mesh/mesh.h"

namespace trocar {

// The k-th duplicate is node mesh.n_nodes() + k.
struct Duplication {
  std::vector<std::int32_t> duplicate_parent;  // ascending; components in order of lowest element
  std::vector<CornerChange> corners;           // ascending (element, corner)
};

// Splits the stars of `nodes` (any order, repetitions allowed) along `opened`: (element, facet),
// both sides listed, any order. Facets marked in mesh.cut_facets count as opened too, so that an
// edge or face that an earlier cut opened between two tips separates once its nodes are inner ones.
// `around` and `across` belong to `mesh`. The component with the lowest element keeps the node.
// Costs no more than the stars and one sort of `opened`.
Duplication duplicate_nodes(const Mesh& mesh, std::span<const std::array<std::int32_t, 2>> opened,
                            std::span<const std::int32_t> nodes, const NodeElements& around,
                            const FacetNeighbours& across);

}  // namespace trocar
