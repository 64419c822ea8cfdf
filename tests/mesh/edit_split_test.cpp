// What an edit that splits hexahedra makes of numbers, corners and boxes of elements.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "mesh/edit.h"
#include "mesh/element_boxes.h"
#include "mesh/generate.h"
#include "mesh/node_corners.h"
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
    const SplitNumbers numbers(box.edit.splits);
    const std::vector<std::int32_t> parent = element_parents(box.mesh, box.edit);
    for (std::int32_t e = 0; e < std::ssize(parent); ++e) EXPECT_EQ(numbers.before(e), parent[e]);
    std::vector<std::int32_t> all(60);
    std::iota(all.begin(), all.end(), 0);
    std::shuffle(all.begin(), all.end(), std::mt19937(seed));
    std::vector<std::int32_t> renumbered = all;
    numbers.renumber(renumbered);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto children = std::ranges::equal_range(parent, all[k]);
      EXPECT_EQ(numbers.after(all[k]), children.begin() - parent.begin());
      EXPECT_EQ(renumbered[k], numbers.after(all[k]));
      EXPECT_EQ(numbers.is_split(all[k]), children.size() == 6);
    }
  }
}

TEST(EditOfSplits, leaves_others_their_corners) {
  for (unsigned seed = 0; seed < n_split_boxes; ++seed) {
    const SplitBox box(seed);
    const SplitNumbers numbers(box.edit.splits);
    Mesh after = box.mesh;
    apply_edit({.splits = box.edit.splits}, after);
    ASSERT_EQ(after.corner_offset.back(), std::ssize(after.corner_node));
    for (std::int32_t e = 0; e < box.mesh.n_elements(); ++e) {
      if (numbers.is_split(e)) continue;
      EXPECT_TRUE(std::ranges::equal(after.corners(numbers.after(e)), box.mesh.corners(e)));
      EXPECT_EQ(after.element_type[numbers.after(e)], ElementType::hex8);
    }
    for (const ElementSplit& split : box.edit.splits)
      for (std::size_t k = 0; k < split.corner.size(); ++k) {
        const std::int32_t e = numbers.after(split.element) + static_cast<std::int32_t>(k);
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
    const SplitNumbers numbers(box.edit.splits);
    for (const std::int32_t e : elements) EXPECT_EQ(boxes.leaf[e], leaf[numbers.before(e)]);
    std::vector<std::int32_t> order = boxes.order;
    std::ranges::sort(order);
    EXPECT_EQ(order, elements);
    ASSERT_EQ(boxes.first.back(), after.n_elements());
    for (std::size_t k = 0; k + 1 < boxes.first.size(); ++k)
      for (std::int32_t at = boxes.first[k]; at < boxes.first[k + 1]; ++at)
        EXPECT_EQ(boxes.leaf[boxes.order[at]], static_cast<std::int32_t>(k));
    for (const std::int32_t e : elements) {
      const Box own = element_box(after, e, after.X);
      EXPECT_TRUE(std::ranges::binary_search(elements_near(own, 0, boxes), e));
    }
  }
}

}  // namespace
}  // namespace trocar
