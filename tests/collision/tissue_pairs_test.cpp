#include "collision/tissue_pairs.h"

#include <cmath>
#include <set>

#include "collision_random.h"
#include "mesh/facets.h"
#include "mesh/generate.h"
#include "mesh_joined.h"

namespace trocar {
namespace {

const Triangle flat = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};

TEST(TissueTouch, says_how_high_a_node_is_over_a_triangle) {
  const TissueTouch over = touch_tissue(Vec3(0.2, 0.3, 0.4), flat);
  EXPECT_NEAR(over.height, 0.4, 1e-15);
  EXPECT_NEAR(over.distance, 0.4, 1e-15);
  EXPECT_FALSE(over.is_below);
  const TissueTouch under = touch_tissue(Vec3(0.2, 0.3, -0.1), flat);
  EXPECT_NEAR(under.height, -0.1, 1e-15);
  EXPECT_TRUE(under.is_below);
}

TEST(TissueTouch, is_not_below_what_lies_far_beside) {
  EXPECT_TRUE(touch_tissue(Vec3(-0.19, 0.3, -0.1), flat).is_below);
  EXPECT_FALSE(touch_tissue(Vec3(-0.21, 0.3, -0.1), flat).is_below);
}

// A ridge and a point over it, nearest to the edge that its two sides share: seen from below one of
// them it would be inside.
TEST(TissueTouch, of_two_triangles_that_share_the_nearest_point_the_steeper_one_counts) {
  const Vec3 a(0, 0, 0), b(0, 1, 0);
  const Triangle steep = {a, b, Vec3(-0.1, 0.5, -1)}, level = {b, a, Vec3(1, 0.5, -0.2)};
  const Vec3 x(0.05, 0.5, 0.3);
  const TissueTouch of_steep = touch_tissue(x, steep), of_level = touch_tissue(x, level);
  ASSERT_NEAR(of_steep.distance, of_level.distance, 1e-15);
  EXPECT_LT(of_steep.height, 0);
  EXPECT_GT(of_level.height, 0);
  EXPECT_TRUE(says_more({of_level, 0.1}, {of_steep, 0}));
  EXPECT_FALSE(says_more({of_steep, 0}, {of_level, 0.1}));
}

std::vector<TissuePair> pairs_of(const Mesh& mesh, double reach) {
  const SurfaceTree tree(boundary_surface(mesh).triangle, mesh.X);
  std::vector<TissuePair> pairs;
  find_tissue_pairs(tree, mesh.X, reach, pairs);
  return pairs;
}

// The lower one has its upper side at z = 20 mm, the upper one `gap` above it.
Mesh two_blocks(double gap) {
  return joined(make_box({0, 0, 0}, {0.04, 0.03, 0.02}, {6, 5, 3}, BoxElements::tet4_kuhn),
                make_box({0.003, 0.002, 0.02 + gap}, {0.043, 0.032, 0.04 + gap}, {5, 4, 3},
                         BoxElements::tet4_kuhn));
}

std::ptrdiff_t n_nodes_of(const std::vector<TissuePair>& pairs) {
  std::set<std::int32_t> nodes;
  for (const TissuePair& pair : pairs) nodes.insert(pair.node);
  return std::ssize(nodes);
}

// Nodes of the two sides over the other one, or less than 2 mm beside it.
std::ptrdiff_t n_over_each_other(const Mesh& blocks, double gap) {
  return std::ranges::count_if(blocks.X, [&](const Vec3& x) {
    return x.z() > 0.0199 && x.z() < 0.0201 + gap && x.x() > 0.001 && x.x() < 0.042 && x.y() > 0 &&
           x.y() < 0.032;
  });
}

TEST(TissuePairs, are_the_nodes_of_blocks_that_lie_on_each_other) {
  const Mesh mesh = two_blocks(0.001);
  const std::vector<TissuePair> pairs = pairs_of(mesh, 0.002);
  for (const TissuePair& pair : pairs) {
    const double z = mesh.X[pair.node].z();
    for (const std::int32_t i : pair.corner) EXPECT_NEAR(std::abs(mesh.X[i].z() - z), 0.001, 1e-12);
  }
  EXPECT_EQ(n_nodes_of(pairs), n_over_each_other(mesh, 0.001));
  EXPECT_TRUE(pairs_of(two_blocks(0.003), 0.002).empty());
}

TEST(TissuePairs, are_found_across_a_wider_gap_where_velocities_close_it) {
  const Mesh mesh = two_blocks(0.003);
  std::vector<Vec3> ahead = mesh.X;
  for (Vec3& x : ahead)
    if (x.z() > 0.0201) x.z() -= 0.0015;
  const SurfaceTree tree(boundary_surface(mesh).triangle, mesh.X);
  std::vector<TissuePair> pairs;
  find_tissue_pairs(tree, ahead, 0.002, pairs);
  EXPECT_EQ(n_nodes_of(pairs), n_over_each_other(mesh, 0.003));
}

TEST(TissuePairs, of_overlapping_blocks_are_the_ways_out) {
  const Mesh mesh = two_blocks(-0.001);
  const std::vector<TissuePair> pairs = pairs_of(mesh, 0.002);
  EXPECT_GT(pairs.size(), 40u);
  for (const TissuePair& pair : pairs) {
    const bool is_lower = pair.node < 7 * 6 * 4;
    for (const std::int32_t i : pair.corner) {
      EXPECT_EQ(i < 7 * 6 * 4, !is_lower) << pair.node;  // never a side of its own block
      EXPECT_NEAR(mesh.X[i].z(), is_lower ? 0.019 : 0.02, 1e-12);
    }
  }
}

// Both sides of a plate of 1 mm face away from each other, nearer than anything may come.
TEST(TissuePairs, are_none_between_the_sides_of_a_thin_lobe) {
  const Mesh mesh = make_box({0, 0, 0}, {0.05, 0.03, 0.001}, {10, 6, 1}, BoxElements::tet4_kuhn);
  EXPECT_TRUE(pairs_of(mesh, 0.004).empty());
}

// The same plate folded to a U with a gap of 2 mm, and one whose arms overlap by 0.4 mm.
TEST(TissuePairs, of_a_folded_thin_lobe_are_across_its_fold) {
  for (const double gap : {0.002, -0.0004}) {
    Mesh mesh = make_box({-0.05, 0, 0}, {0.05, 0.03, 0.001}, {40, 6, 1}, BoxElements::tet4_kuhn);
    const std::vector<Vec3> plain = mesh.X;
    const double radius = 0.003;  // of the middle of the bend, opened for arms that overlap
    for (Vec3& x : mesh.X) {
      const double bend = M_PI / 2 * radius, over = std::max(0.0, std::abs(x.x()) - bend);
      const double angle = (std::abs(x.x()) - over) / radius;
      const double r = radius - x.z(), side = x.x() < 0 ? 1 : -1;
      const double inward = radius - 0.001 - gap / 2;
      const double closed = std::min(1.0, over / 0.01);
      x = Vec3(over - r * std::cos(angle), x.y(), side * (r * std::sin(angle) - closed * inward));
    }
    const auto at = [&](std::int32_t i) { return plain[i]; };
    const auto is_inner = [&](std::int32_t i) { return at(i).z() > 0.0009; };
    int n_across = 0;
    for (const TissuePair& pair : pairs_of(mesh, 0.0025)) {
      const auto x = [&](std::size_t a) { return mesh.X[pair.corner[a]]; };
      const TissueTouch touch = touch_tissue(mesh.X[pair.node], {x(0), x(1), x(2)});
      const bool is_across = at(pair.node).x() * at(pair.corner[0]).x() < 1e-12 &&
                             is_inner(pair.node) && is_inner(pair.corner[0]);
      if (is_across) ++n_across;
      EXPECT_TRUE(touch.height >= 0 || (is_across && gap < 0)) << pair.node;
    }
    EXPECT_GT(n_across, 200) << gap;
  }
}

}  // namespace
}  // namespace trocar
