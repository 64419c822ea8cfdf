// Leapfrog in fictitious time, v+ = ((2 - c dt) v + 2 dt f / m) / (2 + c dt), u+ = u + dt v+.
#include "solver/relax.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/exact_sum.h"
#include "solver/block_ranges.h"
#include "solver/simd.h"

namespace trocar {

namespace {

constexpr std::int64_t look_interval = 20;
constexpr double step_margin = 0.95;

// K <= sum_e omega_e^2 M_e and omega_e = 2 / step_e, so that with m / step^2 of the stiffest
// element at each node no frequency exceeds 2.
std::vector<double> scaled_mass(const Model& model) {
  std::vector<double> least(model.mass.size(), 0.0);
  for (const ElementBlocks& blocks : model.blocks) {
    const std::int64_t n_corners = std::ssize(blocks.corner) / std::ssize(blocks.element_local);
    for (std::int64_t k = 0; k < std::ssize(blocks.corner); ++k) {
      const std::int64_t lane = k / (n_corners * blocks.lanes) * blocks.lanes + k % blocks.lanes;
      const std::int32_t node = blocks.corner[k];
      const double step = model.element_step[blocks.element_local[lane]];
      if (node < model.n_owned) least[node] = std::max(least[node], 1 / (step * step));
    }
  }
  for (std::size_t i = 0; i < least.size(); ++i) least[i] *= inertia_of(model)[i];
  return least;
}

// Greatest growth of an element's omega^2 in the present deformation; NaN where one is broken.
// Lanes behind the last element mean nothing.
double greatest_stiffening(const Model& model, const State& state) {
  double most = 1;
  for (const ElementBlocks& blocks : model.blocks) {
    std::array<double, stash_blocks * lanes_of_block<float>> none{}, J{}, stiffening{};
    for_strained_blocks(
        model, blocks, state, 0, blocks.n_blocks,
        [&](const BlockKernels& kernels, const BlockTask& task, std::int64_t block) {
          kernels.law.watch(task, none.data(), J.data(), stiffening.data());
          const std::int64_t n = std::min<std::int64_t>(task.n_blocks * blocks.lanes,
                                                        blocks.n_elements - block * blocks.lanes);
          for (std::int64_t lane = 0; lane < n; ++lane)
            if (!(stiffening[lane] <= most)) most = stiffening[lane];
        });
  }
  return most;
}

// Sums of squares, and the Rayleigh quotient's two parts, over all ranks.
struct Sums {
  double imbalance, damping, held;  // |f|^2 and |c M v|^2 of free components, |f|^2 of others
  double stiffness, inertia;        // v.(f_before - f) / dt = v.K v and v.M v
};

struct ExactSums {
  ExactSum imbalance, damping, held, stiffness, inertia;
};

Sums total(ExactSums& sums, const Communicator& communicator) {
  for (ExactSum* sum : {&sums.imbalance, &sums.damping, &sums.held, &sums.stiffness, &sums.inertia})
    sum->all_sum(communicator);
  return {sums.imbalance.value(), sums.damping.value(), sums.held.value(), sums.stiffness.value(),
          sums.inertia.value()};
}

Sums sum_up(const Relaxer& r, const State& state, const Scratch& scratch,
            const Communicator& communicator) {
  ExactSums sums;
  for (std::size_t k = 0; k < r.is_free.size(); ++k) {
    const double f = scratch.force[k], v = state.v[k], m = r.mass[k / 3];
    if (r.is_free[k] == 0) {
      sums.held.add(f * f);
      continue;
    }
    sums.imbalance.add(f * f);
    sums.damping.add(r.damping * m * v * (r.damping * m * v));
    sums.stiffness.add(v * (r.force_before[k] - f));
    sums.inertia.add(m * v * v);
  }
  return total(sums, communicator);
}

void update_residual(const Sums& sums, Relaxer& r) {
  const double imbalance = std::sqrt(std::max(sums.imbalance, sums.damping));
  r.greatest_imbalance = std::max(r.greatest_imbalance, imbalance);
  const double scale = std::max(std::sqrt(sums.held), 1e-3 * r.greatest_imbalance);
  r.result.residual = scale > 0 ? imbalance / scale : 0;
}

// c = 2 omega_0 with the Rayleigh quotient of the present motion, which is never below the lowest
// frequency and comes down to it when only the slowest mode is left.
void update_damping(const Sums& sums, Relaxer& r) {
  if (!(sums.inertia > 0) || !(sums.stiffness > 0)) return;
  const double A0 = std::min(sums.stiffness / (r.step * sums.inertia), 0.25);
  r.damping = 2 * std::sqrt(A0);
}

// A sum over squares leaves broken values out; the maximum does not.
bool are_all_finite(const Scratch& scratch, const Communicator& communicator) {
  double sum = 0;
  for (const double f : scratch.force) sum += f - f;
  return communicator.all_max(std::abs(sum)) == 0;
}

void look(const Model& model, const Scratch& scratch, Communicator& communicator, Relaxer& r,
          State& state) {
  const double stiffening = communicator.all_max(greatest_stiffening(model, state));
  r.result.is_finite = std::isfinite(stiffening) && are_all_finite(scratch, communicator);
  if (!r.result.is_finite) return;
  const Sums sums = sum_up(r, state, scratch, communicator);
  update_residual(sums, r);
  if (r.result.iterations > 0) update_damping(sums, r);
  r.step = step_margin / std::sqrt(stiffening);
}

double ramp(const RelaxTask& task, std::int64_t iteration) {
  if (iteration >= task.ramp_iterations) return 1;
  const double s = static_cast<double>(iteration + 1) / static_cast<double>(task.ramp_iterations);
  return s * s * (3 - 2 * s);
}

void add_load(const Model& model, const RelaxTask& task, double share, Scratch& scratch) {
  if (!task.load.empty())
    for (std::size_t k = 0; k < task.load.size(); ++k) scratch.force[k] += share * task.load[k];
  if (task.add_load) task.add_load(share, scratch.force);
  if (share == 1) return;
  for (std::size_t i = 0; i < model.mass.size(); ++i)
    for (int j = 0; j < 3; ++j)
      scratch.force[3 * i + static_cast<std::size_t>(j)] -=
          (1 - share) * model.mass[i] * model.options.gravity[j];
}

void place_held(const Model& model, const RelaxTask& task, std::span<const Vec3> start,
                double share, State& state) {
  for (std::size_t k = 0; k < task.prescribed.size(); ++k) {
    const PrescribedNode& held = task.prescribed[k];
    for (int j = 0; j < 3; ++j)
      if ((model.fixed[held.node] >> j & 1) == 0)
        state.u[3 * held.node + j] =
            share == 1 ? held.u_next[j] : start[k][j] + share * (held.u_next[j] - start[k][j]);
  }
}

std::vector<Vec3> held_positions(const RelaxTask& task, const State& state) {
  std::vector<Vec3> start;
  for (const PrescribedNode& held : task.prescribed)
    start.emplace_back(Vec3::Map(&state.u[3 * held.node]));
  return start;
}

void find_relaxed_force(const Model& model, Neighbours& neighbours, State& state,
                        Scratch& scratch) {
  start_exchange(neighbours, state);
  state.history_time = -std::numeric_limits<double>::infinity();  // all overstress has gone
  scratch.has_force = false;
  find_force(model, neighbours, state, scratch);
}

bool is_stopped(const RelaxTask& task, const Communicator& communicator) {
  return task.stop != nullptr && communicator.all_max(*task.stop ? 1 : 0) > 0;
}

}  // namespace

Relaxer make_relaxer(const Model& model, std::span<const PrescribedNode> prescribed) {
  Relaxer r;
  r.mass = scaled_mass(model);
  r.force_before.assign(model.mass.size() * 3, 0.0);
  r.is_free.resize(model.mass.size() * 3);
  for (std::size_t k = 0; k < r.is_free.size(); ++k)
    r.is_free[k] = (model.fixed[k / 3] >> k % 3 & 1) == 0 ? 1 : 0;
  for (const PrescribedNode& held : prescribed) {
    CHECK_OP(held.node, <, model.n_owned);
    std::fill_n(r.is_free.begin() + 3 * std::int64_t{held.node}, 3, std::uint8_t{0});
  }
  return r;
}

void relax_step(const Model& model, const Scratch& scratch, Communicator& communicator, Relaxer& r,
                State& state) {
  const std::int64_t phase = r.result.iterations % look_interval;
  if (phase == 0) look(model, scratch, communicator, r, state);
  if (!r.result.is_finite) return;
  if (phase == look_interval - 1) r.force_before = scratch.force;
  const double c = r.damping, dt = r.step;
  const double keep = (2 - c * dt) / (2 + c * dt), gain = 2 * dt / (2 + c * dt);
  parallel_for_nodes(model.n_owned, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = 3 * begin; k < 3 * end; ++k) {
      if (r.is_free[k] == 0) continue;
      state.v[k] = keep * state.v[k] + gain * scratch.force[k] / r.mass[k / 3];
      state.u[k] += dt * state.v[k];
    }
  });
  ++r.result.iterations;
}

