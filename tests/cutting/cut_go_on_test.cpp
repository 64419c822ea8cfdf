// Strokes that begin or end where others did.
#include "cutting/cut_go_on.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  const double half = overlap * mean_edge_length(body.mesh) / 2;
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

// A blade that is lifted and put back, at height z0 and then z1 of its tip: from y0 to y1 and from
// y2 to y3.
struct TwoReaches {
  double z0, y0, y1, z1, y2, y3;
};

// Comes in and goes out at a slant, so that it sweeps tissue on its way.
Blade reach_at(double x, double z, double y0, double y1) {
  return [=](double t) {
    constexpr double top = 1.1, slant = 0.2;
    const double in = std::max(1 - 4 * t, 0.0), out = std::max(4 * t - 3, 0.0);
    const double way = std::clamp(2 * t - 0.5, 0.0, 1.0);
    const double up = (top - z) * (in + out), y = y0 + way * (y1 - y0) + slant * up * (out - in);
    std::vector<Vec3> points;
    for (int k = 0; k <= 14; ++k) points.emplace_back(x, y, z + up + 0.1 * k);
    return points;
  };
}

int pieces_after(const TwoReaches& r, BoxElements elements, double x, bool are_two_blades,
                 int& n_refused) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {9, 9, 9}, elements));
  const double step = least_step_of(body.mesh);
  TetCutter first({}), other({});
  TetCutter& second = are_two_blades ? other : first;
  cut(body, reach_at(x, r.z0, r.y0, r.y1), Vec3::UnitX(), 60, first);
  EXPECT_EQ(n_pieces(body.mesh), 1);
  if (are_two_blades) second.take_over(first.left());
  n_refused = cut(body, reach_at(x, r.z1, r.y2, r.y3), Vec3::UnitX(), 60, second).total.n_refused;
  EXPECT_EQ(fault(body), "");
  // The other one has followed no edits: its floor is over what it finds.
  if (!are_two_blades) {
    EXPECT_GE(least_step_of(body.mesh), 0.75 * step * (1 - 1e-9));
  }
  return n_pieces(body.mesh);
}

struct Count {
  int n = 0, n_parted = 0, n_told = 0;  // told: of those that stay joined
};

Count count_after(const TwoReaches& r, bool are_two_blades) {
  Count count;
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five})
    for (int k = 0; k < n_places; ++k) {
      int n_refused = 0;
      const bool is_parted =
          pieces_after(r, elements, 0.36 + 0.023 * k, are_two_blades, n_refused) == 2;
      ++count.n;
      count.n_parted += is_parted ? 1 : 0;
      count.n_told += !is_parted && n_refused > 0 ? 1 : 0;
    }
  return count;
}

TEST(CutGoOn, blade_that_is_put_back_into_its_slit_parts_the_body) {
  for (const double behind : {0.1, 0.2, 0.3}) {
    const Count count = count_after({-0.2, -0.1, 0.5, -0.2, 0.5 - behind, 1.1}, false);
    std::printf("put back %.1f behind its end: %d of %d parted, of others %d told\n", behind,
                count.n_parted, count.n, count.n_told);
    EXPECT_EQ(count.n_parted, count.n) << behind;
  }
}

TEST(CutGoOn, blade_that_deepens_its_slit_from_within_parts_the_body) {
  for (const double height : {0.35, 0.5, 0.65}) {
    const Count count = count_after({height, -0.1, 1.1, -0.2, -0.1, 1.1}, false);
    std::printf("deepened from %.2f: %d of %d parted, of others %d told\n", height, count.n_parted,
                count.n, count.n_told);
    EXPECT_EQ(count.n_parted, count.n) << height;
  }
}

TEST(CutGoOn, blade_that_is_put_into_the_slit_of_another_parts_the_body) {
  for (const TwoReaches& r : {TwoReaches{-0.2, -0.1, 0.5, -0.2, 0.35, 1.1},
                              TwoReaches{0.5, -0.1, 1.1, -0.2, -0.1, 1.1}}) {
    const Count count = count_after(r, true);
    EXPECT_EQ(count.n_parted, count.n) << r.z0;
  }
}

}  // namespace
}  // namespace trocar::cutting_test
