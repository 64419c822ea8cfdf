// Hexahedra as tetrahedra, and quads with a hexahedron on one side and tetrahedra on the other.
#include "mesh/hex_split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "base/sort_unique.h"
#include "mesh/edit.h"
#include "mesh/facets.h"
#include "mesh/generate.h"
#include "mesh/node_corners.h"
#include "mesh/quality.h"
#include "mesh_fixtures.h"
#include "mesh_pieces.h"
#include "mesh_split.h"

using namespace trocar;

namespace {

Mesh hex_box(const std::array<int, 3>& n) {
  return make_box(Vec3::Zero(), Vec3::Ones(), n, BoxElements::hex8);
}

void split(Mesh& mesh, const std::vector<std::int32_t>& elements) {
  apply_edit({.splits = splits_of(mesh, elements)}, mesh);
}

// Numbers the nodes anew at random: every pattern of diagonals comes up.
Mesh numbered_at_random(Mesh mesh, unsigned seed) {
  std::vector<std::int32_t> number(mesh.X.size());
  std::iota(number.begin(), number.end(), 0);
  std::mt19937 random(seed);
  std::shuffle(number.begin(), number.end(), random);
  const std::vector<Vec3> X = mesh.X;
  for (std::size_t i = 0; i < X.size(); ++i) mesh.X[number[i]] = X[i];
  for (std::int32_t& i : mesh.corner_node) i = number[i];
  mesh.node_sets.clear();
  return mesh;
}

}  // namespace

TEST(ElementSplit, tetrahedra_fill_a_body_of_hexahedra_whatever_its_numbers) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Mesh mesh = numbered_at_random(hex_box({3, 3, 3}), seed);
    std::vector<std::int32_t> all(27);
    std::iota(all.begin(), all.end(), 0);
    split(mesh, all);
    EXPECT_EQ(mesh.n_elements(), 27 * 6);
    EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << seed;
    EXPECT_NEAR(total_volume(mesh), 1, 1e-14);  // 162 terms of rounding
    // Diagonals agree if no facet inside is left over: the surface is a sphere of 2 x 54 triangles.
    const Surface surface = boundary_surface(mesh);
    EXPECT_EQ(surface.triangle.size(), 108U);
    EXPECT_EQ(euler_characteristic(surface.triangle), 2);
  }
}

TEST(ElementSplit, neighbours_agree_about_diagonals_of_any_ranks) {
  std::mt19937 random(5);
  for (int k = 0; k < 20; ++k) {
    Mesh mesh = hex_box({3, 3, 3});
    for (std::size_t i = 0; i < mesh.X.size(); ++i)
      mesh.hex_split_rank.push_back(static_cast<std::uint8_t>(random() % 3));
    std::vector<std::int32_t> all(27);
    std::iota(all.begin(), all.end(), 0);
    split(mesh, all);
    EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << k;
    EXPECT_EQ(boundary_surface(mesh).triangle.size(), 108U);
    EXPECT_NEAR(total_volume(mesh), 1, 1e-14);  // 162 terms of rounding
  }
}

TEST(ElementSplit, a_body_of_both_kinds_is_one_piece_with_the_surface_of_the_uncut_one) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Mesh mesh = numbered_at_random(hex_box({3, 3, 3}), seed);
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < mesh.X.size() && seed % 2 == 1; ++i)
      mesh.hex_split_rank.push_back(static_cast<std::uint8_t>(random() % 3));
    const Surface before = boundary_surface(mesh);
    split(mesh, {1, 4, 13, 14, 26});
    EXPECT_EQ(n_pieces(mesh), 1) << seed;
    auto sorted = [](std::vector<std::array<std::int32_t, 3>> t) {
      for (auto& nodes : t) std::sort(nodes.begin(), nodes.end());
      std::sort(t.begin(), t.end());
      return t;
    };
    EXPECT_EQ(sorted(boundary_surface(mesh).triangle), sorted(before.triangle)) << seed;
    EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << seed;
  }
}

