// Central differences in leapfrog form with centred mass damping.
#include "base/check.h"
#include "solver/block_ranges.h"
#include "solver/step.h"

namespace trocar {

namespace {

// v+ = keep v + gain f / m
struct Coefficients {
  double dt_m, keep, gain;
};

Coefficients coefficients(double alpha, double last_dt, double dt) {
  const double dt_m = (last_dt + dt) / 2;
  return {dt_m, (2 - alpha * dt_m) / (2 + alpha * dt_m), 2 * dt_m / (2 + alpha * dt_m)};
}

bool is_fixed(const Model& model, std::int64_t i, int j) {
  return (model.fixed[i] >> j & 1) != 0;
}

// The equation of motion m (v+ - v) / dt_m + alpha m (v+ + v) / 2 = f + R with v+ = (u_next - u) /
// dt gives the force R of the holder. Added to f, it makes the step arrive at u_next. A component
// that a support holds stays: the support bears it, not the holder.
void add_reaction(const Model& model, const Coefficients& c, double dt, const State& state,
                  Scratch& scratch, PrescribedNode& prescribed) {
  const std::int64_t i = prescribed.node;
  for (int j = 0; j < 3; ++j) {
    prescribed.reaction[j] = 0;
    if (is_fixed(model, i, j)) continue;
    const double v = state.v[3 * i + j];
    const double v_next = (prescribed.u_next[j] - state.u[3 * i + j]) / dt;
    const double R =
        model.mass[i] * ((v_next - v) / c.dt_m + model.options.mass_damping * (v_next + v) / 2) -
        scratch.force[3 * i + j];
    prescribed.reaction[j] = R;
    scratch.force[3 * i + j] += R;
  }
}

void integrate_nodes(const Model& model, const Coefficients& c, double dt, const Scratch& scratch,
                     State& state) {
  parallel_for_nodes(model.n_owned, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const double gain = c.gain / model.mass[i];
      for (int j = 0; j < 3; ++j) {
        const std::int64_t k = 3 * i + j;
        state.v[k] = is_fixed(model, i, j) ? 0 : c.keep * state.v[k] + gain * scratch.force[k];
        state.u[k] += dt * state.v[k];
      }
    }
  });
}

// alpha m |v|^2 dt_m with v = (v+ + v-) / 2; call before the velocities change.
void add_damping_work(const Model& model, const Coefficients& c, const State& state,
                      Scratch& scratch) {
  const double alpha = model.options.mass_damping;
  if (scratch.damping_work.empty() || alpha == 0) return;
  for (std::int64_t i = 0; i < model.n_owned; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) {
      const std::int64_t k = 3 * i + j;
      if (is_fixed(model, i, j)) continue;
      const double v_next = c.keep * state.v[k] + c.gain / model.mass[i] * scratch.force[k];
      const double v = (state.v[k] + v_next) / 2;
      sum += v * v;
    }
    scratch.damping_work[i] += alpha * model.mass[i] * sum * c.dt_m;
  }
}

}  // namespace

void integrate(const Model& model, Scratch& scratch, std::span<PrescribedNode> prescribed,
               double dt, State& state) {
  CHECK_OP(dt, >, 0);
  const Coefficients c = coefficients(model.options.mass_damping, state.last_dt, dt);
  for (PrescribedNode& node : prescribed) {
    CHECK_OP(node.node, >=, 0);
    CHECK_OP(node.node, <, model.n_owned);
    add_reaction(model, c, dt, state, scratch, node);
  }
  add_damping_work(model, c, state, scratch);
  integrate_nodes(model, c, dt, scratch, state);
  // Exactly there, without the rounding of u + dt (u_next - u) / dt.
  for (const PrescribedNode& node : prescribed)
    for (int j = 0; j < 3; ++j)
      if (!is_fixed(model, node.node, j)) state.u[3 * std::int64_t{node.node} + j] = node.u_next[j];
  state.time += dt;
  state.last_dt = dt;
  ++state.step;
}

}  // namespace trocar
