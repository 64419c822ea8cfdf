#include "base/digest.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>
#include <random>
#include <vector>

namespace trocar {
namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

// One bit at a time, from the polynomial 0x1edc6f41 reflected (RFC 3720).
std::uint32_t crc32c_by_bits(const std::vector<std::byte>& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const std::byte byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) ? 0x82f63b78 : 0);
  }
  return ~crc;
}

TEST(Crc32c, has_the_published_check_value) {
  EXPECT_EQ(crc32c(bytes_of("123456789")), 0xe3069283u);
}

TEST(Crc32c, has_the_values_of_rfc_3720) {
  EXPECT_EQ(crc32c(std::vector<std::byte>(32, std::byte{0})), 0x8a9136aau);
  EXPECT_EQ(crc32c(std::vector<std::byte>(32, std::byte{255})), 0x62a8ab43u);
}

TEST(Crc32c, equals_the_bitwise_one_for_every_length) {
  std::mt19937 random(1);
  for (std::size_t n = 0; n < 100; ++n) {
    std::vector<std::byte> bytes(n);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    EXPECT_EQ(crc32c(bytes), crc32c_by_bits(bytes));
  }
}

TEST(Crc32c, continues_from_a_part) {
  const std::vector<std::byte> bytes = bytes_of("the quick brown fox jumps over the dog");
  for (std::size_t n = 0; n <= bytes.size(); ++n) {
    const std::span<const std::byte> all(bytes);
    EXPECT_EQ(crc32c(all.subspan(n), crc32c(all.first(n))), crc32c(all));
  }
}

TEST(Mix64, is_the_published_splitmix64) {
  // First outputs of splitmix64 with seed 1234567, from the reference implementation by S. Vigna.
  const std::uint64_t gamma = 0x9e3779b97f4a7c15;
  EXPECT_EQ(mix64(1234567 + gamma), 6457827717110365317u);
  EXPECT_EQ(mix64(1234567 + 2 * gamma), 3203168211198807973u);
}

TEST(Mix64, changes_half_of_the_bits_for_each_bit) {
  for (int bit = 0; bit < 64; ++bit) {
    int n_changed = 0;
    for (std::uint64_t i = 1; i <= 256; ++i)
      n_changed += std::popcount(mix64(i) ^ mix64(i ^ (std::uint64_t{1} << bit)));
    // 256 * 64 fair coins: mean 32, standard deviation of the mean 4 / 16.
    EXPECT_NEAR(n_changed / 256.0, 32.0, 6 * 0.25);
  }
}

TEST(DigestItem, tells_numbers_values_and_their_order_apart) {
  const std::array<double, 2> ab{1, 2};
  const std::array<double, 2> ba{2, 1};
  const std::array<double, 2> negative_zero{-0.0, 0};
  const std::array<double, 2> zero{0, 0};
  EXPECT_NE(digest_item(1, ab), digest_item(1, ba));
  EXPECT_NE(digest_item(1, ab), digest_item(2, ab));
  EXPECT_NE(digest_item(1, zero), digest_item(1, negative_zero));
  EXPECT_NE(digest_item(0, std::span(zero).first(1)), digest_item(0, zero));
}

TEST(DigestItem, is_not_zero_for_zeros) {
  const std::array<double, 1> number{0};
  const std::array<std::int32_t, 1> integer{0};
  EXPECT_NE(digest_item(0, number), 0u);
  EXPECT_NE(digest_item(0, integer), 0u);
}

TEST(DigestItem, tells_integers_apart) {
  const std::array<std::int32_t, 3> cell{1, 2, 3};
  const std::array<std::int32_t, 3> turned{2, 3, 1};
  const std::array<std::int32_t, 3> negative{-1, 2, 3};
  EXPECT_NE(digest_item(9, cell), digest_item(9, turned));
  EXPECT_NE(digest_item(9, cell), digest_item(9, negative));
}

TEST(DigestText, is_16_hexadecimal_digits) {
  EXPECT_EQ(digest_text(0), "0000000000000000");
  EXPECT_EQ(digest_text(0x0123456789abcdef), "0123456789abcdef");
}

}  // namespace
}  // namespace trocar
