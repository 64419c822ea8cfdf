// V25, V26, V27: what the undamped motion keeps, over many steps of small bodies.
#include "larger_or_nan.h"
#include "solver_stiffness.h"
#include "verification_dynamics.h"
#include "verification_figure.h"

using namespace trocar;

struct EnergyHistory {
  double first = 0, range = 0, drift = 0;  // drift: last tenth's mean over the first's
};

static EnergyHistory energy_history(Body& body, double dt, int n_steps) {
  constexpr int n_samples = 2000;
  std::vector<double> E;
  step(body, dt);
  for (int k = 0; k < n_samples; ++k) {
    E.push_back(step_and_measure(body, dt));
    for (int s = 1; s < n_steps / n_samples; ++s) step(body, dt);
  }
  const auto mean = [&](int begin, int end) {
    return std::accumulate(E.begin() + begin, E.begin() + end, 0.0) / (end - begin);
  };
  const auto [least, most] = std::minmax_element(E.begin(), E.end());
  const double first = mean(0, n_samples / 10);
  return {first, (*most - *least) / first,
          (mean(n_samples - n_samples / 10, n_samples) - first) / first};
}

static Body swinging_cantilever(const Variant& variant, const std::array<int, 3>& n) {
  Body body = make_box_body(
      variant,
      {.size = {.1, .02, .02}, .n = n, .material = soft_tissue, .fixed = [](const Vec3& X) {
         return FixedMask(X.x() < 1e-9 ? 7 : 0);
       }});
  set_velocity(body, [](const Vec3& X) { return Vec3(0, 0, .3 * std::pow(X.x() / .1, 2)); });
  return body;
}

TEST(V25Energy, the_range_of_the_energy_of_a_large_swing_is_bounded) {
  for (const Variant& variant : {hex_one_point, hex_enhanced, tet_plain, tet_nodal_pressure})
    for (const auto& [factor, tolerance] : {std::pair{.9, 2e-4}, std::pair{.1, 2e-6}}) {
      Body body = swinging_cantilever(variant, {10, 2, 2});
      const EnergyHistory history =
          energy_history(body, factor * least_element_step(body), is_report() ? 30000 : 10000);
      check_figure({"V25 Energy of a free vibration",
                    "range over 30000 steps at " + std::to_string(factor).substr(0, 3) + " dt_c",
                    mesh_name(variant, {10, 2, 2}), history.range, 0, tolerance,
                    "numerics V25, relative"});
    }
}

TEST(V25Energy, does_not_drift_over_a_million_steps_at_nine_tenths_of_the_true_limit) {
  Body body = swinging_cantilever(hex_one_point, {3, 1, 1});
  const double limit = true_limit(body, 1e-8);
  for (const std::size_t k : {0U, 1U, 2U}) EXPECT_EQ(body.state.v[k], 0);  // clamped
  set_velocity(body, [](const Vec3& X) { return Vec3(0, 0, .1 * std::pow(X.x() / .1, 2)); });
  const int n_steps = is_report() ? 1000000 : 200000;
  const EnergyHistory history = energy_history(body, .9 * limit, n_steps);
  check_figure({"V25 Energy of a free vibration",
                "drift over " + std::to_string(n_steps) + " steps at .9 of the true limit",
                "hex8 3 x 1 x 1", history.drift, 0, 1e-4, "numerics S10, relative"});
}

// V26: one cube in a pure hourglass mode.
static Body hourglass_cube(double alpha) {
  Body body =
      make_body(make_box(Vec3::Zero(), Vec3(.01, .01, .01), {1, 1, 1}, BoxElements::hex8),
                {.materials = {soft_tissue}, .solver = {.mass_damping = alpha, .hourglass = .15}});
  displace(body, [](const Vec3& X) {
    return Vec3(1e-6 * ((X.x() > .005) == (X.y() > .005) ? 1 : -1), 0, 0);
  });
  return body;
}

static double hourglass_omega() {
  const double mu = 3000 / (2 * 1.45);
  return std::sqrt(12 * .15 * mu / 1000) / .01;
}

TEST(V26Hourglass, one_cube_vibrates_in_its_hourglass_mode_with_the_closed_frequency) {
  Body body = hourglass_cube(0);
  const double dt = .1 * least_element_step(body);
  std::vector<double> crossings;
  while (crossings.size() < 21) {
    const double before = body.state.u[0];
    step(body, dt);
    if (before * body.state.u[0] <= 0)
      crossings.push_back(body.state.time - dt * body.state.u[0] / (body.state.u[0] - before));
  }
  const double omega = 20 * std::acos(-1.0) / (crossings[20] - crossings[0]);
  // The scheme's frequency is (2 / dt) asin(omega dt / 2), higher by (omega dt)^2 / 24 < 1e-3.
  check_figure(
      {"V26 Hourglass mode", "frequency [rad/s]", "one cube", omega, hourglass_omega(), 1e-3});
}

