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

// To where an ExactSum holds all bits of sums of products up to `most`, which it would cut off
// where they are small: they depend on who has summed what. In whole limbs, which changes no bits.
int exponent_to_hold(double most) {
  constexpr int limb = 32;
  return limb * static_cast<int>(std::lround(-std::ilogb(most) / double{limb}));
}

struct Quanta {
  double coarse = 0, fine = 0;
  int exponent = 0;  // of 2, by which sums are scaled
};

void add_products(std::span<const double> a, std::span<const double> b, const Quanta& quanta,
                  Total& total) {
  const double coarse = quanta.coarse, fine = quanta.fine;
  Lanes sum{}, rest_sum{};
  for_products(a, b, [&](const Pair& product, std::size_t i) {
    const Pair rounded = (product + coarse) - coarse;
    sum[i] += rounded;
    rest_sum[i] += ((product - rounded) + fine) - fine;
  });
  const std::scoped_lock lock(total.mutex);
  for (std::size_t i = 0; i < n_lanes; ++i) {
    total.sum.add(std::ldexp(sum[i / 2][i % 2], quanta.exponent));
    total.sum.add(std::ldexp(rest_sum[i / 2][i % 2], quanta.exponent));
  }
}

}  // namespace

double largest_size(std::span<const double> x) {
  const Pair sign = {-0.0, -0.0};
  Lanes largest{}, poison{};
  const auto take = [&](const Pair& pair, std::size_t i) {
    largest[i] = _mm_max_pd(largest[i], _mm_andnot_pd(sign, pair));
    poison[i] += pair - pair;
  };
  std::size_t k = 0;
  for (; k + n_lanes <= x.size(); k += n_lanes)
    for (std::size_t i = 0; i < n_pairs; ++i) take(_mm_loadu_pd(&x[k + 2 * i]), i);
  for (; k < x.size(); ++k) take(Pair{x[k], 0}, 0);
  double most = 0, sum = 0;
  for (std::size_t i = 0; i < n_lanes; ++i) {
    most = std::max(most, largest[i / 2][i % 2]);
    sum += poison[i / 2][i % 2];
  }
  return most + sum;
}

double reproducible_dot(std::span<const double> a, std::span<const double> b, std::int64_t n,
                        double most, const Communicator& communicator) {
  CHECK_OP(a.size(), ==, b.size());
  if (!std::isfinite(static_cast<double>(n) * most))
    return std::numeric_limits<double>::quiet_NaN();
  if (most == 0) return 0;
  const double coarse = rounder(n, most);
  const Quanta quanta{
      .coarse = coarse, .fine = rounder(n, coarse * 0x1p-52), .exponent = exponent_to_hold(most)};
  Total total;
  parallel_for(std::ssize(a), [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<std::size_t>(begin),
               n_here = static_cast<std::size_t>(end) - first;
    add_products(a.subspan(first, n_here), b.subspan(first, n_here), quanta, total);
  });
  total.sum.all_sum(communicator);
  return std::ldexp(total.sum.value(), -quanta.exponent);
}

}  // namespace trocar
