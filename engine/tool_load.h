// What the tissue does to an instrument: force, and torque about its tip.
#pragma once

#include "base/exact_sum.h"

namespace trocar {

// Exact in any order. [N], [N m]
struct ToolLoad {
  ExactSum3 force, torque;
  ExactSum3 pull;  // the part of the force by which what it holds pulls
};

inline void add(const Vec3& force, const Vec3& torque, ToolLoad& load) {
  add(force, load.force);
  add(torque, load.torque);
}

}  // namespace trocar
