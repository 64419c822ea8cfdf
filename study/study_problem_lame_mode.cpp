// Free vibration of a square prism in a mode of Lame, u = (cos sin, -sin cos)(pi x/a, pi y/a): its
// frequency sqrt 2 pi c_s / a is exact for any Poisson ratio, and all faces are free of traction.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/timers.h"
#include "study/study_body.h"
#include "study/study_problem.h"

namespace trocar {

namespace {

constexpr double a = .04, young_modulus = 3000, poisson_ratio = .49, density = 1000;
constexpr int n_periods = 10;

double exact_period() {
  const double c_s = std::sqrt(young_modulus / (2 * (1 + poisson_ratio)) / density);
  return std::sqrt(2) * a / c_s;
}

Vec3 shape(const Vec3& X) {
  const double x = std::numbers::pi * X.x() / a, y = std::numbers::pi * X.y() / a;
  return {std::cos(x) * std::sin(y), -std::sin(x) * std::cos(y), 0};
}

// Weights that give the share of the mode in the displacement.
std::vector<Vec3> projection(const StudyBody& body) {
  std::vector<Vec3> weight;
  double norm = 0;
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i) {
    const Vec3 mode = shape(body.mesh.X[i]);
    weight.emplace_back(body.mass[i] * mode);
    norm += body.mass[i] * mode.squaredNorm();
  }
  for (Vec3& w : weight) w /= norm;
  return weight;
}

double amplitude(const StudyBody& body, const std::vector<Vec3>& weight) {
  double sum = 0;
  for (std::size_t i = 0; i < weight.size(); ++i)
    sum += weight[i].dot(Vec3::Map(&body.state.u[3 * i]));
  return sum;
}

// Over ten periods between zero crossings, because other modes shift single crossings.
void vibrate(const Case& c, StudyBody& body, Outcome& outcome) {
  const std::vector<Vec3> weight = projection(body);
  std::vector<double> crossings;
  double before = amplitude(body, weight);
  const auto look = [&](double dt) {
    const double now = amplitude(body, weight);
    if (before * now <= 0) crossings.push_back(body.state.time - dt * now / (now - before));
    before = now;
  };
  while (crossings.size() <= 2 * n_periods && body.state.time < 2 * n_periods * exact_period())
    if (!advance_frame(body, exact_period() / 2, c.step_factor, look)) break;
  if (crossings.size() > 2 * n_periods)
    outcome.value = (crossings[2 * n_periods] - crossings[0]) / n_periods;
  else
    outcome.trouble = "the body does not vibrate through ten periods";
}

Outcome solve_lame_mode(const Case& c) {
  Outcome outcome;
  const double start = thread_seconds();
  outcome.h = a / c.n;
  StudyBody body = make_study_body(
      make_box(Vec3::Zero(), Vec3(a, a, outcome.h), {c.n, c.n, 1}, c.method.elements), outcome.h,
      {MaterialModel::neo_hookean, young_modulus, poisson_ratio, density}, {},
      solver_options(c.method, c.precision));
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
    Vec3::Map(&body.state.u[3 * i]) = 1e-6 * shape(body.mesh.X[i]);
  const double ready = thread_seconds();
  vibrate(c, body, outcome);
  outcome.stepping_seconds = thread_seconds() - ready;
  outcome.setup_seconds = ready - start;
  outcome.n_elements = body.mesh.n_elements();
  outcome.n_steps = body.state.step;
  outcome.dt = body.state.time / static_cast<double>(std::max<std::int64_t>(body.state.step, 1));
  return outcome;
}

}  // namespace

Problem problem_lame_mode() {
  return {.name = "lame-mode",
          .title = "Free vibration of a square prism in a mode of Lame",
          .quantity = "period",
          .unit = "s",
          .reference = exact_period(),
          .reference_error = 0,
          .source = "closed form",
          .simulated_seconds = (n_periods + .5) * exact_period(),
          .sizes = {8, 16, 32, 64},
          .size_meaning = "cells over the edge of 40 mm, one over the thickness",
          .growth = 3,
          .methods = solid_methods(),
          .factors = {.5, .85},
          .solve = solve_lame_mode};
}

}  // namespace trocar
