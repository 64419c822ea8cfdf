// A column of 1 x 6 x 1 m that starts with the velocity (10 y / 6, 0, 0) m/s and bends by half its
// height (set up by Bonet, Gil and co-workers for explicit solid dynamics): the first peak of the
// deflection at its top.
#include <algorithm>
#include <cmath>

#include "base/timers.h"
#include "study/study_body.h"
#include "study/study_problem.h"

namespace trocar {

namespace {

constexpr double column_height = 6, duration = .55, frame_time = .025;

// Top of the parabola through the largest of the samples and its neighbours.
double peak_of(const std::vector<double>& y) {
  const auto k = std::max_element(y.begin(), y.end()) - y.begin();
  if (k == 0 || k + 1 == std::ssize(y)) return y[k];
  const double left = y[k - 1], mid = y[k], right = y[k + 1];
  const double curvature = left - 2 * mid + right, slope = (right - left) / 2;
  return curvature < 0 ? mid - slope * slope / (2 * curvature) : mid;
}

void swing(const Case& c, StudyBody& body, Outcome& outcome) {
  const auto top = 3 * static_cast<std::size_t>(nearest_node(body.mesh, {.5, column_height, .5}));
  std::vector<double> deflection;
  const auto look = [&](double) { deflection.push_back(body.state.u[top]); };
  while (body.state.time < duration - frame_time / 2)
    if (!advance_frame(body, frame_time, c.step_factor, look)) {
      outcome.trouble = "the body is broken after " + std::to_string(body.state.time) + " s";
      return;
    }
  outcome.value = peak_of(deflection);
}

Outcome solve_column(const Case& c) {
  Outcome outcome;
  const double start = thread_seconds();
  outcome.h = 1. / c.n;
  StudyBody body = make_study_body(
      make_box(Vec3::Zero(), Vec3(1, column_height, 1), {c.n, 6 * c.n, c.n}, c.method.elements),
      outcome.h, {MaterialModel::neo_hookean, 17e6, .45, 1100},
      [](const Vec3& X) { return FixedMask{X.y() < 1e-9 ? FixedMask{7} : FixedMask{0}}; },
      solver_options(c.method, c.precision));
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
    body.state.v[3 * i] = 10 * body.mesh.X[i].y() / column_height;
  const double ready = thread_seconds();
  swing(c, body, outcome);
  outcome.stepping_seconds = thread_seconds() - ready;
  outcome.setup_seconds = ready - start;
  outcome.n_elements = body.mesh.n_elements();
  outcome.n_steps = body.state.step;
  outcome.dt = body.state.time / static_cast<double>(std::max<std::int64_t>(body.state.step, 1));
  return outcome;
}

}  // namespace

Problem problem_bending_column() {
  return {.name = "bending-column",
          .title = "Column bent by its own momentum",
          .quantity = "first peak of the top's deflection",
          .unit = "m",
          .reference = 2.9955,
          .reference_error = .001 / 2.9955,
          .source = "one-point hexahedra and tetrahedra of a separate program, extrapolated",
          .simulated_seconds = duration,
          .length = 2.9955,
          .sizes = {2, 4, 8, 12},
          .size_meaning = "cells over the width of 1 m (even)",
          .size_multiple = 2,  // else no node lies in the middle of the top
          .methods = solid_methods(),
          .factors = {.5, .85},
          .solve = solve_column};
}

}  // namespace trocar
