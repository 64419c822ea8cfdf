// How tissue moves around blades. How far it has come within a frame is known from the surface's
// positions at the frame's begin (SurfaceView), until the frame's first edit.
#pragma once

#include <span>
#include <vector>

#include "cutting/blade_sweep.h"
#include "cutting/cut_positions.h"
#include "engine/locate.h"

namespace trocar {

struct Simulation;

// Of all nodes of the surface. Collective. [m]
double largest_surface_way(const Simulation& s);

// For each point of the edge, of the surface's node that it comes nearest to on its way; none if
// the sweep is farther than `reach` [m] from the body. [m]
std::vector<Vec3> ways_beside(const Simulation& s, PresentPositions& positions,
                              const BladeSweep& sweep, double reach);

// Of the tissue along the pieces of an edge, mean over their length. Collective. [m/s]
Vec3 velocity_along(const Simulation& s, std::span<const SegmentPiece> engaged);

}  // namespace trocar
