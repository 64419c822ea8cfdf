// Changes of bytes that a fuzzer's own, bit by bit, seldom come to.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "fuzz_targets.h"

namespace trocar {

namespace {

constexpr std::array<std::uint64_t, 12> hostile_counts = {0,
                                                          1,
                                                          ~std::uint64_t{0},
                                                          0x7fffffff,
                                                          0x80000000,
                                                          0xffffffff,
                                                          std::uint64_t{1} << 32,
                                                          std::uint64_t{1} << 61,
                                                          (std::uint64_t{1} << 61) + 1,
                                                          (std::uint64_t{1} << 63) - 1,
                                                          std::uint64_t{1} << 63,
                                                          std::uint64_t{0x5555555555555556}};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// The next choice of n, from what is left of `random`.
std::size_t choice(std::uint64_t& random, std::size_t n) {
  const std::size_t k = random % n;
  random /= n;
  return k;
}

// The first run of digits behind `at`, from the front again if there is none.
std::string with_other_decimal(const std::string& bytes, std::size_t at, std::uint64_t count) {
  auto first = std::find_if(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), is_digit);
  if (first == bytes.end()) first = std::find_if(bytes.begin(), bytes.end(), is_digit);
  const auto last = std::find_if_not(first, bytes.end(), is_digit);
  const auto number = static_cast<std::int64_t>(count);
  return std::string(bytes.begin(), first) + (number == -1 ? "-1" : std::to_string(count)) +
         std::string(last, bytes.end());
}

}  // namespace

std::string with_hostile_count(std::string bytes, std::uint64_t random) {
  if (bytes.empty()) return bytes;
  const std::uint64_t count = hostile_counts[choice(random, hostile_counts.size())];
  const std::size_t way = choice(random, 4), at = choice(random, bytes.size());
  if (way < 2) return with_other_decimal(bytes, at, count);
  std::array<char, sizeof count> stored{};
  std::memcpy(stored.data(), &count, sizeof count);
  const std::size_t width = choice(random, 2) == 0 ? 4 : 8;
  static_assert(std::endian::native == std::endian::little);
  if (way == 3) std::reverse(stored.begin(), stored.begin() + static_cast<std::ptrdiff_t>(width));
  const std::size_t n = std::min(width, bytes.size() - at);
  std::memcpy(bytes.data() + at, stored.data(), n);
  return bytes;
}

}  // namespace trocar
