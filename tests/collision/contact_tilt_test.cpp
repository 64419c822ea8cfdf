// The stiffness of a triangle that tilts beneath a curved tool.
#include "collision/contact_tilt.h"

#include <gtest/gtest.h>

#include "collision_contacts.h"

namespace trocar {
namespace {

constexpr double R = 0.01, F = 0.3, m = 2e-4, h = 0.004;

// An equilateral triangle with sides h and equal masses under a sphere that has pressed with F in
// each of four steps.
double pressed(double radius, const std::vector<std::uint8_t>& held) {
  ContactBench bench({Vec3(0, 0, 0), Vec3(h, 0, 0), Vec3(h / 2, std::sqrt(0.75) * h, 0)},
                     {m, m, m});
  bench.detector = ContactDetector({{.pieces = {{.points = {Vec3(0, 0, 0)}, .radius = radius}}}});
  bench.prepare({Contact{.node = {0, 1, 2}}}, held);
  bench.place();
  bench.set.items[0].reaction_sum = Vec3(0, 0, 4 * F);
  return tilt_frequency2(find_tilts(bench.detector, 4, bench.set), bench.set);
}

// sum_a grad N_a (x) grad N_a = 2 / h^2 I in the triangle's plane; its eigenvalues are those of the
// stiffness F R grad N_a . grad N_b.
TEST(TiltFrequency, is_that_of_the_closed_form) {
  const double expected = 2 * F * R / (h * h * m);
  EXPECT_NEAR(pressed(R, {}), expected, 1e-9 * expected);
}

// |grad N|^2 = 4 / (3 h^2) of the one corner that moves.
TEST(TiltFrequency, leaves_out_what_is_held) {
  const double expected = F * R * 4 / (3 * h * h * m);
  EXPECT_NEAR(pressed(R, {7, 0, 7}), expected, 1e-9 * expected);
  EXPECT_EQ(pressed(R, {7, 7, 7}), 0);
}

TEST(TiltFrequency, is_none_beneath_a_point) {
  EXPECT_EQ(pressed(0, {}), 0);
}

// Whose point goes from corner to corner as the triangle tilts by less than a thousandth.
TEST(TiltFrequency, is_none_beneath_a_tool_that_is_flat_to_the_triangle) {
  EXPECT_GT(pressed(999 * h, {}), 0);
  EXPECT_EQ(pressed(1001 * h, {}), 0);
}

}  // namespace
}  // namespace trocar
