// What an edit that splits hexahedra makes of numbers, corners and boxes of elements.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "mesh/edit.h"
#include "mesh/element_boxes.h"
#include "mesh/generate.h"
#include "mesh/node_corners.h"
#include "mesh/quality.h"
#include "mesh_split.h"

namespace trocar {
namespace {

// 60 hexahedra of which some are split, neighbours among them, the first and the last by turns; and
// copies of nodes at every second corner that has them, which keeps no body whole.
struct SplitBox {
  Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {5, 4, 3}, BoxElements::hex8);
  MeshEdit edit;

  explicit SplitBox(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::int32_t> elements;
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
      if (random() % (seed + 1) < 2) elements.push_back(e);
    edit.splits = splits_of(mesh, elements);
    Mesh after = mesh;
    apply_edit(edit, after);
    edit.duplicate_parent = {20, 47, 63};
    int n_found = 0;
    for (std::int32_t e = 0; e < after.n_elements(); ++e)
      for (std::int32_t a = 0; a < std::ssize(after.corners(e)); ++a)
        for (std::int32_t k = 0; k < 3; ++k)
          if (after.corners(e)[a] == edit.duplicate_parent[k] && ++n_found % 2 == 0)
            edit.corners.push_back({e, a, mesh.n_nodes() + k});
  }
};

constexpr unsigned n_split_boxes = 12;

TEST(EditOfSplits, numbers_elements_by_what_they_are_parts_of) {
  for (unsigned seed = 0; seed < n_split_boxes; ++seed) {
    const SplitBox box(seed);
    const SplitNumbers numbers(box.edit.splits, box.mesh.n_elements());
    const std::vector<std::int32_t> whole = wholes_of(box.mesh, box.edit);
    std::vector<std::int32_t> n_parts(box.mesh.element_type.size(), 0);
    for (std::int32_t e = 0; e < std::ssize(whole); ++e) {
      EXPECT_EQ(numbers.whole(e), whole[e]);
      EXPECT_EQ(numbers.place_in_whole(e), n_parts[whole[e]]);
      EXPECT_EQ(numbers.part(whole[e], n_parts[whole[e]]++), e);
    }
    for (std::int32_t e = 0; e < box.mesh.n_elements(); ++e) {
      EXPECT_EQ(numbers.is_split(e), n_parts[e] == 6);
      const std::vector<std::int32_t> all = numbers.all_after({&e, 1});
      EXPECT_EQ(std::ssize(all), n_parts[e]);
      EXPECT_TRUE(std::ranges::is_sorted(all));
      for (const std::int32_t part : all) EXPECT_EQ(whole[part], e);
    }
  }
}

TEST(EditOfSplits, leaves_others_their_corners) {
  for (unsigned seed = 0; seed < n_split_boxes; ++seed) {
    const SplitBox box(seed);
    const SplitNumbers numbers(box.edit.splits, box.mesh.n_elements());
    Mesh after = box.mesh;
    apply_edit({.splits = box.edit.splits}, after);
    ASSERT_TRUE(validate(after).empty()) << validate(after).front();
    for (std::int32_t e = 0; e < box.mesh.n_elements(); ++e) {
      if (numbers.is_split(e)) continue;
      EXPECT_TRUE(std::ranges::equal(after.corners(e), box.mesh.corners(e)));
      EXPECT_EQ(after.element_type[e], ElementType::hex8);
    }
    for (const ElementSplit& split : box.edit.splits)
      for (std::size_t k = 0; k < split.corner.size(); ++k) {
        const std::int32_t e = numbers.part(split.element, static_cast<std::int32_t>(k));
        EXPECT_TRUE(std::ranges::equal(after.corners(e), split.corner[k]));
        EXPECT_EQ(after.element_type[e], ElementType::tet4);
      }
    for (const CornerChange& change : box.edit.corners)
      EXPECT_EQ(node_before(numbers, box.mesh, change),
                after.corners(change.element)[change.corner]);
  }
}

TEST(EditOfSplits, carries_the_corners_at_nodes) {
  for (unsigned seed = 0; seed < n_split_boxes; ++seed) {
    const SplitBox box(seed);
    ASSERT_FALSE(box.edit.corners.empty());
    NodeCorners corners = node_corners(box.mesh);
    apply_edit(box.edit, box.mesh, corners);
    Mesh after = box.mesh;
    apply_edit(box.edit, after);
    const NodeCorners fresh = node_corners(after);
    for (std::int32_t i = 0; i < after.n_nodes(); ++i)
      EXPECT_EQ(elements_around(corners, {&i, 1}), elements_around(fresh, {&i, 1})) << i;
  }
}

TEST(EditOfSplits, keeps_tetrahedra_in_the_box_of_their_hexahedron) {
  for (unsigned seed = 0; seed < n_split_boxes; ++seed) {
    const SplitBox box(seed);
    ElementBoxes boxes = make_element_boxes(box.mesh, box.mesh.X);
    const std::vector<std::int32_t> leaf = boxes.leaf;
    Mesh after = box.mesh;
    apply_edit(box.edit, after);
    std::vector<std::int32_t> nodes(after.X.size()), elements(after.element_type.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    std::iota(elements.begin(), elements.end(), 0);
    update_element_boxes(after, after.X, {box.edit.splits, nodes, elements}, boxes);
    const std::vector<std::int32_t> whole = wholes_of(box.mesh, box.edit);
    for (const std::int32_t e : elements) EXPECT_EQ(boxes.leaf[e], leaf[whole[e]]);
    EXPECT_EQ(elements_near(boxes.box[1], 0, boxes), elements);
    for (const std::int32_t e : elements) {
      const Box own = element_box(after, e, after.X);
      EXPECT_TRUE(std::ranges::binary_search(elements_near(own, 0, boxes), e));
    }
  }
}

// One of the parts is split again, as are two more hexahedra.
TEST(EditOfSplits, finds_the_boxes_of_parts_of_several_edits) {
  SplitBox box(3);
  box.edit.duplicate_parent.clear();
  box.edit.corners.clear();
  ElementBoxes boxes = make_element_boxes(box.mesh, box.mesh.X);
  Mesh mesh = box.mesh;
  const auto apply = [&](const MeshEdit& edit) {
    apply_edit(edit, mesh);
    std::vector<std::int32_t> nodes(mesh.X.size()), elements(mesh.element_type.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    std::iota(elements.begin(), elements.end(), 0);
    update_element_boxes(mesh, mesh.X, {edit.splits, nodes, elements}, boxes);
    EXPECT_EQ(elements_near(boxes.box[1], 0, boxes), elements);
    for (const std::int32_t e : elements)
      EXPECT_TRUE(
          std::ranges::binary_search(elements_near(element_box(mesh, e, mesh.X), 0, boxes), e));
  };
  apply(box.edit);
  std::vector<std::int32_t> whole;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    if (mesh.element_type[e] == ElementType::hex8 && whole.size() < 2) whole.push_back(e);
  ASSERT_EQ(whole.size(), 2U);
  apply({.splits = splits_of(mesh, whole)});
  const std::int32_t last = mesh.n_elements() - 1, node = mesh.n_nodes();
  const auto corner = mesh.corners(last);
  ElementSplit split{.element = last, .n_tets = 2};
  for (std::size_t k = 0; k < 2; ++k) {
    std::ranges::copy(corner, split.corner[k].begin());
    split.corner[k][k] = node;
  }
  const auto [a, b] = std::minmax(corner[0], corner[1]);
  apply({.inserted = {{.end = {a, b}, .s = 0.5}}, .splits = {split}});
}

}  // namespace
}  // namespace trocar
