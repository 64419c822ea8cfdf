// Pairs of nodes in the paper's combined mass-spring and particle system (Serby et al. 2001, eqs. 4
// to 6), in the plane and in space: forces over distance, and how a step follows from them.
#pragma once

#include <algorithm>
#include <cmath>

namespace trocar::pair_forces {

inline constexpr double gain = 0.25;  // explicit Euler step of the overdamped eq. 6, m = c = k = 1
inline constexpr double longest_step = 0.05;              // h
inline constexpr double cut_off_squared = 2.2 * 2.2;      // r0^2
inline constexpr double largest_rho = 1 / (0.55 * 0.55);  // r is clamped at 0.55 r0

// g_ij = (r - l) (x_j - x_i) / r, eq. 4 with k = 1: this times x_j - x_i, r > 0 long.
inline double spring(double scale, double r, double length) {
  return scale * (1 - length / r);
}

// rho^(k / 2) without libm's pow, whose bits differ between machines.
inline double half_power(double rho, int k) {
  double result = k % 2 == 0 ? 1 : std::sqrt(rho);
  for (k /= 2; k > 0; k /= 2, rho *= rho)
    if (k % 2 == 1) result *= rho;
  return result;
}

// Eq. 5 with A = r0^(m + 2) / (m (n - m)), B = r0^(n + 2) / (n (n - m)), so that phi'(r0) = 0 and
// phi''(r0) = 1: -phi'(r) / r = (rho^(n/2 + 1) - rho^(m/2 + 1)) / (n - m) with rho = r0^2 / r^2.
// This times x_i - x_j, whose square is r2.
struct LennardJones {
  int n = 12, m = 6;
  double scale = 1;  // of the force
  double operator()(double r2, double r0_squared) const {
    if (r2 > cut_off_squared * r0_squared) return 0;
    const double rho = std::min(r0_squared / r2, largest_rho);
    if (n == 12 && m == 6)  // the same bits in a third of the time
      return scale / 6 * ((rho * rho) * (rho * rho)) * (rho * (rho * rho) - 1);
    return scale / (n - m) * half_power(rho, m + 2) * (half_power(rho, n - m) - 1);
  }
};

}  // namespace trocar::pair_forces
