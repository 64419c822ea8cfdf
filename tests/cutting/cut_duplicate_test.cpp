#include "cutting/cut_duplicate.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/generate.h"
#include "mesh/quality.h"
#include "mesh_pieces.h"

namespace trocar {
namespace {

using ElementFacet = std::array<std::int32_t, 2>;

// All facets between elements of different side, both sides, plus the nodes on them.
struct Opening {
  std::vector<ElementFacet> facets;
  std::vector<std::int32_t> nodes;
};
template <typename IsOpened>
Opening open_between(const Mesh& mesh, const FacetNeighbours& across, IsOpened is_opened) {
  Opening opening;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < n_facets(mesh.element_type[e]); ++f) {
      if (across.of(e, f) < 0) continue;
      std::vector<Vec3> corners;
      for (const int a : facet_corners(mesh.element_type[e], f))
        if (a >= 0) corners.push_back(mesh.X[mesh.corners(e)[a]]);
      if (!std::all_of(corners.begin(), corners.end(), is_opened)) continue;
      opening.facets.push_back({e, f});
      for (const int a : facet_corners(mesh.element_type[e], f))
        if (a >= 0) opening.nodes.push_back(mesh.corners(e)[a]);
    }
  return opening;
}

template <typename IsOpened>
Duplication duplicate(const Mesh& mesh, IsOpened is_opened) {
  const FacetNeighbours across = facet_neighbours(mesh);
  const Opening opening = open_between(mesh, across, is_opened);
  return duplicate_nodes(mesh, opening.facets, opening.nodes, node_elements(mesh), across);
}

Mesh duplicated(const Duplication& duplication, Mesh mesh) {
  const MeshEdit edit{.duplicate_parent = duplication.duplicate_parent,
                      .corners = duplication.corners};
  apply_edit(edit, mesh);
  return mesh;
}

// A grid line from side to side has ny = 5 nodes, all of which separate.
TEST(CutDuplicate, opened_grid_line_splits_a_rectangle_in_two) {
  const Mesh mesh = make_rectangle(6, 4, 7, 5);
  const Duplication duplication =
      duplicate(mesh, [](const Vec3& X) { return std::abs(X.x() - 3) < 1e-9; });
  EXPECT_EQ(duplication.duplicate_parent.size(), 5u);
  const Mesh after = duplicated(duplication, mesh);
  EXPECT_EQ(n_pieces(after), 2);
  EXPECT_TRUE(validate(after).empty());
}

TEST(CutDuplicate, tips_of_an_inner_crack_stay_single) {
  const Mesh mesh = make_rectangle(6, 4, 7, 5);
  const Duplication duplication = duplicate(
      mesh, [](const Vec3& X) { return std::abs(X.y() - 2) < 1e-9 && X.x() > 0.5 && X.x() < 5.5; });
  // Five nodes on the crack, x = 1..5, of which the first and the last are tips.
  ASSERT_EQ(duplication.duplicate_parent.size(), 3u);
  for (const std::int32_t node : duplication.duplicate_parent) {
    EXPECT_GT(mesh.X[node].x(), 1.5);
    EXPECT_LT(mesh.X[node].x(), 4.5);
  }
  EXPECT_EQ(n_pieces(duplicated(duplication, mesh)), 1);
}

// The crossing has four components, so three duplicates; the 4 + 6 other nodes have one each.
TEST(CutDuplicate, crossing_lines_split_a_rectangle_in_four) {
  const Mesh mesh = make_rectangle(6, 4, 7, 5);
  const FacetNeighbours across = facet_neighbours(mesh);
  Opening opening =
      open_between(mesh, across, [](const Vec3& X) { return std::abs(X.x() - 3) < 1e-9; });
  const Opening second =
      open_between(mesh, across, [](const Vec3& X) { return std::abs(X.y() - 2) < 1e-9; });
  opening.facets.insert(opening.facets.end(), second.facets.begin(), second.facets.end());
  opening.nodes.insert(opening.nodes.end(), second.nodes.begin(), second.nodes.end());
  const Duplication duplication =
      duplicate_nodes(mesh, opening.facets, opening.nodes, node_elements(mesh), across);
  EXPECT_EQ(duplication.duplicate_parent.size(), 4u + 6u + 3u);
  const Mesh after = duplicated(duplication, mesh);
  EXPECT_EQ(n_pieces(after), 4);
  EXPECT_TRUE(validate(after).empty());
}

TEST(CutDuplicate, opened_grid_plane_splits_a_box_of_tetrahedra_in_two) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3(4, 3, 2), {4, 3, 2}, BoxElements::tet4_kuhn);
  const Duplication duplication =
      duplicate(mesh, [](const Vec3& X) { return std::abs(X.x() - 2) < 1e-9; });
  EXPECT_EQ(duplication.duplicate_parent.size(), 4u * 3u);
  const Mesh after = duplicated(duplication, mesh);
  EXPECT_EQ(n_pieces(after), 2);
  EXPECT_TRUE(validate(after).empty());
}

