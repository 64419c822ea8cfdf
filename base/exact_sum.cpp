#include "base/exact_sum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace trocar {

namespace {

constexpr int lowest_bit = -160;  // weight of bit 0 of limb 0 is 2^lowest_bit
constexpr std::uint64_t low_half = 0xffffffffu;

}  // namespace

void ExactSum::add(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto exponent = static_cast<int>(bits >> 52 & 0x7ff);
  if (exponent == 0) return;  // too small to count
  if (exponent == 0x7ff) {
    ++limbs_[n_limbs];
    return;
  }
  std::uint64_t mantissa = (bits & 0xfffffffffffff) | 0x10000000000000;
  int bit = exponent - 1075 - lowest_bit;  // |value| = mantissa * 2^(exponent - 1075)
  if (bit < 0) {
    if (bit <= -64) return;
    mantissa >>= -bit;
    bit = 0;
  }
  const auto limb = static_cast<std::size_t>(bit / 32);
  if (limb + 2 >= n_limbs) {
    ++limbs_[n_limbs];
    return;
  }
  const int shift = bit % 32;
  const std::uint64_t low = mantissa << shift;
  const std::uint64_t high = shift == 0 ? 0 : mantissa >> (64 - shift);
  const std::array<std::uint64_t, 3> parts = {low & low_half, low >> 32, high};
  for (std::size_t k = 0; k < parts.size(); ++k)
    limbs_[limb + k] += value > 0 ? parts[k] : std::uint64_t{0} - parts[k];
}

double ExactSum::value() const {
  if (limbs_[n_limbs] != 0) return std::numeric_limits<double>::infinity();
  // Carry upward; each word is a signed number of at most 63 bits.
  std::array<std::int64_t, n_limbs> digit{};
  std::int64_t carry = 0;
  for (std::size_t k = 0; k < n_limbs; ++k) {
    const std::int64_t sum = static_cast<std::int64_t>(limbs_[k]) + carry;
    const bool is_top = k + 1 == n_limbs;
    digit[k] = is_top ? sum : static_cast<std::int64_t>(static_cast<std::uint64_t>(sum) & low_half);
    carry = sum >> 32;
  }
  const bool is_negative = digit.back() < 0;
  if (is_negative) {  // two's complement: magnitude = ~x + 1
    std::int64_t borrow = 1;
    for (std::size_t k = 0; k < digit.size(); ++k) {
      const bool is_top = k + 1 == digit.size();
      const std::int64_t flipped =
          is_top ? ~digit[k] + borrow : static_cast<std::int64_t>(low_half) - digit[k] + borrow;
      borrow = is_top ? 0 : flipped >> 32;
      digit[k] = is_top ? flipped
                        : static_cast<std::int64_t>(static_cast<std::uint64_t>(flipped) & low_half);
    }
  }
  double total = 0;
  for (std::size_t k = digit.size(); k-- > 0;)
    total += std::ldexp(static_cast<double>(digit[k]), lowest_bit + 32 * static_cast<int>(k));
  return is_negative ? -total : total;
}

void ExactSum::all_sum(std::span<ExactSum> sums, const Communicator& communicator) {
  std::vector<std::uint64_t> all;
  for (const ExactSum& sum : sums) all.insert(all.end(), sum.limbs_.begin(), sum.limbs_.end());
  communicator.all_sum(all);
  auto from = all.begin();
  for (ExactSum& sum : sums) {
    std::copy_n(from, sum.limbs_.size(), sum.limbs_.begin());
    from += static_cast<std::ptrdiff_t>(sum.limbs_.size());
  }
}

double sum_over_ranks(std::span<const double> values, const Communicator& communicator) {
  ExactSum sum;
  sum.add(values);
  sum.all_sum(communicator);
  return sum.value();
}

std::vector<Vec3> sum_over_ranks(std::span<const ExactSum3> sums,
                                 const Communicator& communicator) {
  std::vector<ExactSum> all;
  for (const ExactSum3& sum : sums) all.insert(all.end(), sum.begin(), sum.end());
  if (!all.empty()) ExactSum::all_sum(all, communicator);
  std::vector<Vec3> values;
  for (std::size_t k = 0; k < all.size(); k += 3)
    values.emplace_back(all[k].value(), all[k + 1].value(), all[k + 2].value());
  return values;
}

}  // namespace trocar
