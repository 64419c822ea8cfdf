#include "engine/frame_vtu.h"

#include <gtest/gtest.h>

#include <array>

#include "mesh/generate.h"
#include "mesh/mesh.h"

namespace trocar {
namespace {

// A block of two regions, stretched by s along x and free across: nu = 0.
TEST(FrameVtu, has_the_stress_of_each_region) {
  constexpr double s = 1.2;
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {2, 2, 2}, elements);
    mesh.region_name.push_back("stiff");
    mesh.element_region[0] = 1;
    std::vector<double> u;
    for (const Vec3& X : mesh.X) u.insert(u.end(), {(s - 1) * X.x(), 0, 0});
    const std::vector<Material> materials = {
        {.model = MaterialModel::st_venant_kirchhoff, .young_modulus = 3000, .poisson_ratio = 0},
        {.model = MaterialModel::st_venant_kirchhoff, .young_modulus = 9000, .poisson_ratio = 0}};
    const ElementFields fields = element_fields(mesh, u, materials);
    // S = E (s^2 - 1) / 2, sigma = s S
    const double sigma = s * 3000 * (s * s - 1) / 2;
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
      const double expected = (e == 0 ? 3 : 1) * sigma;
      EXPECT_NEAR(fields.det_F[e], s, 1e-12);
      EXPECT_NEAR(fields.green_strain[9 * e], (s * s - 1) / 2, 1e-12);
      EXPECT_NEAR(fields.cauchy_stress[9 * e], expected, 1e-9 * expected);
      EXPECT_NEAR(fields.cauchy_stress[9 * e + 4], 0, 1e-9 * expected);
      EXPECT_NEAR(fields.von_mises_stress[e], expected, 1e-9 * expected);
    }
    EXPECT_TRUE(element_fields(mesh, u, {}).cauchy_stress.empty());
  }
}

TEST(FrameVtu, has_the_density_and_the_piece_of_each_element) {
  Mesh mesh;
  mesh.X = {Vec3::Zero(),  Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(),
            Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3(2, 1, 0), Vec3(2, 0, 1)};
  mesh.region_name = {""};
  const std::array<std::int32_t, 4> first = {0, 1, 2, 3}, second = {4, 5, 6, 7};
  for (const auto* corners : {&second, &first, &second})
    add_element(mesh, ElementType::tet4, *corners);
  mesh.density_factor[1] = 0.5;
  const std::vector<double> u(3 * mesh.X.size(), 0);
  const ElementFields fields = element_fields(mesh, u, std::vector<Material>{{.density = 800}});
  EXPECT_EQ(fields.piece, (std::vector<double>{1, 0, 1}));
  EXPECT_EQ(fields.density, (std::vector<double>{800, 400, 800}));
}

}  // namespace
}  // namespace trocar
