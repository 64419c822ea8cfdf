// Parts of a body that few elements hold together.
#include "cutting/cut_bridge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "mesh/connected_nodes.h"
#include "mesh/facets.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

using IsJoined = std::function<bool(const Vec3&)>;

// Cells of a metre, opened in the plane x = 3 but for nodes that stay joined.
Mesh parted_box(BoxElements elements, const IsJoined& is_joined) {
  Mesh mesh = make_box(Vec3::Zero(), Vec3(6, 8, 2), {6, 8, 2}, elements);
  const FacetNeighbours across = facet_neighbours(mesh);
  std::vector<std::int32_t> copy(mesh.X.size(), -1);
  const std::vector<Vec3> X = mesh.X;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < n_facets(mesh.element_type[e]); ++f) {
      if (across.of(e, f) < 0) continue;
      bool is_in_plane = true, is_open = false;
      for (const int c : facet_corners(mesh.element_type[e], f)) {
        if (c < 0) continue;
        const Vec3& at = X[mesh.corners(e)[c]];
        is_in_plane = is_in_plane && at.x() == 3;
        is_open = is_open || !is_joined(at);
      }
      if (is_in_plane && is_open)
        mesh.cut_facets[e] = static_cast<std::uint8_t>(mesh.cut_facets[e] | 1 << f);
    }
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    if (element_centre(mesh, e).x() < 3) continue;
    for (std::size_t c = 0; c < mesh.corners(e).size(); ++c) {
      std::int32_t& node = mesh.corner_node[mesh.corner_offset[e] + static_cast<std::int32_t>(c)];
      if (X[node].x() != 3 || is_joined(X[node])) continue;
      if (copy[node] < 0) {
        copy[node] = mesh.n_nodes();
        mesh.X.push_back(X[node]);
        mesh.copied_node.push_back(node);
      }
      node = copy[node];
    }
  }
  return mesh;
}

void for_both(const std::function<void(BoxElements)>& check) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) check(elements);
}

TEST(CutBridge, is_found_where_a_line_of_nodes_joins_two_parts) {
  for_both([](BoxElements elements) {
    const Mesh mesh = parted_box(elements, [](const Vec3& X) { return X.y() == 4; });
    ASSERT_EQ(count_pieces(mesh), 1);
    const std::vector<CutBridge> bridges = find_bridges(mesh, 1);
    ASSERT_EQ(bridges.size(), 1U);
    EXPECT_EQ(bridges[0].X, Vec3(3, 4, 1));
    // Of 48 cells a side four lie at the nodes, of tetrahedra some of their parts.
    EXPECT_GT(bridges[0].volume, 44 - 1e-9);
    EXPECT_LT(bridges[0].volume, elements == BoxElements::hex8 ? 44 + 1e-9 : 48);
  });
}

TEST(CutBridge, is_each_of_two_that_together_join_two_parts) {
  for_both([](BoxElements elements) {
    const Mesh mesh =
        parted_box(elements, [](const Vec3& X) { return X.y() == 1 || (X.y() == 6 && X.z() < 2); });
    EXPECT_EQ(find_bridges(mesh, 1).size(), 2U);
    const Mesh strip = parted_box(elements, [](const Vec3& X) { return X.y() == 3 || X.y() == 4; });
    EXPECT_EQ(find_bridges(strip, 1).size(), 1U);
  });
}

TEST(CutBridge, is_none_at_the_end_of_a_slit_and_none_where_all_is_parted) {
  for_both([](BoxElements elements) {
    const Mesh slit = parted_box(elements, [](const Vec3& X) { return X.y() <= 4; });
    EXPECT_TRUE(find_bridges(slit, 1).empty());
    const Mesh parted = parted_box(elements, [](const Vec3&) { return false; });
    EXPECT_EQ(count_pieces(parted), 2);
    EXPECT_TRUE(find_bridges(parted, 1).empty());
  });
}

TEST(CutBridge, is_none_where_little_hangs_there) {
  for_both([](BoxElements elements) {
    const Mesh mesh = parted_box(elements, [](const Vec3& X) { return X.y() == 4; });
    EXPECT_TRUE(find_bridges(mesh, 3).empty());
  });
}

}  // namespace
}  // namespace trocar
