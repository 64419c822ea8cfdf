// Every element whose box overlaps another one is found, against all boxes one by one.
#include "mesh/element_boxes.h"

#include <gtest/gtest.h>

#include <random>

#include "mesh/node_corners.h"
#include "mesh_fixtures.h"
#include "mesh_opened_box.h"

namespace trocar {
namespace {

std::vector<std::int32_t> overlapping(const Mesh& mesh, std::span<const Vec3> x, const Box& box) {
  std::vector<std::int32_t> elements;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    Box own;
    for (const std::int32_t i : mesh.corners(e)) own.add(x[i]);
    if (own.overlaps(box)) elements.push_back(e);
  }
  return elements;
}

// Boxes on nodes and between them, small and large.
void expect_none_missing(const Mesh& mesh, std::span<const Vec3> x, const ElementBoxes& boxes) {
  const double way = largest_way(x, boxes);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> size(0, 0.02);
  for (std::size_t i = 0; i < x.size(); i += 5) {
    Box box;
    box.add(x[i]);
    if (i % 2 == 0) box.add(x[i] + Vec3(size(random), size(random), size(random)));
    const std::vector<std::int32_t> near = elements_near(box, way, boxes);
    EXPECT_TRUE(std::ranges::is_sorted(near));
    EXPECT_TRUE(std::ranges::includes(near, overlapping(mesh, x, box)));
  }
}

TEST(ElementBoxes, miss_no_element_however_far_nodes_have_moved) {
  for (const NamedMesh& named : all_meshes()) {
    ElementBoxes boxes = make_element_boxes(named.mesh, named.mesh.X);
    for (const double strain : {0.0, 0.02, 0.1, 5.0, 0.0}) {
      std::vector<Vec3> x = named.mesh.X;
      for (Vec3& point : x) point += strain * Vec3(point.y(), -point.x(), point.x());
      expect_none_missing(named.mesh, x, boxes);
      fit_element_boxes(named.mesh, x, boxes);
      EXPECT_EQ(largest_way(x, boxes), 0);
      expect_none_missing(named.mesh, x, boxes);
    }
  }
}

TEST(ElementBoxes, offer_few_elements_beside_those_that_are_near) {
  const Mesh mesh = make_box({0, 0, 0}, {0.1, 0.1, 0.1}, {16, 16, 16}, BoxElements::tet4_kuhn);
  const ElementBoxes boxes = make_element_boxes(mesh, mesh.X);
  Box box;
  box.add(Vec3(0.051, 0.052, 0.053));
  // A leaf's 12 elements fill 2 cells and reach less than a cell beyond them: leaves whose middles
  // are within 2 cells of the point, some 32.
  EXPECT_LE(elements_near(box, 0, boxes).size(), 32U * 12);
}

TEST(ElementBoxes, follow_an_edit_as_if_made_after_it) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five}) {
    const OpenedBox box(elements);
    ElementBoxes boxes = make_element_boxes(box.mesh, box.mesh.X);
    Mesh after = box.mesh;
    apply_edit(box.edit, after);
    const std::vector<std::int32_t> edited =
        edited_elements(box.mesh, node_corners(box.mesh), box.edit);
    std::vector<std::int32_t> nodes = nodes_of(box.mesh, edited);
    for (std::int32_t i = box.mesh.n_nodes(); i < after.n_nodes(); ++i) nodes.push_back(i);
    std::vector<Vec3> x = after.X;
    for (const std::int32_t i : nodes) x[i] += Vec3(0.004, 0.01, -0.003) * ((i % 3) - 1);
    update_element_boxes(after, x, {{}, nodes, elements_around(node_corners(after), nodes)}, boxes);
    EXPECT_EQ(boxes.x, x);
    expect_none_missing(after, x, boxes);
    ElementBoxes fresh = boxes;
    for (Box& own : fresh.box) own = {};  // leaves and all above them anew
    update_element_boxes(after, x, {{}, nodes, boxes.order}, fresh);
    for (std::size_t k = 1; k < boxes.box.size(); ++k) {
      EXPECT_EQ(boxes.box[k].low, fresh.box[k].low);
      EXPECT_EQ(boxes.box[k].high, fresh.box[k].high);
    }
  }
}

}  // namespace
}  // namespace trocar
