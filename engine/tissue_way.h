// How tissue moves around blades. How far it has come within a frame is known from the surface's
// positions at the frame's begin (SurfaceView), until the frame's first edit.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cutting/blade_sweep.h"
#include "cutting/cut_positions.h"
#include "engine/locate.h"

namespace trocar {

struct Simulation;

// What a blade moves against is the tissue's motion in the mean of 0.3 s: the share that a frame of
// so long has in it.
double share_of_frame(double seconds);

// Of all nodes of the surface. Collective. [m]
double largest_surface_way(const Simulation& s);

// For each point of the edge, of the surface's node that it comes nearest to on its way; none if
// the sweep is farther than `reach` [m] from the body. [m]
std::vector<Vec3> ways_beside(const Simulation& s, PresentPositions& positions,
                              const BladeSweep& sweep, double reach);

// The velocity of the surface's node that is nearest to the edge, of those within `reach` [m] of
// it. [m/s]
std::optional<Vec3> velocity_beside(const Simulation& s, PresentPositions& positions,
                                    const std::vector<Vec3>& edge, double reach);

// Of the tissue along the pieces of an edge, mean over their length. Collective. [m/s]
Vec3 velocity_along(const Simulation& s, std::span<const SegmentPiece> engaged);

}  // namespace trocar
