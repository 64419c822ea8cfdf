// f^2 = (h^2/6)^2 S^2 / V^4 with S = sum of |2 area|^2 and V = 6 volumes.
#include "cutting/cut_energy.h"

#include <limits>

#include "cutting/cut_patch.h"

namespace trocar {

static Vec3 double_area(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner, int f) {
  const std::array<int, 3>& c = tet_facets[static_cast<std::size_t>(f)];
  const Vec3& o = X[corner[c[0]]];
  return (X[corner[c[1]]] - o).cross(X[corner[c[2]]] - o);
}

TetShape tet_shape(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner) {
  const Vec3& o = X[corner[0]];
  const Vec3 a = X[corner[1]] - o, b = X[corner[2]] - o, c = X[corner[3]] - o;
  const Vec3 n = a.cross(b), m = b.cross(c), k = c.cross(a);
  return {n.dot(c),
          n.squaredNorm() + m.squaredNorm() + k.squaredNorm() + (n + m + k).squaredNorm()};
}

double stability_bound(const TetShape& shape, double h) {
  if (!(shape.V > 0)) return std::numeric_limits<double>::infinity();
  return h * h / 6 * shape.S / (shape.V * shape.V);
}

double stability_bound(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner,
                       double h) {
  return stability_bound(tet_shape(X, corner), h);
}

void add_squared_bound(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner, int a,
                       double h, NodeEnergy& energy) {
  const Vec3& p = X[corner[static_cast<std::size_t>(a)]];
  const std::array<int, 3>& facet = tet_facets[static_cast<std::size_t>(a)];
  Vec3 dS = Vec3::Zero();
  Mat3 ddS = Mat3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &q = X[corner[facet[k]]], &r = X[corner[facet[(k + 1) % 3]]];
    const Vec3 d = q - r, u = p - r;
    dS += 2 * (d.squaredNorm() * u - d.dot(u) * d);
    ddS += 2 * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  }
  const auto [V, S] = tet_shape(X, corner);
  const Vec3 dV = -double_area(X, corner, a);
  const double c = h * h / 6 * S / (V * V), g = c * c;
  const Vec3 log_gradient = 2 / S * dS - 4 / V * dV;
  energy.value += g;
  energy.gradient += g * log_gradient;
  energy.hessian += g * (log_gradient * log_gradient.transpose() + 2 / S * ddS -
                         2 / (S * S) * dS * dS.transpose() + 4 / (V * V) * dV * dV.transpose());
}

}  // namespace trocar
