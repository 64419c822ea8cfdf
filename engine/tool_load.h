// What the tissue does to an instrument: force, and torque about its tip.
#pragma once

#include "base/exact_sum.h"

namespace trocar {

// Exact in any order. [N], [N m]
struct ToolLoad {
  ExactSum3 force, torque;
};

inline void add(const Vec3& force, const Vec3& torque, ToolLoad& load) {
  add(force, load.force);
  add(torque, load.torque);
}

}  // namespace trocar