Relaxation relax(const Model& model, const RelaxTask& task, State& state, Scratch& scratch) {
  CHECK(task.load.empty() || task.load.size() == scratch.force.size());
  Communicator alone;
  Neighbours none{.communicator = &alone};
  Neighbours& neighbours = task.neighbours != nullptr ? *task.neighbours : none;
  Relaxer r = make_relaxer(model, task.prescribed);
  const std::vector<Vec3> start = held_positions(task, state);
  std::fill(state.v.begin(), state.v.end(), 0.0);
  while (r.result.iterations < task.max_iterations) {
    const double share = ramp(task, r.result.iterations);
    place_held(model, task, start, share, state);
    find_relaxed_force(model, neighbours, state, scratch);
    add_load(model, task, share, scratch);
    const bool is_look = r.result.iterations % look_interval == 0;
    relax_step(model, scratch, *neighbours.communicator, r, state);
    r.result.is_converged = is_look && share == 1 && r.result.residual <= task.tolerance;
    r.result.is_stopped = is_look && is_stopped(task, *neighbours.communicator);
    if (r.result.is_converged || !r.result.is_finite || r.result.is_stopped) break;
  }
  find_relaxed_force(model, neighbours, state, scratch);
  add_load(model, task, 1, scratch);
  std::fill(state.v.begin(), state.v.end(), 0.0);
  state.last_dt = 0;
  return r.result;
}

}  // namespace trocar
