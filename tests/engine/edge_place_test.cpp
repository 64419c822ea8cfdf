#include "engine/edge_place.h"

#include <gtest/gtest.h>

#include "mesh/generate.h"

namespace trocar {
namespace {

// In a body that is stretched, sheared and turned, an edge and its way are what they were before.
TEST(EdgePlace, is_the_edge_before_the_body_was_deformed) {
  Mat3 F;
  F << 1.3, 0.4, 0, -0.2, 0.9, 0.1, 0, 0.2, 0.8;
  const Vec3 along = Vec3(0.2, 0.1, 1).normalized(), ahead = Vec3(1, 0.3, 0).normalized();
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    const Mesh mesh = make_box(Vec3::Zero(), Vec3(0.03, 0.02, 0.02), {3, 2, 2}, elements);
    std::vector<Vec3> x;
    for (const Vec3& X : mesh.X) x.push_back(F * X + Vec3(1, 2, 3));
    const Vec3 point(0.012, 0.007, 0.011), moved = F * point + Vec3(1, 2, 3);
    const Location at = locate_points(mesh, x, std::span(&moved, 1))[0];
    ASSERT_GE(at.element, 0);
    const EdgePlace place = place_of(mesh, x, at, F * along, F * ahead);
    EXPECT_LT((place.X - point).norm(), 1e-12);
    EXPECT_LT((place.along - along).norm(), 1e-12);
    EXPECT_LT((place.ahead - ahead).norm(), 1e-12);
    EXPECT_LT(place.normal().cross(along.cross(ahead)).norm(), 1e-12);
    EXPECT_NEAR(place.size, 0.01, 1e-12);
  }
}

}  // namespace
}  // namespace trocar
