// Digests. The finaliser is that of splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom
// number generators, 2014); CRC32C is RFC 3720's, eight bytes at a time (Kounavis and Berry: Novel
// table lookup-based algorithms, 2008).
#include "base/digest.h"

#include <array>
#include <bit>

namespace trocar {

// Keeps item 0 with the value 0 from having the digest 0, which a sum would not see.
static constexpr std::uint64_t golden_gamma = 0x9e3779b97f4a7c15;

std::uint64_t mix64(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
  return bits ^ (bits >> 31);
}

std::uint64_t digest_item(std::uint64_t id, std::span<const double> values) {
  std::uint64_t digest = mix64(id + golden_gamma);
  for (const double value : values)
    digest = mix64((digest ^ std::bit_cast<std::uint64_t>(value)) + golden_gamma);
  return digest;
}

std::uint64_t digest_item(std::uint64_t id, std::span<const std::int32_t> values) {
  std::uint64_t digest = mix64(id + golden_gamma);
  for (const std::int32_t value : values)
    digest = mix64((digest ^ static_cast<std::uint32_t>(value)) + golden_gamma);
  return digest;
}

std::string digest_text(std::uint64_t digest) {
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; digest >>= 4) text[i] = "0123456789abcdef"[digest & 15];
  return text;
}

using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

// tables[k][b]: the remainder of byte b followed by k zero bytes.
static constexpr CrcTables make_crc_tables() {
  CrcTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0x82f63b78u : 0u);
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = tables[k - 1][byte];
      tables[k][byte] = (crc >> 8) ^ tables[0][crc & 255];
    }
  return tables;
}

static constexpr CrcTables crc_tables = make_crc_tables();

static std::uint32_t crc_eight_bytes(const std::byte* bytes, std::uint32_t crc) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(bytes[i]); };
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < 4; ++i)
    next ^= crc_tables[7 - i][(byte(i) ^ (crc >> (8 * i))) & 255] ^ crc_tables[3 - i][byte(i + 4)];
  return next;
}

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t crc) {
  crc = ~crc;
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) crc = crc_eight_bytes(bytes.data(), crc);
  for (const std::byte byte : bytes)
    crc = (crc >> 8) ^ crc_tables[0][(crc ^ static_cast<std::uint32_t>(byte)) & 255];
  return ~crc;
}

}  // namespace trocar
