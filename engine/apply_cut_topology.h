// What follows from mesh and owners (rebuild_topology), after an edit that left every element its
// place: made anew around the edit, kept elsewhere. A rank that holds none of the edited elements
// keeps its part, halo and model.
#pragma once

#include <cstdint>
#include <span>

#include "engine/simulation.h"

namespace trocar {

// Whether update_topology will do: no hexahedra were split, all corners stayed with their owners,
// and the scene has nothing that is planned on the whole mesh (mass scaling, multirate, sleep).
// mesh: before the edit; owners: behind it.
bool keeps_places(const Simulation& s, const MeshEdit& edit);

// elements: edited ones; nodes: all their corners, before and after the edit; both ascending.
// x (n_nodes) present positions [m]. Collective. The result is rebuild_topology's, but for the
// state and the boxes of elements that this one forgets.
void update_topology(Simulation& s, std::span<const std::int32_t> elements,
                     std::span<const std::int32_t> nodes, std::span<const Vec3> x);

}  // namespace trocar
