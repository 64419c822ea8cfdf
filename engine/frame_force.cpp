#include "engine/frame_force.h"

#include "solver/step.h"
#include "solver/thickness.h"

namespace trocar {

static double waited_for_neighbours(const Simulation& s) {
  return s.neighbours.waited + (s.multirate ? s.multirate->neighbours.waited : 0);
}

ForceScope::ForceScope(Simulation& s)
    : s_(s), start_(monotonic_seconds()), waited_(waited_for_neighbours(s)) {}

ForceScope::~ForceScope() {
  const double waited = waited_for_neighbours(s_) - waited_;
  s_.timers.add(phase_exchange, waited);
  s_.timers.add(phase_force, monotonic_seconds() - start_ - waited);
}

void refine_forces(Simulation& s, double dt) {
  if (!s.multirate) return;
  refine_force({.model = s.model, .state = s.state, .prescribed = s.holds.prescribed, .dt = dt},
               *s.multirate, s.scratch);
}

void find_loads_at(Simulation& s, double time) {
  if (s.loads.is_empty()) return;
  if (s.model.options.tri3 == Formulation::tri3_plane_stress)
    for (Loads::Face& face : s.loads.faces)
      if (face.element >= 0) face.stretch = thickness_stretch(s.model, s.state, face.element);
  find_loads(s.scene.loads, s.mesh, s.part, s.scene.tissue.thickness, time, s.state.u, s.loads);
}

}  // namespace trocar
