#include "engine/blob.h"

#include <zstd.h>

#include "base/check.h"
#include "base/digest.h"
#include "base/error.h"

namespace trocar {

namespace {

constexpr int zstd_level = 1;
// A block of zstd has at least 4 bytes and unpacks to at most 128 KiB: more is announced by a
// damaged or hostile file only.
constexpr std::uint64_t largest_ratio = (128 << 10) / 4;

std::vector<std::byte> shuffle(std::span<const std::byte> plain, std::size_t item_size) {
  const std::size_t n = plain.size() / item_size;
  std::vector<std::byte> out(plain.begin(), plain.end());
  for (std::size_t b = 0; b < item_size; ++b)
    for (std::size_t i = 0; i < n; ++i) out[b * n + i] = plain[i * item_size + b];
  return out;
}

std::vector<std::byte> unshuffle(std::span<const std::byte> mixed, std::size_t item_size) {
  const std::size_t n = mixed.size() / item_size;
  std::vector<std::byte> out(mixed.begin(), mixed.end());
  for (std::size_t b = 0; b < item_size; ++b)
    for (std::size_t i = 0; i < n; ++i) out[i * item_size + b] = mixed[b * n + i];
  return out;
}

}  // namespace

Blob pack_blob(std::span<const std::byte> plain, std::size_t item_size) {
  CHECK_OP(plain.size() % item_size, ==, 0u);
  const std::vector<std::byte> mixed = shuffle(plain, item_size);
  Blob blob{.plain_size = plain.size(), .crc = crc32c(plain)};
  blob.packed.resize(ZSTD_compressBound(mixed.size()));
  const std::size_t size =
      ZSTD_compress(blob.packed.data(), blob.packed.size(), mixed.data(), mixed.size(), zstd_level);
  CHECK(!ZSTD_isError(size));
  blob.packed.resize(size);
  return blob;
}

std::vector<std::byte> unpack_blob(const Blob& blob, std::size_t item_size,
                                   const std::string& name) {
  const auto announced = ZSTD_getFrameContentSize(blob.packed.data(), blob.packed.size());
  if (announced != blob.plain_size || blob.plain_size / largest_ratio > blob.packed.size() ||
      blob.plain_size % item_size != 0)
    throw InputError(name + ": damaged (its size does not match)");
  std::vector<std::byte> mixed(blob.plain_size);
  const std::size_t size =
      ZSTD_decompress(mixed.data(), mixed.size(), blob.packed.data(), blob.packed.size());
  if (ZSTD_isError(size) || size != mixed.size())
    throw InputError(name + ": damaged (it does not unpack)");
  std::vector<std::byte> plain = unshuffle(mixed, item_size);
  if (crc32c(plain) != blob.crc) throw InputError(name + ": damaged (its checksum does not match)");
  return plain;
}

}  // namespace trocar
