// Contact as a condition on positions (forward increment Lagrange multipliers: Carpenter, Taylor,
// Katona 1991): the impulses with which tissue is not inside an instrument at the end of the step,
// and Coulomb friction. No stiffness has to be chosen, and the stable step is that without contact,
// but for the tilt of triangles (contact_tilt.h).
// An impact is inelastic: it takes the normal kinetic energy of the nodes that it stops.
#pragma once

#include <cstdint>
#include <span>

#include "collision/contact_set.h"

namespace trocar {

struct ContactOptions {
  double friction = 0.2;  // Coulomb's mu
  // Tissue that a tool appears inside of (jaws that open, a fresh cut) leaves it with this speed
  // and not with depth / dt. [m/s]
  double release_speed = 0.02;
};

struct ToolMotion {
  Pose pose;
  Vec3 velocity = Vec3::Zero();          // of the frame's origin [m/s]
  Vec3 angular_velocity = Vec3::Zero();  // [rad/s]
};

struct ContactStep {
  std::span<const ToolMotion> tools;  // at the end of the step, with their twists over it
  std::int64_t number = 0;            // within the frame
  double dt = 0;                      // [s]
  double response = 0;                // displacement in the step of 1 kg under 1 N [s^2]
};

// Finds set.beside's positions, as look_again does first.
void place_beside(const ContactStep& step, ContactSet& set);
// Looks at the triangles anew, weights, points and normals, where they lie on the tool at the
// beginning of the step. Where their forces take them, without those of contact, may be on the
// tool's other side; and where their velocities do, the point of contact would run ahead of the
// triangle that tilts beneath it: with the element's own stiffness that oscillation stays bounded
// to a third of the contact's (a pressed probe chattered, its force 1 to 12 % too small). Near are
// those that could come to the tool in the step.
void look_again(const ContactDetector& detector, const ContactStep& step, ContactSet& set);

// After place_beside. set.force and the items' reaction_sum. Two kinds of contact points x: the
// nearest point of each triangle, and each node (in the piece that it is deepest in, if its
// triangle sees that from outside), both as they lie on the tool at the beginning. Of a triangle
// that lies flat on a tool the nodes do. Nodes that face both flanks of a blade, the front of its
// wound, touch neither, nor do their triangles. With the gap g = n·(x - y) at the end of the step
// and g0 at its beginning, y of the tool: g >= min(0, g0 + release_speed dt) where g0 < 0, g >= 0
// elsewhere; without release_speed for a triangle with a held corner inside. Slip of x along the
// surface is stopped with at most mu times the normal impulse. Between tissue and tissue x - y is a
// node less the nearest point of the nearest triangle, and n this triangle's normal: both sides'
// nodes are kept out of the other's triangles, edges may cross. Solved by projections, contact
// after contact (Gauss-Seidel), at most 30 times round.
void solve_contacts(const ContactDetector& detector, const ContactStep& step,
                    const ContactOptions& options, ContactSet& set);

}  // namespace trocar
