// Physical groups of a mesh file: those of the elements' own dimension are regions, those below are
// node sets.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/raw_mesh.h"

namespace trocar {

// More are refused.
inline constexpr std::size_t most_groups = 100000;

struct GroupKey {
  int dimension = 0;
  std::int32_t tag = 0;
  auto operator<=>(const GroupKey&) const = default;
};
// The groups of some dimensions, numbered: those with a name in the order of the file, then the
// others by dimension and tag, called "surface-7". Groups of the same name are one.
struct GroupNumbers {
  std::vector<GroupKey> key;         // (n_keys) ascending
  std::vector<std::int32_t> number;  // (n_keys)
  std::vector<std::string> name;     // (n_numbers)
};
// Of the cells below `dimension`. Throws InputError where there are too many, or where they overlap
// too often.
GroupNumbers number_groups_below(const RawMesh& raw, int dimension);

// Appends region_name; the region of each group list, -1 where no cell of this dimension has it.
// Throws InputError where a cell has two regions.
std::vector<std::int32_t> make_regions(const RawMesh& raw, int dimension, Mesh& mesh);

// Nodes of the cells below `dimension`, group by group as number_groups_below has them; new_node
// (n_nodes) is -1 for dropped ones.
std::vector<NodeSet> make_node_sets(const RawMesh& raw, const GroupNumbers& groups, int dimension,
                                    std::span<const std::int32_t> new_node);

// Fills NodeSet::left_out of the mesh's sets, which are those of make_node_sets: where a set has
// facets in the file, other outer facets with all their nodes in it are none of its.
void leave_out_facets(const RawMesh& raw, const GroupNumbers& groups, int dimension,
                      std::span<const std::int32_t> new_node, Mesh& mesh);

}  // namespace trocar
