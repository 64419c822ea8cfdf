// Physical groups of a mesh file: those of the elements' own dimension are regions, those below are
// node sets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/raw_mesh.h"

namespace trocar {

// Appends region_name; the region of each group list, -1 where no cell of this dimension has it.
// Throws InputError where a cell has two regions.
std::vector<std::int32_t> make_regions(const RawMesh& raw, int dimension, Mesh& mesh);

// Nodes of the cells below `dimension`, group by group; new_node (n_nodes) is -1 for dropped ones.
std::vector<NodeSet> make_node_sets(const RawMesh& raw, int dimension,
                                    std::span<const std::int32_t> new_node);

// Fills NodeSet::left_out of the mesh's sets, which are those of make_node_sets: where a set has
// facets in the file, other outer facets with all their nodes in it are none of its.
void leave_out_facets(const RawMesh& raw, int dimension, std::span<const std::int32_t> new_node,
                      Mesh& mesh);

}  // namespace trocar
