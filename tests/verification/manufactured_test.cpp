// V9, method of manufactured solutions: a clamped cube is forced to move as
// u = A sin(wt) sin(pi X/L) sin(pi Y/L) sin(pi Z/L) (1, -.6, .8); the error falls with h^2.
#include <numbers>

#include "verification_dynamics.h"
#include "verification_figure.h"

using namespace trocar;

using std::numbers::pi;

constexpr double L = .1, A = .006, w = 2 * pi / .05, rho = 1000, E = 3000;
static const Vec3 motion_direction(1, -.6, .8);

static Vec3 exact(const Vec3& X, double t) {
  const Vec3 p = pi / L * X;
  return A * std::sin(w * t) * std::sin(p.x()) * std::sin(p.y()) * std::sin(p.z()) *
         motion_direction;
}

// dW/dF of mu/2 (J^-2/3 tr C - 3) + K/2 (J - 1)^2 at the exact displacement.
static Mat3 stress(const Vec3& X, double t, double mu, double K) {
  const Vec3 p = pi / L * X;
  const Vec3 s(std::sin(p.x()), std::sin(p.y()), std::sin(p.z()));
  const Vec3 c(std::cos(p.x()), std::cos(p.y()), std::cos(p.z()));
  const Vec3 g = A * std::sin(w * t) * pi / L *
                 Vec3(c.x() * s.y() * s.z(), s.x() * c.y() * s.z(), s.x() * s.y() * c.z());
  const Mat3 F = Mat3::Identity() + motion_direction * g.transpose();
  const double J = F.determinant();
  const Mat3 F_inverse_T = F.inverse().transpose();
  return mu * std::pow(J, -2.0 / 3) * (F - F.squaredNorm() / 3 * F_inverse_T) +
         K * (J - 1) * J * F_inverse_T;
}

// rho u_tt - Div P; Div P by central differences, whose error (h / L)^2 and 1e-16 L / h balance at
// h = 1e-5 L near 1e-10.
static Vec3 body_force(const Vec3& X, double t, double mu, double K) {
  const double h = 1e-5 * L;
  Vec3 b = -rho * w * w * exact(X, t);
  for (int j = 0; j < 3; ++j) {
    const Vec3 step = h * Vec3::Unit(j);
    b -= (stress(X + step, t, mu, K) - stress(X - step, t, mu, K)).col(j) / (2 * h);
  }
  return b;
}

static double lame_mu_of(double nu) {
  return E / (2 * (1 + nu));
}
static double bulk_of(double nu) {
  return E / (3 * (1 - 2 * nu));
}

TEST(V09ManufacturedSolution, its_body_force_is_the_tabulated_one) {
  const Vec3 b = body_force({.03, .05, .07}, .0125, lame_mu_of(.45), bulk_of(.45));
  EXPECT_LT((b - Vec3(-3148.44125, 5578.41336, 25228.254)).norm(), 1e-3);  // printed digits
}

// Root of sum m |u - exact|^2 over sum m |exact|^2 at t = .03.
static double solution_error(const Variant& variant, int n, double nu) {
  Body body = make_box_body(
      variant,
      {.size = {L, L, L},
       .n = {n, n, n},
       .material = {MaterialModel::neo_hookean, E, nu, rho},
       .fixed = [](const Vec3& X) {
         return FixedMask((X.array() < 1e-9).any() || (X.array() > L - 1e-9).any() ? 7 : 0);
       }});
  set_velocity(body, [](const Vec3& X) { return Vec3(w / std::sin(w * .0125) * exact(X, .0125)); });
  const double stable = .4 * least_element_step(body);
  const int n_steps = static_cast<int>(std::ceil(.03 / stable));
  for (int k = 0; k < n_steps; ++k)
    forced_step(body, .03 / n_steps, [&](Body& b) {
      for (std::int32_t i = 0; i < b.mesh.n_nodes(); ++i)
        Vec3::Map(&b.scratch.force[3 * i]) +=
            b.mass[i] / rho * body_force(b.mesh.X[i], b.state.time, lame_mu_of(nu), bulk_of(nu));
    });
  double difference = 0, norm = 0;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i) {
    const Vec3 u = exact(body.mesh.X[i], .03);
    difference += body.mass[i] * (Vec3::Map(&body.state.u[3 * i]) - u).squaredNorm();
    norm += body.mass[i] * u.squaredNorm();
  }
  return std::sqrt(difference / norm);
}

TEST(V09ManufacturedSolution, converges_near_incompressibility_unless_elements_lock) {
  for (const Variant& variant : {hex_one_point, hex_enhanced, tet_nodal_pressure, tet_plain}) {
    const double coarse = solution_error(variant, 8, .49), fine = solution_error(variant, 16, .49);
    const double order = order_between(coarse, fine);
    const bool is_locking = variant.name == tet_plain.name;
    check_figure({"V9 Manufactured solution", "L2 error at nu = 0.49",
                  mesh_name(variant, {16, 16, 16}), fine, 0, is_locking ? .1 : .05,
                  is_locking ? "closed form (locks)" : "closed form", order});
    // numerics V9: these meshes have yet to come to the order 2 (1.6 from the coarser one), and
    // plain tetrahedra have .8.
    if (is_locking) {
      EXPECT_LT(order, 1.2);
    } else {
      EXPECT_GT(order, 1.6) << variant.name;
    }
  }
}

TEST(V09ManufacturedSolution, the_displacement_converges_with_the_square_of_the_element_width) {
  for (const Variant& variant :
       {hex_one_point, hex_enhanced, hex_full, tet_plain, tet_nodal_pressure})
    for (const double nu : {.3, .45}) {
      const double coarse = solution_error(variant, 8, nu), fine = solution_error(variant, 16, nu);
      const double order = order_between(coarse, fine);
      check_figure({"V9 Manufactured solution",
                    "L2 error at nu = " + std::to_string(nu).substr(0, 4),
                    mesh_name(variant, {16, 16, 16}), fine, 0, .05, "closed form", order});
      // 2 in the limit; a tenth for these meshes.
      EXPECT_GT(order, nu < .4 ? 1.9 : 1.6) << variant.name << " " << nu;
    }
}
