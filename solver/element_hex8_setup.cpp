// Set-up of the one-point hexahedra. Since B_a = (dV/dX_a) / V (Flanagan and Belytschko 1981),
// b_m = (dV/dx_m) / (8 V) in the modes of hex8_modes.h.
#include <algorithm>
#include <cmath>

#include "solver/element_hex8.h"
#include "solver/element_setup.h"
#include "solver/hex8_reference.h"
#include "solver/symmetric_eigenvalues.h"

namespace trocar {

namespace {

struct HourglassNorms {
  double gram = 0;      // bound of the largest eigenvalue of gamma_p . gamma_q (row sums)
  double coupling = 0;  // Frobenius norm of sum_a B_a gamma_p,a
};

// gamma_p has the modal coefficients delta_(m, 3+p) - b_m . X_p, and S_m . S_n = 8 delta_mn.
HourglassNorms hourglass_norms(const HexModes& b, const HexModes& X) {
  double gamma[4][7];
  for (std::size_t p = 0; p < 4; ++p)
    for (std::size_t m = 0; m < 7; ++m) gamma[p][m] = (m == 3 + p ? 1 : 0) - b[m].dot(X[3 + p]);
  HourglassNorms norms;
  double square = 0;
  for (const auto& gamma_p : gamma) {
    double row = 0;
    for (const auto& gamma_q : gamma) {
      double dot = 0;
      for (std::size_t m = 0; m < 7; ++m) dot += gamma_p[m] * gamma_q[m];
      row += std::abs(8 * dot);
    }
    norms.gram = std::max(norms.gram, row);
    Vec3 sum = Vec3::Zero();
    for (std::size_t m = 0; m < 7; ++m) sum += 8 * gamma_p[m] * b[m];
    square += sum.squaredNorm();
  }
  norms.coupling = std::sqrt(square);
  return norms;
}

// With the stiffness of the mean strain A A^T <= a and the hourglass stiffness C C^T <= c, of which
// k is the largest eigenvalue of the matrix in q, both over the corner mass: lambda_max(A A^T + C
// C^T) <= (a + c)/2 + sqrt((a - c)^2/4 + |A^T C|^2). For a parallelepiped A^T C = 0, so that the
// larger of the two governs.
double combined_bound(double a, double k, double V, const HourglassNorms& norms,
                      const ElementInput& input) {
  const double mass = input.density * V / 8, c = k * norms.gram / mass;
  const double stiffest = 3 * std::max(input.lambda, 0.0) + 2 * input.mu;
  const double s = std::sqrt(V * k * stiffest) * norms.coupling / mass;
  return (a + c) / 2 + std::sqrt((a - c) * (a - c) / 4 + s * s);
}

// A one-point hexahedron but for its hourglass stiffness.
struct OnePointShape {
  HexModes X, b;
  double volume = 0;
  double bound = 0;  // of omega^2 of the mean strain
};

OnePointShape one_point_shape(const ElementInput& input) {
  OnePointShape shape;
  shape.X = position_modes(input.X);
  HexModes x = shape.X;
  for (Vec3& mode : x) mode /= 8;
  shape.volume = hexahedron_volume(x);
  if (!(shape.volume > 0)) return shape;
  shape.b = volume_gradient(x);
  SymmetricTensor<double> G{};
  for (Vec3& b : shape.b) {
    b /= shape.volume;
    add_gradient(std::sqrt(8.0) * b, G);
  }
  shape.bound = frequency_bound(G, 8, input);
  return shape;
}

// stiffness: of hourglass.h; k: the largest eigenvalue of A.
ElementConstants one_point_constants(const ElementInput& input, const OnePointShape& shape,
                                     std::span<const double> stiffness, double k) {
  ElementConstants c{.volume = shape.volume};
  const auto put = [&](std::size_t at, std::span<const Vec3> modes) {
    for (const Vec3& mode : modes)
      for (const double x : mode) c.value[at++] = x;
  };
  const std::span<const Vec3> X = shape.X;
  std::copy(stiffness.begin(), stiffness.end(), c.value.begin() + ElementHex8::value_k);
  const std::size_t at = ElementHex8::value_k + stiffness.size();
  put(at, X.subspan(3, 4));
  put(at + 12, X.first(3));
  c.value[at + 21] = 1 / (64 * shape.volume);
  c.omega2 = combined_bound(shape.bound, k, c.volume, hourglass_norms(shape.b, shape.X), input);
  return c;
}

}  // namespace

ElementConstants constants_hex8(const ElementInput& input) {
  const OnePointShape shape = one_point_shape(input);
  if (!(shape.volume > 0)) return {.volume = shape.volume};
  // k = c_mu mu V (sum_a |B_a|^2) / 8, and the sum over corners is 8 times the sum over modes.
  double b2 = 0;
  for (const Vec3& b : shape.b) b2 += b.squaredNorm();
  const double k = input.hourglass * input.mu * shape.volume * b2;
  return one_point_constants(input, shape, {&k, 1}, k);
}

ElementConstants constants_hex8_enhanced(const ElementInput& input) {
  const OnePointShape shape = one_point_shape(input);
  if (!(shape.volume > 0)) return {.volume = shape.volume};
  const double third = input.mu * shape.volume / 3;
  SymmetricTensor<double> A{};
  double b2 = 0;
  for (int p = 0; p < 3; ++p) {
    const Vec3& b = shape.b[p];
    b2 += b.squaredNorm();
    for (int r = p + 1; r < 3; ++r) A.v[symmetric_index[p][r]] = third * b.dot(shape.b[r]);
  }
  for (std::size_t p = 0; p < 3; ++p) A.v[p] = third * (b2 - shape.b[p].squaredNorm());
  std::array<double, HourglassEnhanced::n_values> stiffness{};
  std::copy_n(A.v, 6, stiffness.begin());
  stiffness[HourglassEnhanced::value_A3] = third * b2 / 3;  // a sixth of tr A: never the largest
  return one_point_constants(input, shape, stiffness, largest_eigenvalue(A));
}

}  // namespace trocar
