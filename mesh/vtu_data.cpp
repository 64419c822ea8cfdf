// Base64 and zlib for VTU files.
#include "mesh/vtu_data.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/check.h"

namespace trocar {

namespace {

constexpr std::string_view base64_digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::int8_t base64_space = -1, base64_padding = -2, base64_wrong = -3;

constexpr std::array<std::int8_t, 256> make_base64_values() {
  std::array<std::int8_t, 256> value{};
  value.fill(base64_wrong);
  for (std::size_t k = 0; k < base64_digits.size(); ++k)
    value[static_cast<unsigned char>(base64_digits[k])] = static_cast<std::int8_t>(k);
  for (const char c : {' ', '\t', '\r', '\n'}) value[static_cast<unsigned char>(c)] = base64_space;
  value[static_cast<unsigned char>('=')] = base64_padding;
  return value;
}
constexpr std::array<std::int8_t, 256> base64_value = make_base64_values();

// The bytes that a text stands for, read front to back. Headers may be a base64 stream of their own
// with padding at its end: the next stream then follows at once.
class VtuBytes {
 public:
  VtuBytes(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}

  // Cannot be more than this.
  std::size_t most_left() const { return text_.size() - at_ + n_kept_; }

  // False if there are not so many.
  bool read(char* out, std::size_t n) {
    if (n > most_left()) return false;
    if (!is_base64_) {
      std::copy_n(text_.data() + at_, n, out);
      at_ += n;
      return true;
    }
    for (std::size_t k = 0; k < n; ++k) {
      if (n_kept_ == 0 && !fill()) return false;
      out[k] = kept_[n_given_++];
      --n_kept_;
    }
    return true;
  }

 private:
  // Decodes four digits into one to three bytes.
  bool fill() {
    std::uint32_t bits = 0;
    std::size_t n_digits = 0, n_padding = 0;
    while (n_digits + n_padding < 4) {
      if (at_ == text_.size()) return false;
      const std::int8_t value = base64_value[static_cast<unsigned char>(text_[at_++])];
      if (value == base64_space) continue;
      if (value == base64_wrong || (value >= 0 && n_padding > 0)) return false;
      bits = (bits << 6) | static_cast<std::uint32_t>(std::max<std::int8_t>(value, 0));
      ++(value >= 0 ? n_digits : n_padding);
    }
    if (n_digits < 2) return false;
    for (std::size_t k = 0; k < 3; ++k) kept_[k] = static_cast<char>(bits >> (16 - 8 * k) & 0xFF);
    n_given_ = 0;
    n_kept_ = n_digits - 1;
    return true;
  }

