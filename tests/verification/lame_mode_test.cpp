// V6, Lame mode of a free square prism: u = (cos sin, -sin cos)(pi x/a, pi y/a) vibrates with
// omega = sqrt 2 pi c_s / a exactly, for any Poisson ratio, all faces free of traction.
#include <gtest/gtest.h>

#include <numbers>

#include "solver_body.h"

using namespace trocar;

constexpr double a = .04;

static Vec3 shape(const Vec3& X) {
  const double x = std::numbers::pi * X.x() / a, y = std::numbers::pi * X.y() / a;
  return {std::cos(x) * std::sin(y), -std::sin(x) * std::cos(y), 0};
}

// Share of the mode in the displacement.
static double amplitude(const Body& body) {
  double dot = 0, norm = 0;
  for (std::int32_t i = 0; i < body.model.n_owned; ++i) {
    const Vec3 mode = shape(body.mesh.X[i]);
    dot += body.mass[i] * mode.dot(Vec3::Map(&body.state.u[3 * i]));
    norm += body.mass[i] * mode.squaredNorm();
  }
  return dot / norm;
}

// From the first and the 21st zero crossing: over ten periods, because the mode of the mesh differs
// a little from the sampled exact one, and other modes shift single crossings.
static double measured_period(int n, double nu) {
  Body body = make_body(
      make_box(Vec3(0, 0, 0), Vec3(a, a, a / n), {n, n, 1}, BoxElements::hex8),
      {.materials = {{MaterialModel::neo_hookean, 3000, nu, 1000}}, .solver = {.hourglass = .2}});
  displace(body, [](const Vec3& X) { return Vec3(1e-6 * shape(X)); });
  const double dt = .5 * least_element_step(body);
  std::vector<double> crossings;
  double before = amplitude(body);
  while (crossings.size() < 21) {
    step(body, dt);
    const double now = amplitude(body);
    if (before * now <= 0) crossings.push_back(body.state.time - dt * now / (now - before));
    before = now;
  }
  return (crossings[20] - crossings[0]) / 10;
}

static double period_error(int n, double nu) {
  const double c_s = std::sqrt(3000 / (2 * (1 + nu)) / 1000);
  const double exact = std::sqrt(2) * a / c_s;  // 2 pi / omega
  return measured_period(n, nu) / exact - 1;
}

TEST(LameMode, one_point_hexahedra_have_the_known_error_which_falls_with_the_mesh) {
  // numerics V6: +2.6 % at n = 8, +0.5 % at n = 16, for c_mu = 0.2. The last digit is rounded, and
  // the time step shortens the period by (omega dt)^2 / 24, below 0.1 %.
  for (const double nu : {.3, .49}) {
    EXPECT_NEAR(period_error(8, nu), .026, .0025) << nu;
    EXPECT_NEAR(period_error(16, nu), .0050, .0015) << nu;
  }
}

TEST(LameMode, the_error_does_not_grow_near_incompressibility) {
  // Elements that lock shorten the period by 2 to 8 % there (numerics V6).
  EXPECT_NEAR(period_error(8, .3), period_error(8, .499), .003);
}
