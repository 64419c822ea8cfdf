// Derivatives of the trilinear map.
#include "cutting/cut_hex_shape.h"

#include <algorithm>
#include <cmath>

#include "mesh/mesh.h"

namespace trocar {

// V is linear in each coordinate of each corner, so a difference over any length is the derivative.
double hex_step_bound(const std::array<Vec3, 8>& X) {
  const double V = element_volume(ElementType::hex8, X), length = (X[6] - X[0]).norm();
  double sum = 0;
  std::array<Vec3, 8> moved = X;
  for (std::size_t a = 0; a < 8; ++a)
    for (Eigen::Index k = 0; k < 3; ++k) {
      moved[a][k] += length;
      const double slope = (element_volume(ElementType::hex8, moved) - V) / length;
      sum += slope * slope;
      moved[a] = X[a];
    }
  return V / std::sqrt(2 * sum);
}

static double jacobian(const std::array<Vec3, 8>& X, const std::array<double, 3>& xi) {
  Mat3 J = Mat3::Zero();
  for (std::size_t a = 0; a < 8; ++a)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      const auto& c = hex_corner_xi[a];
      const double slope = c[k] / 8.0 * (1 + c[i] * xi[i]) * (1 + c[j] * xi[j]);
      J.col(static_cast<Eigen::Index>(k)) += slope * X[a];
    }
  return J.determinant();
}

double least_gauss_ratio(const std::array<Vec3, 8>& X) {
  const double centre = jacobian(X, {0, 0, 0}), g = 1 / std::sqrt(3.0);
  if (!(centre > 0)) return -1;
  double least = centre;
  for (const auto& c : hex_corner_xi)
    least = std::min(least, jacobian(X, {g * c[0], g * c[1], g * c[2]}));
  return least / centre;
}

}  // namespace trocar
