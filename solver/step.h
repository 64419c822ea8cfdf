// One explicit step (central differences as leapfrog): force, then integrate. Between the two,
// engine adds contact forces to scratch.force.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "solver/model.h"

namespace trocar {

class ElementWatch;
struct NodeMotion;

// state.theta of owned nodes, from u: before compute_force, watch and energy_terms, which read it.
// The caller exchanges theta (model.averages.n_fields a node) afterwards. Does nothing without
// fields.
void average_volume_change(const Model& model, State& state, Scratch& scratch);
// The same in two parts, the first of which reads no halo nodes.
void begin_volume_change(const Model& model, const State& state, Scratch& scratch);
void end_volume_change(const Model& model, State& state, Scratch& scratch);

// scratch.force = mass * gravity - internal force(u), for owned nodes; each node sums its corners
// list by list (region, then formulation), ascending by global element number. Brings the history
// of viscoelastic elements to state.time: a second call at the same time and displacement changes
// nothing.
void compute_force(const Model& model, State& state, Scratch& scratch);
// The same in two parts, the first of which reads no halo nodes: of one thread, all strides before
// the first one that does, of several nothing. On the way `watch` looks at the elements that don't
// sleep. With a `motion`, nodes move as soon as their forces are known, while they are in the
// cache, and scratch.force is that of waiting nodes alone.
void begin_force(const Model& model, State& state, Scratch& scratch, ElementWatch* watch = nullptr,
                 const NodeMotion* motion = nullptr);
void end_force(const Model& model, State& state, Scratch& scratch, ElementWatch* watch = nullptr,
               const NodeMotion* motion = nullptr);

// scratch.viscous_force: what the present scratch.force of compute_force is more than the force
// that the laws without relaxation would give. Does nothing unless keep_works asked for it.
void find_viscous_force(const Model& model, State& state, Scratch& scratch);

// A node whose motion is given: an instrument holds it.
struct PrescribedNode {
  std::int32_t node = 0;         // local, owned
  Vec3 u_next = Vec3::Zero();    // displacement at the end of the step [m]
  Vec3 reaction = Vec3::Zero();  // out: force that the holder applies to the node in this step [N]
};

// Central difference with centred mass damping:
//   v+ = ((2 - alpha dt_m) v + 2 dt_m f/m) / (2 + alpha dt_m),  dt_m = (last_dt + dt) / 2,
//   u+ = u + dt v+.
// Supported components stay; prescribed nodes go where they are told, with the reaction
//   R = m (v+ - v) / dt_m + alpha m (v+ + v) / 2 - f
// (none in a component that a support holds), which is added to scratch.force. Advances time and
// step. Owned nodes only: the caller exchanges u afterwards.
void integrate(const Model& model, Scratch& scratch, std::span<PrescribedNode> prescribed,
               double dt, State& state);

// The nodes' part of a step in which no works are kept and no mass is scaled.
NodeMotion free_motion(const Model& model, double dt, State& state);
// Sorts the nodes, each once, and makes their mask; before the first step with them.
void mark_waiting(const Model& model, WaitingNodes& waiting);
// What step_others (neighbours.h) leaves to do: integrate of the waiting nodes, among them the
// prescribed ones.
void step_waiting(const Model& model, const WaitingNodes& waiting,
                  std::span<PrescribedNode> prescribed, double dt, State& state, Scratch& scratch);

// u_next (n_local * 3) of `nodes` (local, owned) and of prescribed ones: where integrate would take
// them under scratch.force as it is.
void predict(const Model& model, Scratch& scratch, std::span<const PrescribedNode> prescribed,
             std::span<const std::int32_t> nodes, double dt, const State& state,
             std::span<double> u_next);
// Displacement that one newton more gives 1 kg in the step [s^2].
double step_response(const Model& model, const State& state, double dt);

// With keep_works, since forget_works: energy that mass damping has taken from each owned node. [J]
std::vector<double> find_damping_work(const Model& model, const Scratch& scratch);
void forget_works(Scratch& scratch);

// Name of the instruction set that the kernels use: "sse2", "avx2", "avx512"; "scalar" for tests.
const char* simd_name();
// Picks it: "auto" or one of the names. Throws InputError if the machine lacks it. Call before the
// first step.
void select_simd(const std::string& name);
// Bytes that model and scratch hold.
std::size_t memory_bytes(const Model& model, const Scratch& scratch);

}  // namespace trocar
