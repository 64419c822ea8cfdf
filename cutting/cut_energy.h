// What a good place for a node is: f = h^2/6 sum_a 1/altitude_a^2 of its elements (the explicit
// stability bound, 1 for the regular tetrahedron of edge h) squared, plus its squared distance to
// the swept surface. Exact derivatives: the volume is linear in a node, the sum of squared face
// areas quadratic.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "base/vec.h"

namespace trocar {

struct NodeEnergy {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
  Mat3 hessian = Mat3::Zero();
};

// Six times the volume, and the sum of the squared double areas of the facets.
struct TetShape {
  double V = 0, S = 0;
};
TetShape tet_shape(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner);
double stability_bound(const TetShape& shape, double h);
// f of one tetrahedron; infinite if it has no volume.
double stability_bound(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner,
                       double h);

// A tetrahedron by its shape, which must have volume, and the node p at one of its corners with the
// others, q, in the order of the facet across (tet_facets).
struct TetAtNode {
  TetShape shape;
  std::array<const Vec3*, 3> q;
};
// Adds their f^2 and its derivatives by p, in this order.
void add_squared_bounds(const Vec3& p, std::span<const TetAtNode> tets, double h,
                        NodeEnergy& energy);

}  // namespace trocar