TEST(ElementSplit, a_tetrahedron_without_a_hexahedron_across_stays_at_the_surface) {
  Mesh mesh = hex_box({2, 1, 1});
  split(mesh, {0});
  // Two triangles on the quad between the halves; the hexahedron sees both of them.
  const std::vector<SplitQuad> quads = split_quads(mesh, single_sides(mesh));
  ASSERT_EQ(quads.size(), 1U);
  EXPECT_EQ(mesh.element_type[quads[0].hex], ElementType::hex8);
  std::vector<std::int32_t> nodes;
  for (const FacetSide& triangle : quads[0].triangle) {
    EXPECT_EQ(mesh.element_type[triangle.element], ElementType::tet4);
    nodes.insert(nodes.end(), triangle.node.begin() + 1, triangle.node.end());
  }
  for (const std::int32_t i : nodes) EXPECT_NEAR(mesh.X[i].x(), 0.5, 1e-15);
  sort_unique(nodes);
  EXPECT_EQ(nodes.size(), 4U);
  EXPECT_EQ(boundary_surface(mesh).triangle.size(), 20U);  // 2 x 10 quads
}

TEST(ElementSplit, gives_parts_the_values_of_their_hexahedron_and_others_keep_their_numbers) {
  Mesh mesh = hex_box({3, 1, 1});
  mesh.region_name = {"a", "b"};
  mesh.element_region = {0, 1, 0};
  mesh.density_factor = {1, 2, 3};
  mesh.cut_facets[1] = 1 << 3;  // right
  MeshEdit edit;
  edit.splits = {split_of(mesh, 1)};
  const Mesh before = mesh;
  apply_edit(edit, mesh);
  EXPECT_EQ(edited_elements(before, node_corners(before), edit), (std::vector<std::int32_t>{1}));
  EXPECT_EQ(mesh.element_region, (std::vector<std::int32_t>{0, 1, 0, 1, 1, 1, 1, 1}));
  EXPECT_EQ(mesh.density_factor, (std::vector<double>{1, 2, 3, 2, 2, 2, 2, 2}));
  EXPECT_EQ(mesh.split_hexahedra, (std::vector<SplitHexahedron>{{1, 3}}));
  EXPECT_TRUE(validate(mesh).empty());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const bool stays = e == 0 || e == 2;
    EXPECT_EQ(mesh.element_type[e], stays ? ElementType::hex8 : ElementType::tet4);
    if (stays) {
      EXPECT_TRUE(std::ranges::equal(mesh.corners(e), before.corners(e)));
    }
  }
  // Of all facets, those two on the right side carry the mark.
  int n_marked = 0;
  for (std::int32_t e = 1; e < 7; ++e)
    for (int f = 0; f < 4; ++f) {
      if ((mesh.cut_facets[e] >> f & 1) == 0) continue;
      ++n_marked;
      for (int c = 0; c < 4; ++c)
        EXPECT_EQ(c != f, std::abs(mesh.X[mesh.corners(e)[c]].x() - 2.0 / 3) < 1e-15);
    }
  EXPECT_EQ(n_marked, 2);
}

TEST(ElementSplit, copies_of_nodes_leave_the_diagonals_as_they_were) {
  Mesh mesh = hex_box({2, 2, 2});
  const auto before = hex_tets(mesh, 7);
  MeshEdit edit;  // node 13, the middle, for element 7 alone: topologically absurd, but an edit
  edit.duplicate_parent = {13};
  edit.corners = {{7, 0, mesh.n_nodes()}};
  ASSERT_EQ(mesh.corners(7)[0], 13);
  apply_edit(edit, mesh);
  EXPECT_EQ(hex_tets(mesh, 7), before);
  EXPECT_EQ(mesh.uncut_node(mesh.n_nodes() - 1), 13);
}
