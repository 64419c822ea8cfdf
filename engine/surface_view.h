// Positions of the surface nodes on every rank, gathered once a frame: what detection, rendering
// and metrics look at.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/communicator.h"
#include "mesh/facets.h"
#include "mesh/partition.h"

namespace trocar {

struct SurfaceView {
  std::vector<Vec3> x;  // (n_nodes), valid at surface nodes; empty until somebody looks [m]
  std::vector<Vec3> v;  // the same, where tissue touches tissue; else empty [m/s]
  // Surface nodes by (owner, number), the order in which they arrive, and local numbers of this
  // rank's ones.
  std::vector<std::int32_t> node, local;
};

// Round the surface's nodes.
Box box_of(const SurfaceView& view);

SurfaceView make_surface_view(const Surface& surface, std::span<const std::int32_t> node_owner,
                              const Part& part);
// The same after an edit, in time of the surface's; positions of new nodes wait for the next
// gathering.
void update_surface_view(const Surface& surface, std::span<const std::int32_t> node_owner,
                         const Part& part, SurfaceView& view);
// Collective. u, v (n_local * 3).
void gather_surface(SurfaceView& view, std::span<const Vec3> X, std::span<const double> u,
                    Communicator& communicator);
void gather_velocities(SurfaceView& view, std::span<const double> v, Communicator& communicator);

}  // namespace trocar
