// What contact adds to the stiffness of triangles that it presses on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/contact_set.h"

namespace trocar {

// A tool that is curved with the radius R touches a triangle further up as that tilts, so that its
// force F turns it back: to second order the gap has -R/2 |grad u|^2 of the displacement u along
// the normal, a stiffness F R grad N_a . grad N_b = turn * edge[a] . edge[b], as gradients stand
// upright on the edges opposite the corners.
struct Tilt {
  std::array<std::int32_t, 3> place{};  // of the corners in the set's nodes
  std::array<Vec3, 3> edge;             // [m]
  Vec3 normal;
  double turn = 0;  // [N/m^3]
};

// Of the mean forces over the frame's n_steps; none on ranks that don't count the reactions.
std::vector<Tilt> find_tilts(const ContactDetector& detector, std::int64_t n_steps,
                             const ContactSet& set);

// Adds the force on a triangle's corners that are displaced by u. [m], [N]
void add_tilt_force(const Tilt& tilt, const std::array<Vec3, 3>& u, std::array<Vec3, 3>& force);

// The square of the highest frequency that these stiffnesses alone give the set's nodes. [1/s^2]
double tilt_frequency2(std::span<const Tilt> tilts, const ContactSet& set);

}  // namespace trocar
