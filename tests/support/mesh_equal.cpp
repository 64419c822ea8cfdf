#include "mesh_equal.h"

#include <gtest/gtest.h>

namespace trocar::test {

void expect_equal(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.X, b.X);
  EXPECT_EQ(a.element_type, b.element_type);
  EXPECT_EQ(a.corner_offset, b.corner_offset);
  EXPECT_EQ(a.corner_node, b.corner_node);
  EXPECT_EQ(a.element_region, b.element_region);
  EXPECT_EQ(a.region_name, b.region_name);
  EXPECT_EQ(a.density_factor, b.density_factor);
  EXPECT_EQ(a.cut_facets, b.cut_facets);
  EXPECT_EQ(a.fibre, b.fibre);
  EXPECT_EQ(a.copied_node, b.copied_node);
  EXPECT_EQ(a.hex_split_rank, b.hex_split_rank);
  EXPECT_EQ(a.split_hexahedra, b.split_hexahedra);
  ASSERT_EQ(a.node_sets.size(), b.node_sets.size());
  for (std::size_t s = 0; s < a.node_sets.size(); ++s) {
    EXPECT_EQ(a.node_sets[s].name, b.node_sets[s].name);
    EXPECT_EQ(a.node_sets[s].node, b.node_sets[s].node);
    EXPECT_EQ(a.node_sets[s].left_out, b.node_sets[s].left_out);
  }
  EXPECT_TRUE(a == b);  // what else a mesh may have
}

}  // namespace trocar::test
