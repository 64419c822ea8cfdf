// Linear and angular momentum of the nodes around an edit, kept through it.
#pragma once

#include <cstdint>
#include <span>

#include "engine/apply_cut.h"

namespace trocar {

// Mass, momentum and angular momentum about `centre` of some nodes.
struct Motion {
  double mass = 0, scale = 0, kinetic = 0;               // [kg], sum |m v| [kg m/s], [J]
  Vec3 centre = Vec3::Zero();                            // of mass [m]
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();  // [kg m/s], [kg m^2/s]
  Mat3 inertia = Mat3::Zero();                           // [kg m^2]
};

Motion motion_of(std::span<const std::int32_t> nodes, std::span<const double> mass,
                 const GlobalState& state, const Vec3& about);

// About their own centre of mass.
Motion motion_about_centre(std::span<const std::int32_t> nodes, std::span<const double> mass,
                           const GlobalState& state);

// Gives `nodes` so much more kinetic energy [J], or less, where their motion apart from that of a
// rigid body allows it: that part is scaled, by a factor of 1.5 at most. Momentum and angular
// momentum stay.
void add_kinetic_energy(std::span<const std::int32_t> nodes, std::span<const double> mass,
                        double energy, GlobalState& state, CutRecord& record);

// Nodes around an edit, ascending, and what moves them: a step gives supported and held ones the
// velocity of what holds them.
struct EditedNodes {
  std::span<const std::int32_t> node, adjustable;
  std::span<const double> mass;      // (n_nodes) [kg]
  std::span<const FixedMask> fixed;  // (n_nodes)
  std::span<const Hold> holds;
};

// Momentum and angular momentum of all become what they were, by those that are free to move, and
// so does the kinetic energy, as far as the motion of `adjustable` allows it.
void restore_motion(const EditedNodes& nodes, const Motion& before, GlobalState& state,
                    CutRecord& record);

}  // namespace trocar