TEST(V26Hourglass, the_mode_neither_grows_in_many_steps_nor_survives_damping) {
  Body body = hourglass_cube(0);
  const double dt = .9 * least_element_step(body);
  const int n_steps = is_report() ? 1000000 : 200000;
  double most = 0;
  for (int k = 0; k < n_steps; ++k) {
    step(body, dt);
    most = larger_or_nan(most, std::abs(body.state.u[0]));
  }
  // The start u_1 = u_0 + dt^2/2 a_0 has the amplitude eps / sqrt(1 - (omega dt / 2)^2).
  const double s = hourglass_omega() * dt / 2;
  check_figure({"V26 Hourglass mode",
                "greatest amplitude over " + std::to_string(n_steps) + " steps", "one cube",
                most / 1e-6, 1, 1 / std::sqrt(1 - s * s) - 1 + 1e-3});
  Body damped = hourglass_cube(50);
  while (damped.state.time < .4) step(damped, dt);
  EXPECT_LT(largest(damped.state.u), 2e-6 * std::exp(-25 * .4));
}

// V27
static Momenta momenta(const Body& body) {
  Momenta m;
  for (std::int32_t i = 0; i < body.model.n_owned; ++i) {
    const Vec3 p = body.model.mass[i] * Vec3::Map(&body.state.v[3 * i]);
    m.linear += p;
    m.angular += (body.mesh.X[i] + Vec3::Map(&body.state.u[3 * i])).cross(p);
  }
  return m;
}

// Of 4 x 3 x 2 cubes of edge `cell`.
static Body spinning_block(const Variant& variant, double cell, const Vec3& drift) {
  const Vec3 size = cell * Vec3(4, 3, 2), centre = .5 * size;
  Body body = make_box_body(variant, {.size = size, .n = {4, 3, 2}, .material = soft_tissue});
  set_velocity(body, [&](const Vec3& X) { return Vec3(drift + Vec3(3, 8, 5).cross(X - centre)); });
  return body;
}

// The greatest change over 1e5 steps.
static Momenta greatest_change(Body& body) {
  const double dt = .5 * least_element_step(body);
  const Momenta start = momenta(body);
  Momenta worst;
  for (int k = 0; k < 100000; ++k) {
    step(body, dt);
    if (k % 1000 != 999) continue;
    const Momenta now = momenta(body);
    worst.linear = worst.linear.cwiseMax((now.linear - start.linear).cwiseAbs());
    worst.angular = worst.angular.cwiseMax((now.angular - start.angular).cwiseAbs());
  }
  return worst;
}

// Linear momentum of a block that flies and spins; angular momentum of one that only spins, because
// far from the origin x times p loses the digits that it is to be compared by.
static void check_momenta(const Variant& variant, double cell, double tolerance) {
  const std::string name = "V27 Spinning free block",
                    mesh = mesh_name(variant, {4, 3, 2}) + (cell == .01 ? "" : ", cells of 1/64 m");
  Body flying = spinning_block(variant, cell, {.2, -.1, .15});
  const double p = momenta(flying).linear.norm();
  check_figure({name, "change of linear momentum over 1e5 steps", mesh,
                greatest_change(flying).linear.norm() / p, 0, tolerance, "conservation, relative"});
  Body spinning = spinning_block(variant, cell, Vec3::Zero());
  const double L = momenta(spinning).angular.norm();
  check_figure({name, "change of angular momentum over 1e5 steps", mesh,
                greatest_change(spinning).angular.norm() / L, 0, tolerance,
                "conservation, relative"});
}

TEST(V27Spin, a_free_block_keeps_its_linear_and_angular_momentum) {
  // Rounding: 1e-16 a step and component, a random walk of 1e5 steps.
  check_momenta(hex_one_point, .01, 1e-12);
  check_momenta(tet_plain, .01, 1e-12);
  check_momenta(hex_enhanced, .01, 1e-12);
  check_momenta(tet_nodal_pressure, .01, 1e-12);
  check_momenta(hex_one_point_single, .01, 1e-5);
  // numerics V27. Where single precision holds positions and gradients exactly, nothing else
  // drifts.
  check_momenta(hex_one_point_single, 1. / 64, 1e-6);
}
