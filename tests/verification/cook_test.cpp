// V10, Cook's membrane: the trapezium (0,0) (48,44) (48,60) (0,44), left side clamped, a uniform
// shear traction on the right one. The vertical displacement of its middle (48, 52), linear.
#include <gtest/gtest.h>

#include "solver_body.h"

using namespace trocar;

static Body membrane(int n, Formulation formulation, double young_modulus) {
  Mesh mesh = make_rectangle(1, 1, n + 1, n + 1);
  BodyOptions options{.materials = {{MaterialModel::linear, young_modulus, 1. / 3, young_modulus}},
                      .solver = with(formulation, {.mass_damping = .022, .thickness = 1})};
  for (Vec3& X : mesh.X) {
    options.fixed.push_back(X.x() < 1e-9 ? 7 : 0);
    X = Vec3(48 * X.x(), 44 * X.x() + X.y() * (44 - 28 * X.x()), 0);
  }
  return make_body(mesh, options);
}

// The slowest mode, about .011 rad/s with the density equal to Young's modulus, is damped
// critically: e^-20 of it is left after 1800 s.
static double middle_displacement(int n, Formulation formulation, double young_modulus,
                                  double force) {
  Body body = membrane(n, formulation, young_modulus);
  const double dt = .9 * least_element_step(body);
  while (body.state.time < 1800) {
    compute_force(body.model, body.state, body.scratch);
    for (std::size_t i = 0; i < body.mesh.X.size(); ++i) {
      const Vec3& X = body.mesh.X[i];
      const bool is_end = X.y() < 44 + 1e-9 || X.y() > 60 - 1e-9;
      if (X.x() > 48 - 1e-9) body.scratch.force[3 * i + 1] += force / n * (is_end ? .5 : 1);
    }
    integrate(body.model, body.scratch, {}, dt, body.state);
  }
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
    if ((body.mesh.X[i] - Vec3(48, 52, 0)).norm() < 1e-6) return body.state.u[3 * i + 1];
  return 0;
}

// Linear triangles are too stiff by an amount that falls with h^2 or, at the clamped corner's
// singularity, a little more slowly: 3 % at 32 elements along each side.
TEST(CookMembrane, triangles_in_plane_stress_reach_the_known_deflection) {
  const double u = middle_displacement(32, Formulation::tri3_plane_stress, 1, 1);
  std::printf("Cook's membrane, plane stress: u_y = %.3f (23.968)\n", u);
  EXPECT_LT(u, 23.968);
  EXPECT_NEAR(u / 23.968, 1, .03);
}

TEST(CookMembrane, triangles_in_plane_strain_reach_the_known_deflection) {
  const double u = middle_displacement(32, Formulation::tri3_plane_strain, 70, 100);
  std::printf("Cook's membrane, plane strain: u_y = %.3f (30.749)\n", u);
  EXPECT_LT(u, 30.749);
  EXPECT_NEAR(u / 30.749, 1, .03);
}
