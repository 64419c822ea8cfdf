// Strokes that begin or end where others did.
#include "cutting/cut_go_on.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "cutting_tet.h"

namespace trocar::cutting_test {
namespace {

// Through the cube at x, from y0 to y1, and out of it along its own edge.
Blade stroke_at(double x, double y0, double y1) {
  return [=](double t) {
    const double way = std::min(t / 0.75, 1.0), out = std::max(t / 0.75 - 1, 0.0) * 5;
    std::vector<Vec3> points;
    for (int k = 0; k <= 14; ++k)
      points.emplace_back(x, y0 + way * (y1 - y0), -0.2 + 0.1 * k + out);
    return points;
  };
}

// Of one blade that turns in between, or of two.
int pieces_after_two(BoxElements elements, double x, double overlap, bool are_two_blades) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {9, 9, 9}, elements));
  const double half = overlap * mean_edge_of(body.mesh) / 2;
  TetCutter first({}), other({});
  TetCutter& second = are_two_blades ? other : first;
  cut(body, stroke_at(x, -0.1, 0.5 + half), Vec3::UnitX(), 40, first);
  EXPECT_EQ(n_pieces(body.mesh), 1);
  if (are_two_blades) second.take_over(first.left());
  cut(body, stroke_at(x, 1.1, 0.5 - half), -Vec3::UnitX(), 40, second);
  EXPECT_EQ(fault(body), "");
  return n_pieces(body.mesh);
}

constexpr int n_places = 12;  // that differ in the mesh

int n_parted(BoxElements elements, double overlap, bool are_two_blades) {
  int n = 0;
  for (int k = 0; k < n_places; ++k)
    n += pieces_after_two(elements, 0.36 + 0.023 * k, overlap, are_two_blades) == 2 ? 1 : 0;
  return n;
}

TEST(CutGoOn, strokes_from_two_sides_part_the_body_where_they_overlap) {
  for (const double overlap : {0.5, 1.0, 1.5, 2.0, 3.0}) {
    int n = 0;
    for (const BoxElements elements :
         {BoxElements::hex8, BoxElements::tet4_kuhn, BoxElements::tet4_five})
      n += n_parted(elements, overlap, false);
    std::printf("overlap of %.1f mean edges: %d of %d parted\n", overlap, n, 3 * n_places);
    EXPECT_GE(n, overlap < 1 ? 32 : 34);
  }
}

TEST(CutGoOn, blade_takes_up_what_another_one_left) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five})
    EXPECT_GE(n_parted(elements, 0.5, true), 3 * n_places / 4) << static_cast<int>(elements);
}

}  // namespace
}  // namespace trocar::cutting_test
