// What an edit that puts nodes on edges makes of the tetrahedra around these, beside hexahedra that
// it splits.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "base/sort_unique.h"
#include "largest.h"
#include "mesh/edit.h"
#include "mesh/element_boxes.h"
#include "mesh/generate.h"
#include "mesh/node_corners.h"
#include "mesh/partition.h"
#include "mesh/quality.h"
#include "mesh/surface_edit.h"
#include "mesh_joined.h"
#include "mesh_split.h"

namespace trocar {
namespace {

// 24 hexahedra beside a box of tetrahedra. Some hexahedra are split, and edges of tetrahedra that
// share no element are bisected.
struct BisectedBox {
  Mesh mesh = joined(make_box(Vec3(3, 0, 0), Vec3(4, 1, 1), {4, 3, 2}, BoxElements::hex8),
                     make_box(Vec3::Zero(), Vec3::Ones(), {4, 3, 2}, BoxElements::tet4_kuhn));
  MeshEdit edit;

  explicit BisectedBox(unsigned seed) {
    std::mt19937 random(seed);
    mesh.node_sets = {{.name = "left", .node = {}, .left_out = {}}};
    for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.X[i].x() < 0.3) mesh.node_sets[0].node.push_back(i);
    for (std::uint8_t& facets : mesh.cut_facets) facets = static_cast<std::uint8_t>(random() % 16);
    std::vector<std::uint8_t> is_split(mesh.element_type.size(), 0);
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
      if (mesh.element_type[e] == ElementType::hex8 && random() % 3 == 0)
        edit.splits.push_back(split_of(mesh, e));
    const NodeElements around = node_elements(mesh);
    for (const auto& [a, b] : mesh_edges(mesh)) {
      std::vector<std::int32_t> ring;
      std::ranges::set_intersection(around.of(a), around.of(b), std::back_inserter(ring));
      const auto is_taken = [&](std::int32_t e) {
        return is_split[e] != 0 || mesh.element_type[e] == ElementType::hex8;
      };
      if (std::ranges::any_of(ring, is_taken)) continue;
      edit.inserted.push_back({.end = {a, b}, .s = 0.2 + 0.06 * double(random() % 11)});
      const std::int32_t node = mesh.n_nodes() + std::int32_t(edit.inserted.size()) - 1;
      for (const std::int32_t e : ring) {
        is_split[e] = 1;
        edit.splits.push_back(halves(e, {a, b}, node));
      }
    }
    std::ranges::sort(edit.splits, {}, &ElementSplit::element);
  }
  ElementSplit halves(std::int32_t e, std::array<std::int32_t, 2> end, std::int32_t node) const {
    ElementSplit split{.element = e, .n_tets = 2};
    for (std::size_t k = 0; k < 2; ++k) {
      std::ranges::copy(mesh.corners(e), split.corner[k].begin());
      std::ranges::replace(split.corner[k], end[k], node);
    }
    return split;
  }
  Mesh after() const {
    Mesh result = mesh;
    apply_edit(edit, result);
    return result;
  }
};

constexpr unsigned n_bisected_boxes = 8;

TEST(EditOfEdgeNodes, leaves_a_sound_mesh_of_the_same_volume_and_mass) {
  for (unsigned seed = 0; seed < n_bisected_boxes; ++seed) {
    const BisectedBox box(seed);
    ASSERT_GT(box.edit.inserted.size(), 5u);
    const Mesh after = box.after();
    EXPECT_TRUE(validate(after).empty()) << validate(after).front();
    const std::vector<std::int32_t> parent = wholes_of(box.mesh, box.edit);
    ASSERT_EQ(std::ssize(parent), after.n_elements());
    std::vector<double> volume(box.mesh.element_type.size(), 0.0);
    for (std::int32_t e = 0; e < after.n_elements(); ++e)
      volume[parent[e]] += element_volume(after, e, after.X);
    for (std::int32_t e = 0; e < box.mesh.n_elements(); ++e)
      EXPECT_NEAR(volume[e], element_volume(box.mesh, e, box.mesh.X), 1e-14);  // rounding
    const std::array<double, 1> density{1000};
    const std::vector<double> before = lumped_mass(box.mesh, density, 1),
                              now = lumped_mass(after, density, 1);
    EXPECT_NEAR(std::accumulate(now.begin(), now.end(), 0.0),
                std::accumulate(before.begin(), before.end(), 0.0), 1e-10);
  }
}

TEST(EditOfEdgeNodes, keeps_affine_fields) {
  const BisectedBox box(1);
  const Mesh after = box.after();
  Mat3 A;
  A << 1.1, 0.2, -0.1, 0.3, 0.9, 0.05, -0.2, 0.1, 1.2;
  const auto field_of = [&](const Mesh& mesh) {
    std::vector<double> field;
    for (const Vec3& X : mesh.X) {
      const Vec3 q = A * X + Vec3(1, 2, 3);
      field.insert(field.end(), {q.x(), q.y(), q.z()});
    }
    return field;
  };
  std::vector<double> field = field_of(box.mesh);
  apply_edit(box.edit, box.mesh, 3, field);
  const std::vector<double> expected = field_of(after);
  EXPECT_LE(largest_difference(field, expected), 1e-14 * 10);
}

TEST(EditOfEdgeNodes, numbers_elements_by_what_they_are_parts_of) {
  for (unsigned seed = 0; seed < n_bisected_boxes; ++seed) {
    const BisectedBox box(seed);
    const SplitNumbers numbers(box.edit.splits, box.mesh.n_elements());
    const std::vector<std::int32_t> whole = wholes_of(box.mesh, box.edit);
    for (std::int32_t e = 0; e < std::ssize(whole); ++e) {
      EXPECT_EQ(numbers.whole(e), whole[e]);
      EXPECT_EQ(numbers.part(whole[e], numbers.place_in_whole(e)), e);
      EXPECT_EQ(numbers.is_split(whole[e]), std::ranges::count(whole, whole[e]) > 1);
    }
    std::vector<std::int32_t> before(box.mesh.element_type.size()), after(whole.size());
    std::iota(before.begin(), before.end(), 0);
    std::iota(after.begin(), after.end(), 0);
    EXPECT_EQ(numbers.all_after(before), after);
  }
}

TEST(EditOfEdgeNodes, carries_corners_and_surface_and_boxes) {
  for (unsigned seed = 0; seed < n_bisected_boxes; ++seed) {
    const BisectedBox box(seed);
    const Mesh after = box.after();
    NodeCorners corners = node_corners(box.mesh);
    const std::vector<std::int32_t> before = edited_elements(box.mesh, corners, box.edit);
    apply_edit(box.edit, box.mesh, corners);
    const NodeCorners fresh = node_corners(after);
    for (std::int32_t i = 0; i < after.n_nodes(); ++i)
      EXPECT_EQ(elements_around(corners, {&i, 1}), elements_around(fresh, {&i, 1})) << i;
    const SplitNumbers numbers(box.edit.splits, box.mesh.n_elements());
    std::vector<std::int32_t> nodes = nodes_of(after, numbers.all_after(before));
    const std::vector<std::int32_t> touching = elements_around(corners, nodes);
    Surface surface = boundary_surface(box.mesh);
    update_surface(after,
                   {nodes, touching,
                    make_sub_mesh(after, elements_around(corners, nodes_of(after, touching)))},
                   surface);
    const Surface expected = boundary_surface(after);
    EXPECT_EQ(surface.triangle, expected.triangle);
    EXPECT_EQ(surface.element, expected.element);
    EXPECT_EQ(surface.is_cut, expected.is_cut);
    EXPECT_EQ(surface.node, expected.node);
    ElementBoxes boxes = make_element_boxes(box.mesh, box.mesh.X);
    update_element_boxes(after, after.X, {box.edit.splits, nodes, touching}, boxes);
    for (std::int32_t e = 0; e < after.n_elements(); ++e)
      EXPECT_TRUE(
          std::ranges::binary_search(elements_near(element_box(after, e, after.X), 0, boxes), e));
  }
}

TEST(EditOfEdgeNodes, gives_parts_the_opened_facets_of_their_element_that_they_lie_on) {
  const BisectedBox box(2);
  const Mesh after = box.after();
  const std::vector<std::int32_t> parent = wholes_of(box.mesh, box.edit);
  for (std::int32_t e = 0; e < after.n_elements(); ++e) {
    const std::int32_t whole = parent[e];
    if (box.mesh.element_type[whole] != ElementType::tet4) continue;
    for (int f = 0; f < 4; ++f) {
      // By geometry: the facet of the whole whose plane holds the three nodes.
      bool is_open = false;
      for (int g = 0; g < 4; ++g) {
        const auto W = [&](int c) { return box.mesh.X[box.mesh.corners(whole)[c]]; };
        const std::array<int, 4> k = facet_corners(ElementType::tet4, g);
        const Vec3 n = (W(k[1]) - W(k[0])).cross(W(k[2]) - W(k[0])).normalized();
        bool is_on = true;
        for (int c = 0; c < 4; ++c)
          is_on =
              is_on && (c == f || std::abs(n.dot(after.X[after.corners(e)[c]] - W(k[0]))) < 1e-12);
        is_open = is_open || (is_on && (box.mesh.cut_facets[whole] >> g & 1) != 0);
      }
      EXPECT_EQ((after.cut_facets[e] >> f & 1) != 0, is_open) << e << " " << f;
    }
  }
}

TEST(EditOfEdgeNodes, puts_a_node_into_the_sets_of_both_ends_and_parts_facets_that_are_left_out) {
  BisectedBox box(3);
  const EdgeNode& node = box.edit.inserted.front();
  const auto [a, b] = node.end;
  std::int32_t c = 0;  // any other node
  while (c == a || c == b) ++c;
  FacetNodes facet{-1, a, b, c};
  std::ranges::sort(facet);
  box.mesh.node_sets[0].left_out = {facet};
  const Mesh after = box.after();
  for (std::size_t k = 0; k < box.edit.inserted.size(); ++k) {
    const auto& end = box.edit.inserted[k].end;
    const auto is_left = [&](std::int32_t i) {
      return std::ranges::binary_search(box.mesh.node_sets[0].node, i);
    };
    EXPECT_EQ(std::ranges::binary_search(after.node_sets[0].node,
                                         box.mesh.n_nodes() + static_cast<std::int32_t>(k)),
              is_left(end[0]) && is_left(end[1]));
  }
  const std::int32_t m = box.mesh.n_nodes();
  std::vector<FacetNodes> expected{{-1, a, c, m}, {-1, b, c, m}};
  for (FacetNodes& half : expected) std::ranges::sort(half);
  std::ranges::sort(expected);
  EXPECT_EQ(after.node_sets[0].left_out, expected);
  EXPECT_EQ(after.uncut_node(m), m);
}

TEST(EditOfEdgeNodes, gives_each_rank_the_part_of_the_edited_mesh) {
  for (unsigned seed = 0; seed < n_bisected_boxes; ++seed) {
    const BisectedBox box(seed);
    const Mesh after = box.after();
    const std::vector<std::int32_t> owner_before = partition_nodes(box.mesh, 3);
    std::vector<std::int32_t> owner = owner_before;
    apply_edit_to_owners(box.edit, owner);
    NodeCorners corners = node_corners(box.mesh);
    const std::vector<std::int32_t> before = edited_elements(box.mesh, corners, box.edit);
    apply_edit(box.edit, box.mesh, corners);
    std::vector<std::int32_t> nodes = nodes_of(box.mesh, before);
    const SplitNumbers numbers(box.edit.splits, box.mesh.n_elements());
    for (const std::int32_t i : nodes_of(after, numbers.all_after(before))) nodes.push_back(i);
    sort_unique(nodes);
    for (int rank = 0; rank < 3; ++rank) {
      Part part = make_part(box.mesh, owner_before, rank);
      split_elements(after, owner, box.edit.splits, part);
      update_part(after, corners, owner, nodes, part);
      const Part expected = make_part(after, owner, rank);
      EXPECT_EQ(part.element_global, expected.element_global);
      EXPECT_EQ(part.node_global, expected.node_global);
      EXPECT_EQ(part.n_owned, expected.n_owned);
      EXPECT_EQ(part.node_local, expected.node_local);
    }
  }
}

}  // namespace
}  // namespace trocar
