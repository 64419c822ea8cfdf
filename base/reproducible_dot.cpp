#include "base/reproducible_dot.h"

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/check.h"
#include "base/exact_sum.h"
#include "base/threads.h"

namespace trocar {

namespace {

// Sums side by side, in registers that every machine has.
using Pair = double __attribute__((vector_size(16)));
constexpr std::size_t n_pairs = 4, n_lanes = 2 * n_pairs;
using Lanes = std::array<Pair, n_pairs>;

Pair product_of(const double* a, const double* b) {
  Pair x, y;
  __builtin_memcpy(&x, a, sizeof x);
  __builtin_memcpy(&y, b, sizeof y);
  return x * y;
}

// take(products, lane) for all products, side by side; zeros behind the last one.
template <class Take>
void for_products(std::span<const double> a, std::span<const double> b, const Take& take) {
  std::size_t k = 0;
  for (; k + n_lanes <= a.size(); k += n_lanes)
    for (std::size_t i = 0; i < n_pairs; ++i) take(product_of(&a[k + 2 * i], &b[k + 2 * i]), i);
  for (; k < a.size(); ++k) take(Pair{a[k] * b[k], 0}, 0);
}

// Of the products' sizes; NaN if one is not finite.
double largest_product(std::span<const double> a, std::span<const double> b) {
  const Pair sign = {-0.0, -0.0};
  Lanes largest{}, poison{};
  for_products(a, b, [&](const Pair& product, std::size_t i) {
    largest[i] = _mm_max_pd(largest[i], _mm_andnot_pd(sign, product));
    poison[i] += product - product;
  });
  double most = 0, sum = 0;
  for (std::size_t i = 0; i < n_lanes; ++i) {
    most = std::max(most, largest[i / 2][i % 2]);
    sum += poison[i / 2][i % 2];
  }
  return most + sum;
}

// 1.5 * 2^m, the least for which n values up to `size` sum exactly once they have been added to it
// and it has been taken away again: that rounds them to multiples of 2^(m - 52).
double rounder(std::int64_t n, double size) {
  const int m = std::ilogb(static_cast<double>(n) * size) + 2;
  return std::ldexp(1.5, m);
}

// A sum that several threads add to.
struct Total {
  ExactSum sum;
  std::mutex mutex;
};

void add_products(std::span<const double> a, std::span<const double> b, double coarse, double fine,
                  Total& total) {
  Lanes sum{}, rest_sum{};
  for_products(a, b, [&](const Pair& product, std::size_t i) {
    const Pair rounded = (product + coarse) - coarse;
    sum[i] += rounded;
    rest_sum[i] += ((product - rounded) + fine) - fine;
  });
  const std::scoped_lock lock(total.mutex);
  for (std::size_t i = 0; i < n_lanes; ++i) {
    total.sum.add(sum[i / 2][i % 2]);
    total.sum.add(rest_sum[i / 2][i % 2]);
  }
}

// Calls body(part of a, part of b) on all threads.
template <class Body>
void for_parts(std::span<const double> a, std::span<const double> b, const Body& body) {
  parallel_for(std::ssize(a), [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<std::size_t>(begin), n = static_cast<std::size_t>(end - begin);
    body(a.subspan(first, n), b.subspan(first, n));
  });
}

double largest_product_of_threads(std::span<const double> a, std::span<const double> b) {
  std::mutex mutex;
  double most = 0;
  for_parts(a, b, [&](auto part_a, auto part_b) {
    const double mine = largest_product(part_a, part_b);
    const std::scoped_lock lock(mutex);
    most = mine > most || std::isnan(mine) ? mine : most;
  });
  return most;
}

}  // namespace

double reproducible_dot(std::span<const double> a, std::span<const double> b, std::int64_t n,
                        const Communicator& communicator) {
  CHECK_OP(a.size(), ==, b.size());
  const double largest = communicator.all_max(largest_product_of_threads(a, b));
  if (!std::isfinite(largest)) return std::numeric_limits<double>::quiet_NaN();
  if (largest == 0) return 0;
  const double coarse = rounder(n, largest);
  const double fine = rounder(n, coarse * 0x1p-52);
  Total total;
  for_parts(a, b,
            [&](auto part_a, auto part_b) { add_products(part_a, part_b, coarse, fine, total); });
  total.sum.all_sum(communicator);
  return total.sum.value();
}

}  // namespace trocar
