// Lists of corners that edits are applied to, against lists made from the edited mesh.
#include "mesh/node_corners.h"

#include <gtest/gtest.h>

#include "mesh/facets.h"
#include "mesh_opened_box.h"

using namespace trocar;

TEST(NodeCorners, know_the_elements_around_each_node_after_an_edit) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::hex8}) {
    OpenedBox box(elements);
    NodeCorners corners = node_corners(box.mesh);
    apply_edit(box.edit, box.mesh, corners);
    apply_edit(box.edit, box.mesh);
    const NodeElements around = node_elements(box.mesh);
    for (std::int32_t i = 0; i < box.mesh.n_nodes(); ++i) {
      const std::vector<std::int32_t> found = elements_around(corners, std::span(&i, 1));
      EXPECT_TRUE(std::equal(found.begin(), found.end(), around.of(i).begin(), around.of(i).end()));
    }
  }
}

TEST(NodeCorners, of_several_nodes_name_each_element_once_ascending) {
  const OpenedBox box;
  const std::vector<std::int32_t> nodes = {31, 32, 62};
  const std::vector<std::int32_t> found = elements_around(node_corners(box.mesh), nodes);
  std::vector<std::int32_t> expected;
  for (std::int32_t e = 0; e < box.mesh.n_elements(); ++e) {
    const auto c = box.mesh.corners(e);
    if (std::any_of(c.begin(), c.end(),
                    [](std::int32_t i) { return i == 31 || i == 32 || i == 62; }))
      expected.push_back(e);
  }
  EXPECT_EQ(found, expected);
  // And all corners of those.
  std::vector<std::uint8_t> is_corner(box.mesh.X.size(), 0);
  for (const std::int32_t e : expected)
    for (const std::int32_t i : box.mesh.corners(e)) is_corner[i] = 1;
  std::vector<std::int32_t> corner;
  for (std::int32_t i = 0; i < box.mesh.n_nodes(); ++i)
    if (is_corner[i] != 0) corner.push_back(i);
  EXPECT_EQ(nodes_of(box.mesh, expected), corner);
}
