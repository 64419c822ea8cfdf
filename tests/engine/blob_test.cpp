#include "engine/blob.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/digest.h"
#include "base/error.h"
#include "error_of.h"

namespace trocar {
namespace {

std::vector<std::byte> pattern(std::size_t n) {
  std::vector<std::byte> bytes(n);
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::byte>(mix64(i) >> (i % 5));
  return bytes;
}

std::vector<double> smooth_field(std::size_t n) {
  std::vector<double> field(n);
  for (std::size_t i = 0; i < n; ++i) field[i] = 1e-3 * std::sin(1e-3 * static_cast<double>(i));
  return field;
}

TEST(Blob, unpacks_to_the_bytes_that_were_packed) {
  for (const std::size_t item_size : {1u, 4u, 8u})
    for (const std::size_t n_items : {0u, 1u, 2u, 7u, 1000u, 40000u}) {
      const std::vector<std::byte> plain = pattern(n_items * item_size);
      EXPECT_EQ(unpack_blob(pack_blob(plain, item_size), item_size, "b"), plain)
          << n_items << " items of " << item_size;
    }
}

TEST(Blob, of_equal_bytes_is_equal) {
  const std::vector<std::byte> plain = pattern(5000);
  EXPECT_EQ(pack_blob(plain, 8).packed, pack_blob(std::vector(plain), 8).packed);
}

TEST(Blob, of_a_smooth_field_is_smaller_when_shuffled) {
  const std::vector<double> field = smooth_field(10000);
  const auto plain = std::as_bytes(std::span(field));
  EXPECT_LT(pack_blob(plain, sizeof(double)).packed.size(), pack_blob(plain, 1).packed.size());
}

TEST(Blob, of_highly_compressible_bytes_is_not_taken_for_a_hostile_one) {
  const std::vector<std::byte> plain(std::size_t{64} << 20, std::byte{0});
  EXPECT_EQ(unpack_blob(pack_blob(plain, 1), 1, "zeros").size(), plain.size());
}

TEST(Blob, with_any_bit_changed_unpacks_to_the_same_or_is_refused) {
  const std::vector<double> field = smooth_field(100);
  const auto plain = std::as_bytes(std::span(field));
  const Blob sound = pack_blob(plain, sizeof(double));
  int n_refused = 0;
  for (std::size_t bit = 0; bit < 8 * sound.packed.size(); ++bit) {
    Blob blob = sound;
    blob.packed[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    try {
      const std::vector<std::byte> bytes = unpack_blob(blob, sizeof(double), "b");
      EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), plain.begin(), plain.end())) << bit;
    } catch (const InputError&) {
      ++n_refused;
    }
  }
  EXPECT_GT(n_refused, static_cast<int>(7 * sound.packed.size()));  // zstd leaves few bits unused
}

TEST(Blob, with_another_size_or_checksum_is_refused_by_name) {
  const Blob sound = pack_blob(pattern(800), 8);
  for (int bit = 0; bit < 64; ++bit) {
    Blob blob = sound;
    blob.plain_size ^= std::uint64_t{1} << bit;
    EXPECT_TRUE(contains(error_of([&] { unpack_blob(blob, 8, "frame 17"); }), "frame 17: damaged"));
  }
  for (int bit = 0; bit < 32; ++bit) {
    Blob blob = sound;
    blob.crc ^= std::uint32_t{1} << bit;
    EXPECT_TRUE(contains(error_of([&] { unpack_blob(blob, 8, "frame 17"); }), "checksum"));
  }
}

TEST(Blob, cut_off_anywhere_is_refused) {
  const Blob sound = pack_blob(pattern(300), 1);
  for (std::size_t n = 0; n < sound.packed.size(); ++n) {
    Blob blob = sound;
    blob.packed.resize(n);
    EXPECT_THROW(unpack_blob(blob, 1, "b"), InputError) << n;
  }
}

// A zstd frame header that announces 1 TiB (RFC 8878: magic number, 8-byte content size, single
// segment) and brings one raw block of one byte.
TEST(Blob, that_announces_more_than_it_can_hold_is_refused_before_memory_is_asked_for) {
  const std::uint64_t size = std::uint64_t{1} << 40;
  Blob blob{.plain_size = size};
  const std::vector<unsigned> head = {0x28, 0xb5, 0x2f, 0xfd, 0xe0};
  for (const unsigned value : head) blob.packed.push_back(static_cast<std::byte>(value));
  for (int k = 0; k < 8; ++k) blob.packed.push_back(static_cast<std::byte>(size >> (8 * k)));
  for (const unsigned value : {0x09u, 0x00u, 0x00u, 0x42u})
    blob.packed.push_back(static_cast<std::byte>(value));
  EXPECT_TRUE(contains(error_of([&] { unpack_blob(blob, 1, "b"); }), "size does not match"));
}

}  // namespace
}  // namespace trocar
