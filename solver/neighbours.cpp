#include "solver/neighbours.h"

#include "base/check.h"
#include "base/timers.h"
#include "solver/kernels.h"
#include "solver/step.h"

namespace trocar {

namespace {

void start_theta(Neighbours& neighbours, State& state) {
  if (!neighbours.theta) return;
  neighbours.theta->start(state.theta, *neighbours.communicator);
  neighbours.under_way = Neighbours::UnderWay::theta;
}

void average_and_start(const Model& model, Neighbours& neighbours, State& state, Scratch& scratch) {
  begin_volume_change(model, state, scratch);
  finish_exchange(neighbours, state);
  end_volume_change(model, state, scratch);
  start_theta(neighbours, state);
}

}  // namespace

Neighbours make_neighbours(const Halo& halo, const Model& model, Communicator& communicator) {
  Neighbours neighbours{.communicator = &communicator};
  if (halo.neighbours.empty()) return neighbours;
  neighbours.motion.emplace(halo, 3);
  const int n_fields = model.averages.n_fields;
  if (n_fields > 0) neighbours.theta.emplace(halo, n_fields);
  return neighbours;
}

void start_exchange(Neighbours& neighbours, State& state) {
  CHECK(neighbours.under_way == Neighbours::UnderWay::none);
  if (!neighbours.motion) return;
  neighbours.motion->start(state.u, *neighbours.communicator);
  neighbours.under_way = Neighbours::UnderWay::motion;
}

void finish_exchange(Neighbours& neighbours, State& state) {
  using UnderWay = Neighbours::UnderWay;
  if (neighbours.under_way == UnderWay::none) return;
  const double start = monotonic_seconds();
  if (neighbours.under_way == UnderWay::motion)
    neighbours.motion->finish(state.u, *neighbours.communicator);
  else
    neighbours.theta->finish(state.theta, *neighbours.communicator);
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

}  // namespace trocar
