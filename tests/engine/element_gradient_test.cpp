#include "engine/element_gradient.h"

#include <gtest/gtest.h>

#include "mesh_fixtures.h"

namespace trocar {
namespace {

TEST(DisplacementGradient, of_a_linear_field_is_the_same_in_every_element) {
  Mat3 H;
  H << 0.1, -0.3, 0.2, 0.05, 0.2, -0.1, 0.4, 0.15, -0.25;
  for (const auto& [name, mesh] : volume_meshes())
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
      const Mat3 found =
          displacement_gradient(mesh, e, [&](std::int32_t i) -> Vec3 { return H * mesh.X[i]; });
      EXPECT_LT((found - H).cwiseAbs().maxCoeff(), 1e-12) << name << ' ' << e;  // rounding
    }
}

TEST(DisplacementGradient, of_a_plane_element_lies_in_its_plane) {
  Mat3 H;
  H << 0.1, -0.3, 0, 0.05, 0.2, 0, 0, 0, 0;
  for (const auto& [name, mesh] : plane_meshes())
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
      const Mat3 found =
          displacement_gradient(mesh, e, [&](std::int32_t i) -> Vec3 { return H * mesh.X[i]; });
      EXPECT_LT((found - H).cwiseAbs().maxCoeff(), 1e-12) << name << ' ' << e;
    }
}

}  // namespace
}  // namespace trocar
