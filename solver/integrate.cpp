// Central differences in leapfrog form with centred mass damping.
#include <algorithm>
#include <array>

#include "base/check.h"
#include "base/sort_unique.h"
#include "solver/block_ranges.h"
#include "solver/mass_clusters.h"
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

// (v+ - v) / dt_m + alpha (v+ + v) / 2 of a component that goes from u to u_next; M times it is the
// force.
double given_acceleration(const Model& model, const Coefficients& c, double v, double v_next) {
  return (v_next - v) / c.dt_m + model.options.mass_damping * (v_next + v) / 2;
}

Vec3 given_acceleration(const Model& model, const Coefficients& c, double dt, const State& state,
                        const PrescribedNode& node) {
  Vec3 a;
  for (int j = 0; j < 3; ++j) {
    const std::int64_t k = 3 * std::int64_t{node.node} + j;
    a[j] = given_acceleration(model, c, state.v[k], (node.u_next[j] - state.u[k]) / dt);
  }
  return a;
}

// With it each node's equation stands for itself, with its inertia as mass.
void couple_clusters(const Model& model, const Coefficients& c, double dt, const State& state,
                     std::span<const PrescribedNode> prescribed, Scratch& scratch) {
  if (model.clusters.node.empty()) return;
  scratch.given.clear();
  for (const PrescribedNode& node : prescribed)
    if (model.clusters.of_node[node.node] >= 0)
      scratch.given.push_back(
          {.node = node.node, .a = given_acceleration(model, c, dt, state, node)});
  add_cluster_force(model, scratch.given, scratch.force, scratch.cluster_sums);
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
        inertia_of(model)[i] * given_acceleration(model, c, v, v_next) - scratch.force[3 * i + j];
    prescribed.reaction[j] = R;
    scratch.force[3 * i + j] += R;
  }
}

void check_owned(const Model& model, std::span<const PrescribedNode> prescribed) {
  for (const PrescribedNode& node : prescribed) {
    CHECK_OP(node.node, >=, 0);
    CHECK_OP(node.node, <, model.n_owned);
  }
}

// The velocity after the step of a component k = 3 i + j.
double next_velocity(const Model& model, const Coefficients& c, const Scratch& scratch,
                     const State& state, std::int64_t i, int j) {
  const std::int64_t k = 3 * i + j;
  return is_fixed(model, i, j)
             ? 0
             : c.keep * state.v[k] + c.gain / inertia_of(model)[i] * scratch.force[k];
}

// Works of nodes from `begin` on; `v`: their velocities before the step, then those in its middle.
void add_works(const NodeKernels& kernels, double dt_m, const State& state, std::int64_t begin,
               std::span<double> v, Scratch& scratch) {
  const auto of_nodes = [&](std::vector<double>& values) {
    return values.empty() ? nullptr : values.data() + 3 * begin;
  };
  kernels.works({.dt = dt_m,
                 .after = state.v.data() + 3 * begin,
                 .force = of_nodes(scratch.viscous_force),
                 .v = v.data(),
                 .swept = of_nodes(scratch.swept),
                 .work = of_nodes(scratch.viscous_work)},
                std::ssize(v));
  if (!scratch.middle.empty()) std::copy(v.begin(), v.end(), of_nodes(scratch.middle));
}

void integrate_nodes(const Model& model, const Coefficients& c, double dt, Scratch& scratch,
                     State& state) {
  constexpr std::int64_t at_once = 512;  // nodes, where works are kept
  NodeMotion task = free_motion(model, dt, state);
  task.force = scratch.force.data();
  parallel_for_nodes(model.n_owned, [&](std::int64_t begin, std::int64_t end) {
    const NodeKernels& kernels = active_kernels().nodes;
    if (!scratch.keeps_works) return kernels.motion(task, begin, end);
    std::array<double, 3 * at_once> v;
    for (; begin < end; begin += at_once) {
      const std::int64_t next = std::min(end, begin + at_once);
      std::copy(state.v.begin() + 3 * begin, state.v.begin() + 3 * next, v.begin());
      kernels.motion(task, begin, next);
      add_works(kernels, c.dt_m, state, begin, std::span(v).first(3 * (next - begin)), scratch);
    }
  });
}

