// Selective mass scaling of a scene: what it adds, where, and who is told.
#pragma once

#include <cstdint>
#include <span>

#include "base/box.h"
#include "solver/mass_scaling.h"

namespace trocar {

struct Simulation;

struct AddedMass {
  double mass = 0, share = 0;  // [kg], of the body's mass
  std::int32_t n_elements = 0, n_nodes = 0, n_clusters = 0, largest_cluster = 0;  // in nodes
  std::int32_t heaviest_node = -1;      // where most was added
  Box box{Vec3::Zero(), Vec3::Zero()};  // around the nodes concerned [m]
};

// Finds the elements to be scaled, if the scene asks for it, and moves clusters that lie on several
// ranks to one: before the part is made.
void plan_mass_scaling(Simulation& s);
// The same after an edit of these elements that the mesh has taken; false if a cluster would have
// to move.
bool follow_mass_scaling(std::span<const std::int32_t> edited, Simulation& s);
// Measures it, if there is any, says it once, and notes an event when more than 5 % of the body's
// mass is added and it was not before.
void report_mass_scaling(Simulation& s);

}  // namespace trocar
