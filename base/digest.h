// 64-bit digests whose sums are free of any order, for state that is spread over ranks, and CRC32C
// for storage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace trocar {

// Mixes 64 bits so that each bit of the input changes half of the output (splitmix64 finaliser).
std::uint64_t mix64(std::uint64_t bits);
// Digest of an item with a number and a few values. Sums of these modulo 2^64 do not depend on any
// order.
std::uint64_t digest_item(std::uint64_t id, std::span<const double> values);
std::uint64_t digest_item(std::uint64_t id, std::span<const std::int32_t> values);
// 16 hexadecimal digits.
std::string digest_text(std::uint64_t digest);
// CRC32C (Castagnoli) of bytes, continuing from `crc`.
std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t crc = 0);

}  // namespace trocar
