// A surface of triangles on its own: an instrument's shape, in the frame of the instrument.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace trocar {

struct TriangleMesh {
  std::vector<Vec3> X;                                // [m]
  std::vector<std::array<std::int32_t, 3>> triangle;  // outward
};

void append(TriangleMesh& mesh, const TriangleMesh& other);

// Closed primitives with vertices on the true shape, n segments round the axis (sphere: z). The
// axis of capsule, cylinder and cone runs from a to b.
TriangleMesh make_sphere_surface(const Vec3& centre, double radius, int n);
TriangleMesh make_capsule_surface(const Vec3& a, const Vec3& b, double radius, int n);
TriangleMesh make_cone_surface(const Vec3& a, const Vec3& b, double radius_a, double radius_b,
                               int n);
TriangleMesh make_box_surface(const Vec3& low, const Vec3& high);
// A planar convex outline (counter-clockwise about `axis`) extruded by +-thickness/2 along the unit
// vector `axis`.
TriangleMesh make_plate_surface(const std::vector<Vec3>& outline, const Vec3& axis,
                                double thickness);

}  // namespace trocar
