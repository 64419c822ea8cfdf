// Regions and node sets from the physical groups of a mesh file.
#include "mesh/raw_mesh_groups.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/quoted.h"
#include "base/sort_unique.h"
#include "mesh/facet_sort.h"

namespace trocar {

namespace {

constexpr int n_dimensions = 4;

// is_used[list * n_dimensions + d]: some cell of dimension d has that group list.
std::vector<bool> used_lists(const RawMesh& raw) {
  std::vector<bool> is_used((raw.group_offset.size() - 1) * n_dimensions, false);
  for (std::int32_t c = 0; c < raw.n_cells(); ++c) {
    const auto list = static_cast<std::size_t>(raw.cell_group[c]);
    is_used[list * n_dimensions + cell_dimension(raw.cell_kind[c])] = true;
  }
  return is_used;
}

std::vector<GroupKey> used_keys(const RawMesh& raw, const std::vector<bool>& is_used, int low,
                                int high) {
  std::vector<GroupKey> keys;
  for (int d = low; d <= high; ++d)
    for (std::size_t list = 0; list + 1 < raw.group_offset.size(); ++list)
      if (is_used[list * n_dimensions + d])
        for (const std::int32_t tag : raw.groups(static_cast<std::int32_t>(list)))
          keys.push_back({d, tag});
  sort_unique(keys);
  return keys;
}

std::string default_name(const GroupKey& key) {
  constexpr std::array<const char*, n_dimensions> kind = {"point", "line", "surface", "volume"};
  return std::string(kind[key.dimension]) + "-" + std::to_string(key.tag);
}

std::int32_t group_number(const GroupNumbers& groups, const GroupKey& key) {
  const auto found = std::lower_bound(groups.key.begin(), groups.key.end(), key);
  return groups.number[found - groups.key.begin()];
}

// Several groups of one cell are fine for node sets, but a hostile file could make them many more
// than its bytes.
void check_memberships(const RawMesh& raw, int dimension) {
  std::uint64_t n = 0;
  for (std::int32_t c = 0; c < raw.n_cells(); ++c)
    if (cell_dimension(raw.cell_kind[c]) < dimension)
      n += raw.groups(raw.cell_group[c]).size() *
           static_cast<std::uint64_t>(n_cell_corners(raw.cell_kind[c]));
  constexpr std::uint64_t always_allowed = 1U << 22;
  if (n > always_allowed + 4 * raw.cell_corner.size())
    throw InputError(raw.file +
                     ": the physical groups overlap so often that their node sets have " +
                     std::to_string(n) + " entries");
}

// is_used: used_lists.
GroupNumbers number_groups(const RawMesh& raw, const std::vector<bool>& is_used, int low_dimension,
                           int high_dimension) {
  GroupNumbers groups;
  std::map<GroupKey, std::int32_t> number_of_key;
  std::map<std::string, std::int32_t> number_of_name;
  const auto add = [&](const GroupKey& key, const std::string& name) {
    const auto next = static_cast<std::int32_t>(groups.name.size());
    const auto [entry, is_new] = number_of_name.emplace(name, next);
    if (is_new) groups.name.push_back(name);
    number_of_key.emplace(key, entry->second);
  };
  for (const NamedGroup& group : raw.named_groups)
    if (group.dimension >= low_dimension && group.dimension <= high_dimension)
      add({group.dimension, group.tag}, group.name);
  const std::vector<GroupKey> used = used_keys(raw, is_used, low_dimension, high_dimension);
  if (used.size() > most_groups)
    throw InputError(raw.file + ": has " + std::to_string(used.size()) +
                     " physical groups, more than the " + std::to_string(most_groups) +
                     " that are read");
  for (const GroupKey& key : used)
    if (!number_of_key.contains(key)) add(key, default_name(key));
  for (const auto& [key, number] : number_of_key) {
    groups.key.push_back(key);
    groups.number.push_back(number);
  }
  return groups;
}

}  // namespace

// A file whose only region has no name says nothing about regions: its name is "".
static void name_only_region(const RawMesh& raw, int dimension, GroupNumbers& groups) {
  const auto is_named = [&](const NamedGroup& group) { return group.dimension == dimension; };
  if (groups.name.size() == 1 &&
      std::none_of(raw.named_groups.begin(), raw.named_groups.end(), is_named))
    groups.name.front().clear();
}

std::vector<std::int32_t> make_regions(const RawMesh& raw, int dimension, Mesh& mesh) {
  const std::vector<bool> is_used = used_lists(raw);
  GroupNumbers groups = number_groups(raw, is_used, dimension, dimension);
  const auto has_cells = [&](std::size_t list) { return is_used[list * n_dimensions + dimension]; };
  if (!has_cells(0)) name_only_region(raw, dimension, groups);
  std::vector<std::int32_t> region(raw.group_offset.size() - 1, -1);
  for (std::size_t list = 1; list < region.size(); ++list) {
    if (!has_cells(list)) continue;
    const std::span<const std::int32_t> tags = raw.groups(static_cast<std::int32_t>(list));
    if (tags.empty()) continue;
    region[list] = group_number(groups, {dimension, tags[0]});
    for (const std::int32_t tag : tags) {
      const std::int32_t other = group_number(groups, {dimension, tag});
      if (other != region[list])
        throw InputError(raw.file + ": some elements belong to two physical groups, " +
                         in_quotes(groups.name[region[list]]) + " and " +
                         in_quotes(groups.name[other]) + "; an element has one region only");
    }
  }
  // Elements without a group make a region without a name.
  auto nameless = std::find(groups.name.begin(), groups.name.end(), "");
  const auto nameless_region = static_cast<std::int32_t>(nameless - groups.name.begin());
  for (std::size_t list = 0; list < region.size(); ++list)
    if (has_cells(list) && region[list] < 0) region[list] = nameless_region;
  const bool needs_nameless =
      std::find(region.begin(), region.end(), nameless_region) != region.end();
  if (nameless == groups.name.end() && needs_nameless) groups.name.emplace_back();
  mesh.region_name = std::move(groups.name);
  return region;
}

GroupNumbers number_groups_below(const RawMesh& raw, int dimension) {
  check_memberships(raw, dimension);
  return number_groups(raw, used_lists(raw), 0, dimension - 1);
}

std::vector<NodeSet> make_node_sets(const RawMesh& raw, const GroupNumbers& groups, int dimension,
                                    std::span<const std::int32_t> new_node) {
  std::vector<NodeSet> sets(groups.name.size());
  for (std::size_t s = 0; s < sets.size(); ++s) sets[s].name = groups.name[s];

  for (int d = 0; d < dimension; ++d)
    for_cells(raw, d, [&](std::int32_t c, std::span<const std::int32_t> corners) {
      for (const std::int32_t tag : raw.groups(raw.cell_group[c])) {
        std::vector<std::int32_t>& node = sets[group_number(groups, {d, tag})].node;
        for (const std::int32_t i : corners)
          if (new_node[i] >= 0) node.push_back(new_node[i]);
      }
    });
  for (NodeSet& set : sets) {
    sort_unique(set.node);
    set.node.shrink_to_fit();
  }
  return sets;
}

// Of each set those in the file, ascending.
static std::vector<std::vector<FacetNodes>> facets_of_sets(const RawMesh& raw,
                                                           const GroupNumbers& groups,
                                                           int dimension,
                                                           std::span<const std::int32_t> new_node) {
  std::vector<std::vector<FacetNodes>> facets(groups.name.size());
  const int d = dimension - 1;
  for_cells(raw, d, [&](std::int32_t c, std::span<const std::int32_t> corners) {
    FacetNodes nodes{-1, -1, -1, -1};
    for (std::size_t a = 0; a < corners.size(); ++a) nodes[a] = new_node[corners[a]];
    std::ranges::sort(nodes);
    for (const std::int32_t tag : raw.groups(raw.cell_group[c]))
      facets[group_number(groups, {d, tag})].push_back(nodes);
  });
  for (std::vector<FacetNodes>& of_set : facets) sort_unique(of_set);
  return facets;
}

// Of the outer facets those all of whose nodes are in the set, ascending.
static std::vector<FacetNodes> facets_within(const NodeSet& set, std::span<const FacetSide> outer) {
  const auto is_in = [&](std::int32_t i) {
    return i < 0 || std::ranges::binary_search(set.node, i);
  };
  std::vector<FacetNodes> facets;
  for (const FacetSide& side : outer)
    if (std::ranges::all_of(side.node, is_in)) facets.push_back(side.node);
  std::ranges::sort(facets);  // triangles before quads
  return facets;
}

void leave_out_facets(const RawMesh& raw, const GroupNumbers& groups, int dimension,
                      std::span<const std::int32_t> new_node, Mesh& mesh) {
  const std::vector<std::vector<FacetNodes>> facets =
      facets_of_sets(raw, groups, dimension, new_node);
  if (std::ranges::all_of(facets, [](const auto& of_set) { return of_set.empty(); })) return;
  const std::vector<FacetSide> outer_sides = single_sides(mesh);
  for (std::size_t s = 0; s < facets.size(); ++s) {
    if (facets[s].empty()) continue;
    const std::vector<FacetNodes> outer = facets_within(mesh.node_sets[s], outer_sides);
    std::vector<FacetNodes> others;
    std::ranges::set_difference(outer, facets[s], std::back_inserter(others));
    // Facets of another shape, halves of quads say, tell nothing.
    if (others.size() < outer.size()) mesh.node_sets[s].left_out = std::move(others);
  }
}

}  // namespace trocar
