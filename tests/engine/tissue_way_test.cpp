#include "engine/tissue_way.h"

#include "engine/body_positions.h"
#include "engine_started.h"

namespace trocar {
namespace {

// A bar of 8 x 24 x 10 mm whose left half moves by 1 mm upwards within the frame, its right half by
// 2 mm.
struct Bar {
  std::unique_ptr<Started> started = built(
      "[time]\nduration = 1\n[tissue.shape]\nkind = \"box\"\nelements = \"tet4-kuhn\"\n"
      "low = [-0.004, -0.012, 0]\nhigh = [0.004, 0.012, 0.01]\ncells = [4, 6, 5]\n");
  Simulation& s = *started->s;

  Bar() {
    s.view.x = s.mesh.X;
    for (std::size_t i = 0; i < s.part.node_global.size(); ++i) {
      const auto node = static_cast<std::size_t>(s.part.node_global[i]);
      s.state.u[3 * i + 2] = s.mesh.X[node].x() < 0 ? 1e-3 : 2e-3;
      s.state.v[3 * i] = s.mesh.X[node].z();
    }
  }
  std::vector<Vec3> ways(const Vec3& left, const Vec3& right) {
    const double way = begin_positions(s);
    const CutGroup alone(s, {0});
    BodyPositions positions(s, alone, way);
    return ways_beside(s, positions, {{left, right}, {left, right}}, largest_surface_way(s));
  }
};

TEST(TissueWay, at_most_is_that_of_the_fastest_node) {
  Bar bar;
  EXPECT_NEAR(largest_surface_way(bar.s), 2e-3, 1e-16);
}

TEST(TissueWay, beside_each_point_of_an_edge_is_that_of_the_node_that_it_comes_nearest_to) {
  Bar bar;
  const std::vector<Vec3> ways = bar.ways({-5e-3, 0, 5e-3}, {5e-3, 0, 5e-3});
  ASSERT_EQ(ways.size(), 2U);
  EXPECT_LT((ways[0] - Vec3(0, 0, 1e-3)).norm(), 1e-16);
  EXPECT_LT((ways[1] - Vec3(0, 0, 2e-3)).norm(), 1e-16);
  EXPECT_TRUE(bar.ways({-50e-3, 0, 5e-3}, {-40e-3, 0, 5e-3}).empty()) << "out of reach";
}

// Velocities rise with the height: the mean over 1 mm at 2 mm and 3 mm at 6 mm is that at 5 mm.
TEST(TissueWay, velocity_is_the_mean_over_the_length_of_the_pieces) {
  Bar bar;
  const std::vector<Vec3> places = {{1.1e-3, 0.3e-3, 2e-3}, {1.1e-3, 0.3e-3, 6e-3}};
  const std::vector<Location> at = locate_points(bar.s.mesh, bar.s.mesh.X, places);
  const std::vector<SegmentPiece> pieces = {{.middle = at[0], .length = 1e-3},
                                            {.middle = at[1], .length = 3e-3}};
  EXPECT_LT((velocity_along(bar.s, pieces) - Vec3(5e-3, 0, 0)).norm(), 1e-16);
}

}  // namespace
}  // namespace trocar
