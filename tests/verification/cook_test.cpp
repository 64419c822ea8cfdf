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

// Linear triangles are too stiff, by an amount that falls faster than h but, because of the clamped
// corner's singularity, not quite as h^2: halving h halves it at least.
static void check_deflection(Formulation formulation, double young_modulus, double force,
                             double reference) {
  const double coarse = middle_displacement(16, formulation, young_modulus, force);
  const double fine = middle_displacement(32, formulation, young_modulus, force);
  std::printf("Cook's membrane, %s: u_y = %.3f, %.3f (%.3f)\n", name_of(formulation), coarse, fine,
              reference);
  EXPECT_LT(fine, reference);
  EXPECT_LT(reference - fine, .5 * (reference - coarse));
  EXPECT_NEAR(fine / reference, 1, .04);
}

TEST(CookMembrane, triangles_reach_the_known_deflection_in_plane_stress_and_in_plane_strain) {
  check_deflection(Formulation::tri3_plane_stress, 1, 1, 23.968);
  check_deflection(Formulation::tri3_plane_strain, 70, 100, 30.749);
}
