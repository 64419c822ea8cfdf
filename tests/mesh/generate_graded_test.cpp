// Graded plane meshes: counts by Euler's formula, area and grading.
#include <gtest/gtest.h>

#include "base/error.h"
#include "mesh/generate.h"
#include "mesh/quality.h"

namespace trocar {
namespace {

constexpr std::array<int, 4> rows = {6, 5, 5, 3};

// 19 nodes, of which 6 + 3 + 2 * 2 = 13 lie on the outline: 2 * 19 - 13 - 2 = 23 triangles.
TEST(GradedRectangle, has_as_many_triangles_as_euler_says) {
  const Mesh mesh = make_graded_rectangle(Vec2(3, 2), rows, 1.3, 1.5);
  EXPECT_EQ(mesh.n_nodes(), 19);
  EXPECT_EQ(mesh.n_elements(), 23);
  EXPECT_TRUE(validate(mesh).empty());
}

TEST(GradedRectangle, fills_its_rectangle) {
  const Mesh mesh = make_graded_rectangle(Vec2(3, 2), rows, 1.3, 1.5);
  double area = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) area += element_volume(mesh, e, mesh.X);
  EXPECT_NEAR(area, 6, 1e-14);  // rounding of 23 terms below 1
}

// The map t / (g + (1 - g) t) has the slopes 1 / g and g at its ends.
TEST(GradedRectangle, steps_grow_by_the_square_of_the_grade) {
  const std::array<int, 2> two_rows = {1001, 1001};
  const Mesh mesh = make_graded_rectangle(Vec2(1, 1), two_rows, 1.5, 1);
  const double first = mesh.X[1].x() - mesh.X[0].x(), last = mesh.X[1000].x() - mesh.X[999].x();
  EXPECT_NEAR(last / first, 1.5 * 1.5, 0.005);  // curvature of the map over a step of 1e-3
}

TEST(GradedRectangle, senseless_rows_and_grades_are_input_errors) {
  const std::array<int, 1> one_row = {4};
  const std::array<int, 2> with_one_node = {4, 1};
  EXPECT_THROW(make_graded_rectangle(Vec2(1, 1), one_row, 1, 1), InputError);
  EXPECT_THROW(make_graded_rectangle(Vec2(1, 1), with_one_node, 1, 1), InputError);
  EXPECT_THROW(make_graded_rectangle(Vec2(1, 1), rows, 0, 1), InputError);
  EXPECT_THROW(make_graded_rectangle(Vec2(0, 1), rows, 1, 1), InputError);
}

}  // namespace
}  // namespace trocar
