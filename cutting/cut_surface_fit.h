// The swept surface near a node, in the reference configuration: implicit moving least squares
// through the crossing points around it (Kolluri 2008, Provably good moving least squares). Exact
// where the surface is plane.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "cutting/cut_patch.h"
#include "cutting/cut_stroke.h"

namespace trocar {

// phi(X) = N . X - offset: signed distance to the surface near the point where it was fitted. [m]
struct SurfacePlane {
  Vec3 N = Vec3::Zero();
  double offset = 0;
  double distance(const Vec3& X) const { return N.dot(X) - offset; }
};

// The crossing points of the elements around each node of a patch. A node without crossed elements
// has none.
struct SurfacePoints {
  std::vector<std::int32_t> offset;  // (n_nodes + 1)
  std::vector<SurfacePoint> point;
  std::span<const SurfacePoint> of(std::int32_t i) const {
    return {point.data() + offset[i], static_cast<std::size_t>(offset[i + 1] - offset[i])};
  }
};
SurfacePoints surface_points(const CutPatch& patch, const CutStroke& stroke);

// Points weigh (1 + (r/h)^2)^-2. `points` must not be empty.
SurfacePlane fit_surface(std::span<const SurfacePoint> points, const Vec3& X, double h);

}  // namespace trocar
