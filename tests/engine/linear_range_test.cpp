// Where linear materials leave small strains, in homogeneous deformations of known gradient.
#include "engine/linear_range.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine_started.h"

namespace trocar {
namespace {

std::unique_ptr<Started> body_with_model(const std::string& kind, const std::string& elements,
                                         const std::string& model) {
  return built("[time]\nduration = 1\n[tissue.shape]\nkind = \"" + kind + "\"\nelements = \"" +
                   elements + "\"\ncells = [3, 3, 3]\n[tissue.material]\nmodel = \"" + model +
                   "\"\n",
               {});
}

// What the body tells with the displacements H X.
std::vector<std::string> told(Started& started, const Mat3& H) {
  Simulation& s = *started.s;
  for (std::size_t i = 0; i < s.part.node_global.size(); ++i)
    Vec3::Map(&s.state.u[3 * i]) = H * s.mesh.X[s.part.node_global[i]];
  watch_linear_range(s, 0.25);
  return s.log.events;
}

// Compression by `e` along (1, 2, 0), whose gradient has this norm.
Mat3 compression(double e) {
  const Vec3 along = Vec3(1, 2, 0).normalized();
  return -e * along * along.transpose();
}

Mat3 rotation(double degrees) {
  const double t = degrees * 3.14159265358979 / 180;
  Mat3 R = Mat3::Identity();
  R.topLeftCorner<2, 2>() << std::cos(t), -std::sin(t), std::sin(t), std::cos(t);
  return R - Mat3::Identity();
}

TEST(LinearRange, ends_at_a_displacement_gradient_of_a_tenth) {
  for (const auto& [kind, elements] : {std::pair{"box", "hex8"}, std::pair{"box", "tet4-kuhn"},
                                       std::pair{"triangular-rectangle", "hex8"}}) {
    const auto started = body_with_model(kind, elements, "linear");
    EXPECT_TRUE(told(*started, compression(0.0999)).empty()) << kind << elements;
    const std::vector<std::string> events = told(*started, compression(0.1001));
    ASSERT_EQ(events.size(), 1U) << kind << elements;
    EXPECT_TRUE(events[0].starts_with("0.250 s: the linear material is used beyond small strains"))
        << events[0];
  }
}

// 2 sin(t / 2) = 0.1 at 5.73 degrees.
TEST(LinearRange, ends_at_six_degrees_of_rotation) {
  const auto started = body_with_model("box", "hex8", "linear");
  EXPECT_TRUE(told(*started, rotation(5.7)).empty());
  EXPECT_EQ(told(*started, rotation(5.8)).size(), 1U);
}

TEST(LinearRange, is_told_once) {
  const auto started = body_with_model("box", "hex8", "linear");
  EXPECT_EQ(told(*started, compression(0.2)).size(), 1U);
  EXPECT_EQ(told(*started, compression(0.3)).size(), 1U);
}

TEST(LinearRange, does_not_concern_other_materials) {
  const auto started = body_with_model("box", "hex8", "neo-hookean");
  EXPECT_TRUE(told(*started, compression(0.3)).empty());
}

}  // namespace
}  // namespace trocar
