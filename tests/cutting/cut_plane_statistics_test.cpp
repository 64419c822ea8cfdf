// The statistical values of Table 1 on meshes small enough to count by hand.
#include "cutting/cut_plane_statistics.h"

#include <cmath>

#include "cutting_plane.h"

namespace trocar {
namespace {

constexpr double rounding = 1e-13;  // of values of some ones

// One cell of 3 x 4 mm, two triangles of 6 mm^2 with the edges 3, 4, 5.
TEST(PlaneStatistics, of_two_triangles_are_those_counted_by_hand) {
  const PlaneStatistics s = plane_statistics(make_rectangle(3 * mm, 4 * mm, 2, 2));
  EXPECT_EQ(s.n_nodes, 4);
  EXPECT_EQ(s.n_elements, 2);
  EXPECT_NEAR(s.area.min, 6, rounding);
  EXPECT_NEAR(s.area.max, 6, rounding);
  EXPECT_NEAR(s.area.sigma, 0, rounding);
  EXPECT_NEAR(s.edge.min, 3, rounding);
  EXPECT_NEAR(s.edge.max, 5, rounding);
  EXPECT_NEAR(s.edge.mean, 4, rounding);
  EXPECT_NEAR(s.edge.sigma, std::sqrt(2.0 / 3), rounding);
}

// The first two edges are 3, 4 of the lower and 5, 3 of the upper triangle: mean 3.75.
TEST(PlaneStatistics, of_two_edges_leave_the_third_out) {
  const PlaneStatistics s = plane_statistics(make_rectangle(3 * mm, 4 * mm, 2, 2));
  const double squares = 2 * 0.75 * 0.75 + 0.25 * 0.25 + 1.25 * 1.25;
  EXPECT_NEAR(s.edge_sigma_of_two, std::sqrt(squares / 4), rounding);
}

}  // namespace
}  // namespace trocar
