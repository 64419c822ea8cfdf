#include "solver/neighbours.h"

#include <array>

#include "base/check.h"
#include "base/timers.h"
#include "solver/kernels.h"
#include "solver/step.h"

namespace trocar {

namespace {

// Displacements, velocities.
std::array<NodalField, 2> motion_of(const Neighbours& neighbours, State& state) {
  return {NodalField{state.u, 3}, NodalField{state.v, neighbours.with_velocity ? 3 : 0}};
}

void start_theta(const Model& model, Neighbours& neighbours, State& state) {
  if (!neighbours.theta) return;
  const NodalField theta[] = {{state.theta, model.averages.n_fields}};
  neighbours.theta->start(theta, *neighbours.communicator);
  neighbours.under_way = Neighbours::UnderWay::theta;
}

void average_and_start(const Model& model, Neighbours& neighbours, State& state, Scratch& scratch) {
  begin_volume_change(model, state, scratch);
  finish_exchange(neighbours, state);
  end_volume_change(model, state, scratch);
  start_theta(model, neighbours, state);
}

}  // namespace

Neighbours make_neighbours(const Halo& halo, const Model& model, bool with_velocity,
                           Communicator& communicator) {
  Neighbours neighbours{.communicator = &communicator, .with_velocity = with_velocity};
  if (halo.neighbours.empty()) return neighbours;
  neighbours.motion.emplace(halo, with_velocity ? 6 : 3);
  const int n_fields = model.averages.n_fields;
  if (n_fields > 0) neighbours.theta.emplace(halo, n_fields);
  return neighbours;
}

void start_exchange(Neighbours& neighbours, State& state) {
  CHECK(neighbours.under_way == Neighbours::UnderWay::none);
  if (!neighbours.motion) return;
  neighbours.motion->start(motion_of(neighbours, state), *neighbours.communicator);
  neighbours.under_way = Neighbours::UnderWay::motion;
}

void finish_exchange(Neighbours& neighbours, State& state) {
  using UnderWay = Neighbours::UnderWay;
  if (neighbours.under_way == UnderWay::none) return;
  const double start = monotonic_seconds();
  if (neighbours.under_way == UnderWay::motion) {
    neighbours.motion->finish(motion_of(neighbours, state), *neighbours.communicator);
  } else {
    const int n_fields = neighbours.theta->width();
    const NodalField theta[] = {{state.theta, n_fields}};
    neighbours.theta->finish(theta, *neighbours.communicator);
  }
  neighbours.under_way = UnderWay::none;
  neighbours.waited += monotonic_seconds() - start;
}

void update_volume_change(const Model& model, Neighbours& neighbours, State& state,
                          Scratch& scratch) {
  if (model.averages.n_fields > 0) average_and_start(model, neighbours, state, scratch);
  finish_exchange(neighbours, state);
}

namespace {

void find_force(const Model& model, Neighbours& neighbours, State& state, Scratch& scratch,
                ElementWatch* watch, const NodeMotion* motion) {
  if (model.averages.n_fields > 0) average_and_start(model, neighbours, state, scratch);
  begin_force(model, state, scratch, watch, motion);
  finish_exchange(neighbours, state);
  end_force(model, state, scratch, watch, motion);
}

}  // namespace

void find_force(const Model& model, Neighbours& neighbours, State& state, Scratch& scratch,
                ElementWatch* watch) {
  find_force(model, neighbours, state, scratch, watch, nullptr);
}

void step_others(const Model& model, Neighbours& neighbours, const WaitingNodes& waiting, double dt,
                 State& state, Scratch& scratch) {
  CHECK(!scratch.keeps_works && model.clusters.node.empty());
  NodeMotion motion = free_motion(model, dt, state);
  if (!waiting.node.empty()) {
    CHECK_OP(std::ssize(waiting.mask), ==, model.n_owned);
    motion.fixed = waiting.mask.data();
  }
  find_force(model, neighbours, state, scratch, nullptr, &motion);
}

void step_freely(const Model& model, Neighbours& neighbours, double dt, State& state,
                 Scratch& scratch) {
  step_others(model, neighbours, {}, dt, state, scratch);
  step_waiting(model, {}, {}, dt, state, scratch);
}

}  // namespace trocar
