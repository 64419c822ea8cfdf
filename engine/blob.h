// Packed bytes of a recording: doubles are shuffled (all first bytes, all second bytes, …) so that
// zstd finds what neighbours share; a CRC32C of the plain bytes finds every flipped bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace trocar {

struct Blob {
  std::vector<std::byte> packed;
  std::uint64_t plain_size = 0;
  std::uint32_t crc = 0;
};

// item_size: of the items whose bytes are shuffled, 1 for none.
Blob pack_blob(std::span<const std::byte> plain, std::size_t item_size);
// Throws InputError "<name>: …" if the bytes can't be unpacked or the checksum does not match.
std::vector<std::byte> unpack_blob(const Blob& blob, std::size_t item_size,
                                   const std::string& name);

}  // namespace trocar