// Half of the plane y <= 2 of 3: nodes on the front y = 2 keep one component.
TEST(CutDuplicate, front_nodes_of_a_half_plane_stay_single) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3(4, 3, 2), {4, 3, 2}, BoxElements::tet4_kuhn);
  const Duplication duplication =
      duplicate(mesh, [](const Vec3& X) { return std::abs(X.x() - 2) < 1e-9 && X.y() < 2 + 1e-9; });
  EXPECT_EQ(duplication.duplicate_parent.size(), 2u * 3u);
  for (const std::int32_t node : duplication.duplicate_parent) EXPECT_LT(mesh.X[node].y(), 1.5);
  EXPECT_EQ(n_pieces(duplicated(duplication, mesh)), 1);
}

TEST(CutDuplicate, facets_opened_earlier_count_as_opened) {
  Mesh mesh = make_rectangle(6, 4, 7, 5);
  const FacetNeighbours across = facet_neighbours(mesh);
  const auto is_line = [](const Vec3& X) { return std::abs(X.x() - 3) < 1e-9; };
  const Opening opening = open_between(mesh, across, is_line);
  for (const auto& [e, f] : opening.facets)
    mesh.cut_facets[e] = static_cast<std::uint8_t>(mesh.cut_facets[e] | 1U << f);
  const Duplication duplication =
      duplicate_nodes(mesh, {}, opening.nodes, node_elements(mesh), across);
  EXPECT_EQ(duplication.duplicate_parent.size(), 5u);
}

TEST(CutDuplicate, lowest_element_keeps_the_node_and_order_of_arguments_is_irrelevant) {
  const Mesh mesh = make_rectangle(6, 4, 7, 5);
  const FacetNeighbours across = facet_neighbours(mesh);
  const NodeElements around = node_elements(mesh);
  Opening opening =
      open_between(mesh, across, [](const Vec3& X) { return std::abs(X.x() - 3) < 1e-9; });
  const Duplication first = duplicate_nodes(mesh, opening.facets, opening.nodes, around, across);
  std::reverse(opening.facets.begin(), opening.facets.end());
  std::reverse(opening.nodes.begin(), opening.nodes.end());
  const Duplication second = duplicate_nodes(mesh, opening.facets, opening.nodes, around, across);
  EXPECT_EQ(first.duplicate_parent, second.duplicate_parent);
  EXPECT_TRUE(std::is_sorted(first.duplicate_parent.begin(), first.duplicate_parent.end()));
  ASSERT_EQ(first.corners.size(), second.corners.size());
  for (std::size_t k = 0; k < first.corners.size(); ++k) {
    EXPECT_EQ(first.corners[k].element, second.corners[k].element);
    EXPECT_EQ(first.corners[k].node, second.corners[k].node);
  }
  for (const std::int32_t parent : first.duplicate_parent)
    for (const CornerChange& change : first.corners)
      EXPECT_FALSE(change.element == around.of(parent)[0] &&
                   mesh.corners(change.element)[change.corner] == parent);
}

}  // namespace
}  // namespace trocar