// After the nodes.
void end_step(const Model& model, std::span<const PrescribedNode> prescribed, double dt,
              State& state, Scratch& scratch) {
  // Exactly there, without the rounding of u + dt (u_next - u) / dt.
  for (const PrescribedNode& node : prescribed)
    for (int j = 0; j < 3; ++j)
      if (!is_fixed(model, node.node, j)) state.u[3 * std::int64_t{node.node} + j] = node.u_next[j];
  scratch.has_force = false;
  state.time += dt;
  state.last_dt = dt;
  ++state.step;
}

}  // namespace

void predict(const Model& model, Scratch& scratch, std::span<const PrescribedNode> prescribed,
             std::span<const std::int32_t> nodes, double dt, const State& state,
             std::span<double> u_next) {
  const Coefficients c = coefficients(model.options.mass_damping, state.last_dt, dt);
  const bool has_clusters = !model.clusters.node.empty();
  if (has_clusters) scratch.uncoupled = scratch.force;
  couple_clusters(model, c, dt, state, prescribed, scratch);
  for (const std::int32_t i : nodes)
    for (int j = 0; j < 3; ++j)
      u_next[3 * std::int64_t{i} + j] =
          state.u[3 * std::int64_t{i} + j] + dt * next_velocity(model, c, scratch, state, i, j);
  for (const PrescribedNode& node : prescribed)
    for (int j = 0; j < 3; ++j)
      if (!is_fixed(model, node.node, j)) u_next[3 * std::int64_t{node.node} + j] = node.u_next[j];
  if (has_clusters) scratch.force.swap(scratch.uncoupled);
}

double step_response(const Model& model, const State& state, double dt) {
  return dt * coefficients(model.options.mass_damping, state.last_dt, dt).gain;
}

void integrate(const Model& model, Scratch& scratch, std::span<PrescribedNode> prescribed,
               double dt, State& state) {
  CHECK_OP(dt, >, 0);
  const Coefficients c = coefficients(model.options.mass_damping, state.last_dt, dt);
  check_owned(model, prescribed);
  couple_clusters(model, c, dt, state, prescribed, scratch);
  for (PrescribedNode& node : prescribed) add_reaction(model, c, dt, state, scratch, node);
  integrate_nodes(model, c, dt, scratch, state);
  if (!scratch.cluster_work.empty())  // alpha v·M v dt_m of what clusters have more than mass
    add_cluster_squares(model, scratch.middle, model.options.mass_damping * c.dt_m,
                        scratch.cluster_work);
  end_step(model, prescribed, dt, state, scratch);
}

void mark_waiting(const Model& model, WaitingNodes& waiting) {
  sort_unique(waiting.node);
  if (waiting.node.empty()) return;
  CHECK_OP(waiting.node.front(), >=, 0);
  CHECK_OP(waiting.node.back(), <, model.n_owned);
  waiting.mask = model.fixed;
  for (const std::int32_t i : waiting.node) waiting.mask[i] |= waits;
}

void step_waiting(const Model& model, const WaitingNodes& waiting,
                  std::span<PrescribedNode> prescribed, double dt, State& state, Scratch& scratch) {
  NodeMotion task = free_motion(model, dt, state);
  task.force = scratch.force.data();
  check_owned(model, prescribed);
  const Coefficients c = coefficients(model.options.mass_damping, state.last_dt, dt);
  for (PrescribedNode& node : prescribed) add_reaction(model, c, dt, state, scratch, node);
  for (const std::int32_t i : waiting.node) active_kernels().nodes.motion(task, i, i + 1);
  end_step(model, prescribed, dt, state, scratch);
}

NodeMotion free_motion(const Model& model, double dt, State& state) {
  CHECK_OP(dt, >, 0);
  const Coefficients c = coefficients(model.options.mass_damping, state.last_dt, dt);
  return {.keep = c.keep,
          .gain = c.gain,
          .dt = dt,
          .inertia = inertia_of(model).data(),
          .fixed = model.fixed.data(),
          .force = nullptr,
          .v = state.v.data(),
          .u = state.u.data()};
}

std::vector<double> find_damping_work(const Model& model, const Scratch& scratch) {
  std::vector<double> work = scratch.cluster_work;
  work.resize(static_cast<std::size_t>(model.n_owned));
  for (std::size_t k = 0; k < scratch.swept.size(); ++k)
    work[k / 3] += model.options.mass_damping * model.mass[k / 3] * scratch.swept[k];
  return work;
}

void forget_works(Scratch& scratch) {
  for (std::vector<double>* sum : {&scratch.swept, &scratch.viscous_work, &scratch.cluster_work})
    std::fill(sum->begin(), sum->end(), 0.0);
}

}  // namespace trocar
