#include "cutting/cut_in_slit.h"

#include <gtest/gtest.h>

#include <random>

#include "cutting_cube.h"

namespace trocar::cutting_test {
namespace {

using Place = OlderSlits::Place;

int facets_opened_at(Body& body, double x) {
  const Vec3 normal = Vec3::UnitX();
  const Blade blade = straight_blade({x, -0.1, 0.5}, {x, -0.1, 1.1}, {0, 1.2, 0});
  return cut(body, blade, normal, 30).total.n_opened_facets;
}

// 0.12 edges beside it.
TEST(OlderSlits, take_in_a_blade_that_runs_closely_beside_them) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five}) {
    Body body(make_box({0, 0, 0}, {1, 1, 1}, {10, 9, 9}, elements));
    const double h = mean_edge_length(body.mesh);
    const int first = facets_opened_at(body, 0.5);
    EXPECT_LE(facets_opened_at(body, 0.5 + 0.12 * h), first / 10);
  }
}

TEST(OlderSlits, hold_what_lies_beside_their_facets_and_along_them) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {10, 9, 9}, BoxElements::tet4_kuhn));
  const double h = mean_edge_length(body.mesh);
  facets_opened_at(body, 0.5);
  std::vector<std::int32_t> all(static_cast<std::size_t>(body.mesh.n_elements()));
  std::iota(all.begin(), all.end(), 0);
  const OlderSlits slits(body.mesh, all, {}, h);
  const Vec3 X(0.5, 0.5, 0.8), across = Vec3::UnitX();
  EXPECT_EQ(slits.place_of(X, across), Place::inside);
  EXPECT_EQ(slits.place_of(X + 0.14 * h * across, across), Place::inside);
  EXPECT_EQ(slits.place_of(X + 0.16 * h * across, across), Place::outside);
  EXPECT_EQ(slits.place_of(X, Vec3(1, 0.5, 0).normalized()), Place::outside);
  EXPECT_EQ(slits.place_of({0.5, 0.5, 0.2}, across), Place::outside);
  std::vector<Place> deeper;
  for (double z = 0.95; z > 0.1; z -= 0.01)
    if (const Place place = slits.place_of({0.5, 0.5, z}, across);
        deeper.empty() || deeper.back() != place)
      deeper.push_back(place);
  EXPECT_EQ(deeper, (std::vector{Place::inside, Place::near_front, Place::outside}));
}

// Of the body's lips most lie farther from the blade than that, and none lies along it: where it
// has been tells. By its own cutter, and by one that has been told.
TEST(OlderSlits, of_any_plane_take_in_a_blade_that_comes_again) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> gauss;
  int n_first = 0, n_again = 0;
  for (int k = 0; k < 24; ++k) {
    const Vec3 normal = Vec3(gauss(random), gauss(random), gauss(random)).normalized();
    Body body = cube(k % 2 == 0 ? BoxElements::tet4_kuhn : BoxElements::tet4_five);
    const Blade blade = plane_blade({0.5, 0.47, 0.52}, normal, 1);
    TetCutter cutter{CutTetOptions{}}, other{CutTetOptions{}};
    n_first += cut(body, blade, normal, 25, cutter).total.n_opened_facets;
    EXPECT_EQ(n_pieces(body.mesh), 2) << k;
    other.take_over(cutter.left());
    n_again += cut(body, blade, normal, 25, k % 4 < 2 ? cutter : other).total.n_opened_facets;
    EXPECT_EQ(n_pieces(body.mesh), 2) << k;
    EXPECT_EQ(fault(body), "");
  }
  std::printf("%d facets opened, %d when the blade came again\n", n_first, n_again);
  EXPECT_LE(n_again, n_first / 100);
}

}  // namespace
}  // namespace trocar::cutting_test
