#include "study/study_interpolate.h"

#include <gtest/gtest.h>

#include "mesh/generate.h"
#include "mesh_fixtures.h"

namespace trocar {
namespace {

Vec3 linear_field(const Vec3& X) {
  return {1 + 2 * X.x() - X.y(), X.z() - 3, X.x() + X.y() + X.z()};
}

std::vector<double> nodal_values(const Mesh& mesh) {
  std::vector<double> u;
  for (const Vec3& X : mesh.X)
    for (const double value : linear_field(X)) u.push_back(value);
  return u;
}

void expect_linear_field(const Mesh& mesh, const std::vector<Vec3>& points) {
  const std::vector<double> u = nodal_values(mesh);
  const std::vector<SamplePoint> samples = locate_samples(mesh, points);
  ASSERT_EQ(samples.size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    EXPECT_LT((interpolate(samples[k], u) - linear_field(points[k])).norm(), 1e-12);
}

const std::vector<Vec3> inner_points = {{.013, .071, .052}, {.05, .05, .05}, {.1, 0, .1}};

TEST(StudyInterpolate, a_linear_field_comes_back_at_any_point_of_hexahedra_and_tetrahedra) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    Mesh mesh = make_box(Vec3::Zero(), Vec3(.1, .1, .1), {3, 4, 5}, elements);
    jitter(mesh, .2, 7);
    expect_linear_field(mesh, inner_points);
  }
}

TEST(StudyInterpolate, a_linear_field_comes_back_in_plane_meshes) {
  expect_linear_field(make_rectangle(.1, .1, 6, 7), {{.013, .071, 0}, {.1, .05, 0}});
}

TEST(StudyInterpolate, points_just_outside_a_curved_surface_are_extrapolated) {
  // Surface nodes of the finer ball lie outside the facets of the coarser one.
  const Mesh coarse = make_ball(Vec3::Zero(), .05, 4, BoxElements::tet4_kuhn);
  const Mesh fine = make_ball(Vec3::Zero(), .05, 8, BoxElements::tet4_kuhn);
  expect_linear_field(coarse, surface_points(fine, 100));
}

TEST(StudyInterpolate, surface_points_lie_on_the_surface_and_are_not_too_many) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3(1, 1, 1), {6, 6, 6}, BoxElements::hex8);
  const std::vector<Vec3> points = surface_points(mesh, 50);
  EXPECT_LE(points.size(), 50u);
  EXPECT_GE(points.size(), 40u);  // 218 surface nodes, every fifth
  for (const Vec3& X : points)
    EXPECT_TRUE((X.array() == 0).any() || (X.array() == 1).any()) << X.transpose();
}

}  // namespace
}  // namespace trocar
