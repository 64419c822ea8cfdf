// Leapfrog in fictitious time, v+ = ((2 - c dt) v + 2 dt f / m) / (2 + c dt), u+ = u + dt v+.
#include "solver/relax.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/check.h"
#include "base/reproducible_dot.h"
#include "solver/block_ranges.h"
#include "solver/simd.h"

namespace trocar {

namespace {

constexpr std::int64_t look_interval = 20;
constexpr double step_margin = 0.95;

// Greatest growth of an element's omega^2 over that in the undeformed element; NaN where one is
// broken. Lanes behind the last element mean nothing.
double greatest_stiffening(const Model& model, const State& state) {
  double most = 1;
  std::mutex mutex;
  const auto take = [](double value, double& greatest) {
    if (value > greatest || std::isnan(value)) greatest = value;
  };
  const auto look = [&](const ElementBlocks& blocks, const BlockKernels& kernels,
                        const BlockTask& task, std::int64_t first) {
    std::array<double, stash_blocks * lanes_of_block<float>> none{}, J{}, stiffening{};
    kernels.law.watch(task, {none.data()}, J.data(), stiffening.data());
    const std::int64_t n =
        std::min(task.n_blocks * blocks.lanes, blocks.n_elements - first * blocks.lanes);
    double of_task = 1;
    for (std::int64_t lane = 0; lane < n; ++lane)
      take(stiffening[lane] / blocks.stiffening_at_rest, of_task);
    const std::scoped_lock lock(mutex);
    take(of_task, most);
  };
  parallel_for(count_blocks(model), [&](std::int64_t begin, std::int64_t end) {
    for_strained_block_range(model, state, begin, end, look);
  });
  return most;
}

// Sums of squares, and the Rayleigh quotient's two parts, over all ranks. What is held has no v.
struct Sums {
  double imbalance, damping, held;  // |f|^2 and |c M v|^2 of free components, |f|^2 of others
  double stiffness, inertia;        // v.(f_before - f) / dt = v.K v and v.M v
};

Sums sum_up(const State& state, const Scratch& scratch, const Communicator& communicator,
            Relaxer& r) {
  const std::size_t n = r.by_mass.size();
  const std::span v(state.v.data(), n);
  auto& [imbalance, held, momentum, difference] = r.room;
  for (std::vector<double>& x : r.room) x.resize(n);
  parallel_for_nodes(static_cast<std::int64_t>(n), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const double f = scratch.force[k];
      imbalance[k] = r.by_mass[k] > 0 ? f : 0;
      held[k] = f - imbalance[k];
      momentum[k] = r.mass[k / 3] * v[k];
      difference[k] = r.force_before[k] - f;
    }
  });
  const auto n_all = static_cast<std::int64_t>(communicator.all_sum(n));
  // Of all ranks: what products are rounded to must not depend on how they are spread.
  const auto largest = [&](std::span<const double> x) {
    return communicator.all_max(largest_size(x));
  };
  const auto dot = [&](std::span<const double> a, std::span<const double> b) {
    return reproducible_dot(a, b, n_all, largest(a) * largest(b), communicator);
  };
  return {.imbalance = dot(imbalance, imbalance),
          .damping = r.damping * r.damping * dot(momentum, momentum),
          .held = dot(held, held),
          .stiffness = dot(v, difference),
          .inertia = dot(v, momentum)};
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

void look(const Model& model, const Scratch& scratch, Communicator& communicator, Relaxer& r,
          State& state) {
  const double stiffening = communicator.all_max(greatest_stiffening(model, state));
  const Sums sums = sum_up(state, scratch, communicator, r);
  r.result.is_finite = std::isfinite(stiffening + sums.imbalance + sums.held);
  if (!r.result.is_finite) return;
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
  if (task.add_load) task.add_load(share, scratch.force);
  if (share == 1) return;
  for (std::size_t i = 0; i < model.mass.size(); ++i)
    for (int j = 0; j < 3; ++j)
      scratch.force[3 * i + j] -= (1 - share) * model.mass[i] * model.options.gravity[j];
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

// K <= sum_e omega_e^2 M_e and omega_e = 2 / step_e, so that with m / step^2 of the stiffest
// element at each node no frequency exceeds 2.
std::vector<double> relaxation_mass(const Model& model) {
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

Relaxer make_relaxer(const Model& model, std::span<const PrescribedNode> prescribed) {
  Relaxer r;
  r.mass = relaxation_mass(model);
  r.by_mass.resize(3 * r.mass.size());
  for (std::size_t k = 0; k < r.by_mass.size(); ++k)
    r.by_mass[k] = (model.fixed[k / 3] >> k % 3 & 1) == 0 ? 1 / r.mass[k / 3] : 0;
  for (const PrescribedNode& held : prescribed) {
    CHECK_OP(held.node, <, model.n_owned);
    std::fill_n(r.by_mass.begin() + 3 * std::int64_t{held.node}, 3, 0.0);
  }
  r.force_before.assign(r.by_mass.size(), 0.0);
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
    const double *const force = scratch.force.data(), *const by_mass = r.by_mass.data();
    double *const v = state.v.data(), *const u = state.u.data();
    for (std::int64_t k = 3 * begin; k < 3 * end; ++k) {
      v[k] = keep * v[k] + gain * force[k] * by_mass[k];
      u[k] += dt * v[k];
    }
  });
  ++r.result.iterations;
}

Relaxation relax(const Model& model, const RelaxTask& task, State& state, Scratch& scratch) {
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
    r.result.is_converged =
        r.result.is_finite && is_look && share == 1 && r.result.residual <= task.tolerance;
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
