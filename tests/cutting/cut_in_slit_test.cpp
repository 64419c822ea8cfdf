#include "cutting/cut_in_slit.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"

namespace trocar::cutting_test {
namespace {

int facets_opened(Body& body, double x) {
  const Vec3 normal = Vec3::UnitX();
  const Blade blade = straight_blade({x, -0.1, 0.5}, {x, -0.1, 1.1}, {0, 1.2, 0});
  return cut(body, blade, normal, 30).total.n_opened_facets;
}

// 0.12 edges beside it.
TEST(OlderSlits, take_in_a_blade_that_runs_closely_beside_them) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five}) {
    Body body(make_box({0, 0, 0}, {1, 1, 1}, {10, 9, 9}, elements));
    const double h = mean_edge_of(body.mesh);
    const int first = facets_opened(body, 0.5);
    EXPECT_LE(facets_opened(body, 0.5 + 0.12 * h), first / 10);
  }
}

TEST(OlderSlits, hold_what_lies_beside_their_facets_and_along_them) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {10, 9, 9}, BoxElements::tet4_kuhn));
  const double h = mean_edge_of(body.mesh);
  facets_opened(body, 0.5);
  std::vector<std::int32_t> all(static_cast<std::size_t>(body.mesh.n_elements()));
  std::iota(all.begin(), all.end(), 0);
  const OlderSlits slits(body.mesh, all, {}, h);
  const Vec3 X(0.5, 0.5, 0.8), across = Vec3::UnitX();
  EXPECT_TRUE(slits.hold(X, across));
  EXPECT_TRUE(slits.hold(X + 0.14 * h * across, across));
  EXPECT_FALSE(slits.hold(X + 0.16 * h * across, across));
  EXPECT_FALSE(slits.hold(X, Vec3(1, 0.5, 0).normalized()));
  EXPECT_FALSE(slits.hold({0.5, 0.5, 0.2}, across));
}

}  // namespace
}  // namespace trocar::cutting_test
