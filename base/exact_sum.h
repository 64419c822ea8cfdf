// A sum of doubles that does not depend on their order or on how they are spread over ranks:
// fixed-point accumulation in 320 bits. Bits below 2^-160 are cut off, so that doubles from 2^-108
// on are exact; with one of 2^148 or more, or an infinite one, the sum is infinite.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/communicator.h"
#include "base/vec.h"

namespace trocar {

class ExactSum {
 public:
  void add(double value);
  void add(std::span<const double> values) {
    for (const double value : values) add(value);
  }
  // Adds every rank's sum to all. Collective.
  void all_sum(const Communicator& communicator) { communicator.all_sum(limbs_); }
  static void all_sum(std::span<ExactSum> sums, const Communicator& communicator);
  double value() const;

 private:
  // 32 bits a limb in 64-bit words, least significant first, two's complement per addend: 2^31
  // addends fit without overflow.
  // The last word counts addends that were too large.
  static constexpr std::size_t n_limbs = 10;
  std::array<std::uint64_t, n_limbs + 1> limbs_{};
};

inline double exact_sum(std::span<const double> values) {
  ExactSum sum;
  sum.add(values);
  return sum.value();
}

// Of all ranks' values. Collective.
double sum_over_ranks(std::span<const double> values, const Communicator& communicator);

// One for each component of a vector.
using ExactSum3 = std::array<ExactSum, 3>;

inline void add(const Vec3& value, ExactSum3& sum) {
  for (int i = 0; i < 3; ++i) sum[i].add(value[i]);
}
// Of each, that of all ranks, in one message for all. Collective.
std::vector<Vec3> sum_over_ranks(std::span<const ExactSum3> sums, const Communicator& communicator);

}  // namespace trocar
