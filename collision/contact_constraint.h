// One condition of contact on the positions at the end of a step, and the impulse that keeps it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/vec.h"

namespace trocar {

struct ContactSet;

// n·(extra displacement of sum w x) >= lack. Weights add up to 1 where a tool touches, to 0 between
// tissue and tissue: one node less a point of a triangle.
struct ContactConstraint {
  std::int32_t item = 0;  // -1: between tissue and tissue
  std::array<std::int32_t, 4> place{};
  std::array<double, 4> weight{};
  // weight / mass by component, 0 along supported ones; of joined masses the node's own part [1/kg]
  std::array<Vec3, 4> lever{};
  Vec3 normal, slip;  // n; slip of the step without contact [m]
  double lack = 0;    // [m]
  // 1 / sum w^2 n·M^-1 n, and against slip 1 / sum w^2 / m: less than the former, so that what
  // supports keep from slipping takes all the friction there is. [kg]
  double felt_mass = 0, slip_mass = 0;
  // Impulse times dt, along n, and its bound: a triangle with two held corners would move the third
  // one a thousand times as far as it lacks. It fades to nothing with the weight of what yields,
  // which is one of rounding where the point lies on a held corner. [kg m]
  double push = 0, most_push = 0;
  Vec3 drag = Vec3::Zero();  // the same of friction, against slip [kg m]
};

// What a release may have of its speed along n where supports hold the node in some components: 1,
// down to 0 where n points along these.
double leeway_along(const Vec3& n, const Vec3& inverse_mass);

// Adds c, of which item, places, weights and normal are set, if the gap at the end of the step
// lacks anything. release: by how much a gap that was closed may open in the step; away:
// displacement of what the nodes move away from. [m]
void add_constraint(double gap, double release, const Vec3& away, ContactConstraint& c,
                    ContactSet& set);

// Moves the nodes by an impulse times dt [kg m].
void apply_impulse(const ContactConstraint& c, const Vec3& impulse, ContactSet& set);

// Shortened to `most` if it is longer.
Vec3 at_most(const Vec3& v, double most);

}  // namespace trocar
