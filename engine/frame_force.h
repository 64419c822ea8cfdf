// Forces of a step beside those of elements, contacts and holds, and the time that forces take.
#pragma once

#include "engine/simulation.h"

namespace trocar {

// Counts the time of its own life as that of element forces, but what it waits for neighbours as
// exchange.
class ForceScope {
 public:
  explicit ForceScope(Simulation& s);
  ~ForceScope();
  ForceScope(const ForceScope&) = delete;
  ForceScope& operator=(const ForceScope&) = delete;

 private:
  Simulation& s_;
  double start_, waited_;
};

// Forces of a step dt in place of those at this moment, with solver.multirate. Collective.
void refine_forces(Simulation& s, double dt);
// s.loads as they act at a time [s] on the body as it is.
void find_loads_at(Simulation& s, double time);

}  // namespace trocar
