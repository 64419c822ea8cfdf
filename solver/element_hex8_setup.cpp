// Set-up of the one-point hexahedron. In the modal basis of element_hex8.h, X = sum_m S_m x_m, the
// exact volume of the trilinear element is
//   V = 8 ([x0 x1 x2] + ([x4 x3 x2] + [x5 x1 x3] + [x0 x5 x4]) / 3),
// and since B_a = (dV/dX_a) / V (Flanagan and Belytschko 1981), b_m = (dV/dx_m) / (8 V).
#include <algorithm>
#include <cmath>

#include "solver/element_hex8.h"
#include "solver/element_setup.h"

namespace trocar {

namespace {

using Modes = std::array<Vec3, 7>;

// xi, eta, zeta of the corners, then S_m,a.
constexpr int corner_xi[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                 {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

int mode_sign(std::size_t m, std::size_t a) {
  const auto& [x, y, z] = corner_xi[a];
  const int sign[7] = {x, y, z, y * z, z * x, x * y, x * y * z};
  return sign[m];
}

// sum_a S_m,a X_a, from differences to the first corner.
Modes position_modes(std::span<const Vec3> X) {
  Modes modes;
  for (std::size_t m = 0; m < 7; ++m) {
    modes[m] = Vec3::Zero();
    for (std::size_t a = 1; a < 8; ++a) modes[m] += mode_sign(m, a) * (X[a] - X[0]);
  }
  return modes;
}

double triple(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a.dot(b.cross(c));
}

double hexahedron_volume(const Modes& x) {
  return 8 * (triple(x[0], x[1], x[2]) +
              (triple(x[4], x[3], x[2]) + triple(x[5], x[1], x[3]) + triple(x[0], x[5], x[4])) / 3);
}

// dV/dx_m / 8
Modes volume_gradient(const Modes& x) {
  return {x[1].cross(x[2]) + x[5].cross(x[4]) / 3,
          x[2].cross(x[0]) + x[3].cross(x[5]) / 3,
          x[0].cross(x[1]) + x[4].cross(x[3]) / 3,
          (x[2].cross(x[4]) + x[5].cross(x[1])) / 3,
          (x[3].cross(x[2]) + x[0].cross(x[5])) / 3,
          (x[1].cross(x[3]) + x[4].cross(x[0])) / 3,
          Vec3::Zero()};
}

struct HourglassNorms {
  double gram = 0;      // bound of the largest eigenvalue of gamma_p . gamma_q (row sums)
  double coupling = 0;  // Frobenius norm of sum_a B_a gamma_p,a
};

// gamma_p has the modal coefficients delta_(m, 3+p) - b_m . X_p, and S_m . S_n = 8 delta_mn.
HourglassNorms hourglass_norms(const Modes& b, const Modes& X) {
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

// With the stiffness of the mean strain A A^T <= a and the hourglass stiffness C C^T <= c, both
// over the corner mass: lambda_max(A A^T + C C^T) <= (a + c)/2 + sqrt((a - c)^2/4 + |A^T C|^2). For
// a parallelepiped A^T C = 0, so that the larger of the two governs.
double combined_bound(double a, double k, double V, const HourglassNorms& norms,
                      const ElementInput& input) {
  const double mass = input.density * V / 8, c = k * norms.gram / mass;
  const double stiffest = 3 * std::max(input.lambda, 0.0) + 2 * input.mu;
  const double s = std::sqrt(V * k * stiffest) * norms.coupling / mass;
  return (a + c) / 2 + std::sqrt((a - c) * (a - c) / 4 + s * s);
}

}  // namespace

ElementConstants constants_hex8(const ElementInput& input) {
  const Modes X = position_modes(input.X);
  Modes x = X;
  for (Vec3& mode : x) mode /= 8;
  ElementConstants c{.volume = hexahedron_volume(x)};
  if (!(c.volume > 0)) return c;
  Modes b = volume_gradient(x);
  SymmetricTensor<double> G{};
  double b2 = 0;
  for (std::size_t m = 0; m < 7; ++m) {
    b[m] /= c.volume;
    b2 += b[m].squaredNorm();
    add_gradient(std::sqrt(8.0) * b[m], G);
  }
  // k = c_mu mu V (sum_a |B_a|^2) / 8, and the sum over corners is 8 times the sum over modes.
  const double k = input.hourglass * input.mu * c.volume * b2;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    for (std::size_t m = 0; m < 6; ++m) c.value[ElementHex8::value_b + 3 * m + j] = b[m][i];
    for (std::size_t p = 0; p < 4; ++p) c.value[ElementHex8::value_X + 3 * p + j] = X[3 + p][i];
  }
  c.value[ElementHex8::value_k] = k;
  c.omega2 =
      combined_bound(frequency_bound(G, 8, input), k, c.volume, hourglass_norms(b, X), input);
  return c;
}

}  // namespace trocar
