// Set-up of the fully integrated hexahedron.
#include <algorithm>
#include <cmath>

#include "solver/element_hex8_full.h"
#include "solver/element_setup.h"
#include "solver/hex8_reference.h"

namespace trocar {

namespace {

using Mat8 = Eigen::Matrix<double, 8, 8>;
using MonomialGradients = Eigen::Matrix<double, 3, n_hex_modes>;

// dS_m = grad_xi of the monomials at a point, one a column.
MonomialGradients monomial_gradients(const Vec3& xi) {
  const double x = xi[0], y = xi[1], z = xi[2];
  MonomialGradients dS;
  dS << 1, 0, 0, 0, z, y, y * z,  //
      0, 1, 0, z, 0, x, z * x,    //
      0, 0, 1, y, x, 0, x * y;
  return dS;
}

// lambda_max <= (tr L^p)^(1/p), here p = 64: at most 1.7 % too large for three equal eigenvalues.
double largest_eigenvalue_bound(Mat8 L) {
  const double trace = L.trace();  // no eigenvalue of L / tr L exceeds 1, and one is at least 1/8
  L /= trace;
  constexpr int n_squarings = 6;
  for (int k = 0; k < n_squarings; ++k) L = (L * L).eval();
  double root = L.trace();
  for (int k = 0; k < n_squarings; ++k) root = std::sqrt(root);
  return trace * root;
}

// Gauss point k in (-1, 1)^3, in the order of the kernels.
Vec3 point_at(std::size_t k) {
  return gauss_point * Vec3((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
}

// B_a = C^T sum_m S_m,a dS_m, one a column.
Eigen::Matrix<double, 3, 8> corner_gradients(const Mat3& C, const MonomialGradients& dS) {
  Eigen::Matrix<double, 3, 8> B;
  for (int a = 0; a < 8; ++a) {
    Vec3 sum = Vec3::Zero();
    for (int m = 0; m < n_hex_modes; ++m) sum += hex_mode_sign(m, a) * dS.col(m);
    B.col(a) = C.transpose() * sum;
  }
  return B;
}

}  // namespace

// omega^2 <= n/(rho V) (3 lambda+ + 2 mu) lambda_max(L), L_ab = sum_points V_point B_a . B_b. With
// corner displacements d of length 1 and the 3 x 8 matrices B of the points, the shear energy
// counts 2 mu sum V |d B^T|^2 <= 2 mu lambda_max(L); the volumetric one is lambda times the square
// of a map whose transpose takes numbers c of the points to sum_points c sqrt(V) I B, and |sum c
// sqrt(V) M B|^2 <= lambda_max(L) sum c^2 |M|^2 for any tensors M: 3 for M = I. In a deformation M
// = F^-T of the point, so that the growth is what stiffening.h bounds, at the worst point.
ElementConstants constants_hex8_full(const ElementInput& input) {
  using Element = ElementHex8Full;
  const HexModes X = position_modes(input.X);
  ElementConstants c;
  Mat8 L = Mat8::Zero();
  for (std::size_t k = 0; k < Element::n_points; ++k) {
    const MonomialGradients dS = monomial_gradients(point_at(k));
    Mat3 dX = Mat3::Zero();  // 8 dX/dxi
    for (int m = 0; m < n_hex_modes; ++m) dX += X[m] * dS.col(m).transpose();
    const double det = dX.col(0).dot(dX.col(1).cross(dX.col(2)));
    if (!(det > 0)) return {};
    Mat3 C;
    for (int j = 0; j < 3; ++j) C.row(j) = dX.col((j + 1) % 3).cross(dX.col((j + 2) % 3)) / det;
    const double volume = det / 512;  // each Gauss weight is 1
    double* const value = c.value.data() + k * Element::values_of_point;
    for (int j = 0; j < 9; ++j) value[j] = C(j / 3, j % 3);
    value[Element::value_share] = volume;
    c.volume += volume;
    const Eigen::Matrix<double, 3, 8> B = corner_gradients(C, dS);
    L += volume * B.transpose() * B;
  }
  for (std::size_t k = 0; k < Element::n_points; ++k)
    c.value[k * Element::values_of_point + Element::value_share] /= c.volume;
  c.omega2 = 8 / (input.density * c.volume) * (3 * std::max(input.lambda, 0.0) + 2 * input.mu) *
             largest_eigenvalue_bound(L);
  return c;
}

}  // namespace trocar