  std::string_view text_;
  bool is_base64_;
  std::size_t at_ = 0;
  std::array<char, 3> kept_{};
  std::size_t n_given_ = 0, n_kept_ = 0;
};

[[noreturn]] void fail_short(const FileReader& in) {
  in.fail("the data of this array are cut off or broken");
}

std::uint64_t read_header(const FileReader& in, const VtuEncoding& encoding, VtuBytes& bytes) {
  std::array<char, 8> word{};
  if (!bytes.read(word.data(), encoding.n_header_bytes)) fail_short(in);
  return encoding.n_header_bytes == 8
             ? FileReader::load_number<std::uint64_t>(word.data(), encoding.swaps_bytes)
             : FileReader::load_number<std::uint32_t>(word.data(), encoding.swaps_bytes);
}

void check_size(const FileReader& in, std::uint64_t found, std::size_t n_bytes) {
  if (found != n_bytes)
    in.fail("this array has " + std::to_string(found) + " bytes, but " + std::to_string(n_bytes) +
            " follow from the numbers of points and cells");
}

// Blocks of one size but for the last one, which may be smaller (0: it is not).
struct ZlibHeader {
  std::uint64_t block_bytes = 0;
  std::uint64_t last_bytes = 0;
  std::vector<std::uint64_t> packed_bytes;  // (n_blocks)
};

ZlibHeader read_zlib_header(const FileReader& in, const VtuEncoding& encoding, VtuBytes& bytes,
                            std::size_t n_bytes) {
  ZlibHeader header;
  const std::uint64_t n_blocks = read_header(in, encoding, bytes);
  header.block_bytes = read_header(in, encoding, bytes);
  header.last_bytes = read_header(in, encoding, bytes);
  if (n_blocks == 0) {
    check_size(in, 0, n_bytes);
    return header;
  }
  if (header.last_bytes == 0) header.last_bytes = header.block_bytes;
  if (n_blocks > bytes.most_left() / encoding.n_header_bytes) fail_short(in);
  // Whole blocks first, so that the product can't overflow.
  const std::uint64_t n_whole = n_blocks - 1;
  if (header.last_bytes > n_bytes || (n_whole > 0 && header.block_bytes > n_bytes / n_whole))
    in.fail("the blocks of this array have more bytes than the " + std::to_string(n_bytes) +
            " that follow from the numbers of points and cells");
  check_size(in, (n_whole > 0 ? n_whole * header.block_bytes : 0) + header.last_bytes, n_bytes);
  header.packed_bytes.resize(n_blocks);
  for (std::uint64_t& packed : header.packed_bytes) packed = read_header(in, encoding, bytes);
  return header;
}

std::string decode_zlib(const FileReader& in, const VtuEncoding& encoding, VtuBytes& bytes,
                        std::size_t n_bytes) {
  // zlib packs at most 1032 to 1; 64 to 1 leaves room for any mesh, but not for a file made to fill
  // the memory.
  constexpr std::size_t always_allowed = 1U << 24;
  if (n_bytes > always_allowed + 64 * in.n_bytes())
    in.fail("this array would unfold to " + std::to_string(n_bytes) +
            " bytes, more than 64 times the file");
  const ZlibHeader header = read_zlib_header(in, encoding, bytes, n_bytes);
  std::string data(n_bytes, '\0');
  std::string packed;
  std::size_t at = 0;
  for (std::size_t b = 0; b < header.packed_bytes.size(); ++b) {
    if (header.packed_bytes[b] > bytes.most_left()) fail_short(in);
    packed.resize(header.packed_bytes[b]);
    if (!bytes.read(packed.data(), packed.size())) fail_short(in);
    const bool is_last = b + 1 == header.packed_bytes.size();
    const std::uint64_t n_block = is_last ? header.last_bytes : header.block_bytes;
    uLongf n_unpacked = n_block;
    const int result = uncompress(reinterpret_cast<Bytef*>(data.data() + at), &n_unpacked,
                                  reinterpret_cast<const Bytef*>(packed.data()),
                                  static_cast<uLong>(packed.size()));
    if (result != Z_OK || n_unpacked != n_block) fail_short(in);
    at += n_block;
  }
  return data;
}

void append_base64(std::string_view bytes, std::string& text) {
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - k);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i)
      bits = (bits << 8) | (i < n ? static_cast<unsigned char>(bytes[k + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i)
      text += i <= n ? base64_digits[bits >> (18 - 6 * i) & 63] : '=';
  }
}

void append_word(std::uint64_t word, std::string& bytes) {
  std::array<char, 8> stored{};
  std::memcpy(stored.data(), &word, 8);
  bytes.append(stored.data(), 8);
}

}  // namespace

std::string decode_vtu_data(const FileReader& in, const VtuEncoding& encoding,
                            std::string_view text, std::size_t n_bytes) {
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (encoding.is_base64) text.remove_prefix(std::min(start, text.size()));
  if (text.empty() && n_bytes == 0) return {};
  VtuBytes bytes(text, encoding.is_base64);
  if (encoding.is_zlib) return decode_zlib(in, encoding, bytes, n_bytes);
  check_size(in, read_header(in, encoding, bytes), n_bytes);
  if (n_bytes > bytes.most_left()) fail_short(in);
  std::string data(n_bytes, '\0');
  if (!bytes.read(data.data(), n_bytes)) fail_short(in);
  return data;
}

void append_vtu_data(std::string_view bytes, std::string& text) {
  constexpr std::size_t block_bytes = 1U << 18;
  constexpr int fastest = 1;
  const std::size_t n_blocks = (bytes.size() + block_bytes - 1) / block_bytes;
  std::string header, packed_all, packed;
  append_word(n_blocks, header);
  append_word(block_bytes, header);
  append_word(bytes.size() % block_bytes, header);
  for (std::size_t b = 0; b < n_blocks; ++b) {
    const std::string_view block = bytes.substr(b * block_bytes, block_bytes);
    const auto n_block = static_cast<uLong>(block.size());
    uLongf n_packed = compressBound(n_block);
    packed.resize(n_packed);
    const int result = compress2(reinterpret_cast<Bytef*>(packed.data()), &n_packed,
                                 reinterpret_cast<const Bytef*>(block.data()), n_block, fastest);
    CHECK_OP(result, ==, Z_OK);
    append_word(n_packed, header);
    packed_all.append(packed.data(), n_packed);
  }
  append_base64(header, text);
  append_base64(packed_all, text);
}

}  // namespace trocar
