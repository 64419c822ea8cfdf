// The paper's combined mass-spring and particle system (Serby et al. 2001, eqs. 4 to 6).
#pragma once

#include <span>

#include "cutting/cut_plane.h"
#include "cutting/cut_plane_smooth.h"

namespace trocar {

// Moves the nodes until the largest displacement of a step is below the threshold. Springs have the
// length of the edge before the cut; particles attract and repel each other by Lennard-Jones
// potentials whose equilibrium is the mean length of the edges around both. A step that would
// invert an element is taken back for its nodes.
void homogenise(PlanePatch& patch, std::span<const Movable> movable,
                const CutPlaneOptions& options);

}  // namespace trocar
