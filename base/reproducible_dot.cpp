#include "base/reproducible_dot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/exact_sum.h"

namespace trocar {

namespace {

constexpr std::size_t n_lanes = 4;  // sums side by side, so that the loops become vector loops
using Lanes = std::array<double, n_lanes>;

// take(product, lane) for all products, side by side.
template <class Take>
void for_products(std::span<const double> a, std::span<const double> b, const Take& take) {
  std::size_t k = 0;
  for (; k + n_lanes <= a.size(); k += n_lanes)
    for (std::size_t i = 0; i < n_lanes; ++i) take(a[k + i] * b[k + i], i);
  for (; k < a.size(); ++k) take(a[k] * b[k], 0);
}

// Of the products' sizes; NaN if one is not finite.
double largest_product(std::span<const double> a, std::span<const double> b) {
  Lanes largest{}, poison{};
  for_products(a, b, [&](double product, std::size_t i) {
    largest[i] = std::max(largest[i], std::abs(product));
    poison[i] += product - product;
  });
  return std::ranges::max(largest) + poison[0] + poison[1] + poison[2] + poison[3];
}

// 1.5 * 2^m, the least for which n values up to `size` sum exactly once they have been added to it
// and it has been taken away again: that rounds them to multiples of 2^(m - 52).
double rounder(std::int64_t n, double size) {
  const int m = std::ilogb(static_cast<double>(n) * size) + 2;
  return std::ldexp(1.5, m);
}

}  // namespace

double reproducible_dot(std::span<const double> a, std::span<const double> b, std::int64_t n,
                        const Communicator& communicator) {
  CHECK_OP(a.size(), ==, b.size());
  const double largest = communicator.all_max(largest_product(a, b));
  if (!std::isfinite(largest)) return std::numeric_limits<double>::quiet_NaN();
  if (largest == 0) return 0;
  const double coarse = rounder(n, largest);
  const double fine = rounder(n, coarse * 0x1p-52);
  Lanes sum{}, rest_sum{};
  for_products(a, b, [&](double product, std::size_t i) {
    const double rounded = (product + coarse) - coarse;
    sum[i] += rounded;
    rest_sum[i] += ((product - rounded) + fine) - fine;
  });
  ExactSum total;
  for (std::size_t i = 0; i < n_lanes; ++i) {
    total.add(sum[i]);
    total.add(rest_sum[i]);
  }
  total.all_sum(communicator);
  return total.value();
}

}  // namespace trocar
