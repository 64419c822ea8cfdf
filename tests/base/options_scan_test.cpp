#include <gtest/gtest.h>

#include <random>

#include "base/options_node.h"
#include "base_scene_options.h"

namespace trocar {
namespace {

bool is_accepted(const std::string& text) {
  try {
    check_characters(text);
  } catch (const SyntaxTrouble&) {
    return false;
  }
  return true;
}

// The four forms of RFC 3629, whatever the code point.
std::string encoded(std::uint32_t code) {
  const auto tail = [&](int shift) { return static_cast<char>(0x80 | ((code >> shift) & 0x3f)); };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xc0 | (code >> 6)), tail(0)};
  if (code < 0x10000) return {static_cast<char>(0xe0 | (code >> 12)), tail(6), tail(0)};
  return {static_cast<char>(0xf0 | (code >> 18)), tail(12), tail(6), tail(0)};
}

TEST(CheckCharacters, accepts_every_code_point_but_nul_and_surrogates) {
  for (std::uint32_t code = 0; code < 0x120000; ++code) {
    const bool is_surrogate = code >= 0xd800 && code < 0xe000;
    const bool is_character = code > 0 && code < 0x110000 && !is_surrogate;
    ASSERT_EQ(is_accepted(encoded(code)), is_character) << code;
  }
}

TEST(CheckCharacters, accepts_no_other_bytes) {
  // Two and three bytes each: of all 2^16 and 2^24 (a random part), only concatenations of
  // encodings pass.
  std::mt19937 random(2);
  for (int i = 0; i < 200'000; ++i) {
    std::string bytes(2 + random() % 3, '\0');
    for (char& c : bytes) c = static_cast<char>(1 + random() % 255);
    bool is_encoding = true;
    for (std::size_t at = 0; at < bytes.size() && is_encoding;) {
      const auto first = static_cast<unsigned char>(bytes[at]);
      const std::size_t n = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
      std::uint32_t code = first & (n == 1 ? 0x7fu : 0xffu >> (n + 1));
      for (std::size_t k = 1; k < n && at + k < bytes.size(); ++k)
        code = (code << 6) | (static_cast<unsigned char>(bytes[at + k]) & 0x3fu);
      const bool is_surrogate = code >= 0xd800 && code < 0xe000;
      is_encoding = code < 0x110000 && !is_surrogate && encoded(code) == bytes.substr(at, n);
      at += n;
    }
    ASSERT_EQ(is_accepted(bytes), is_encoding) << i;
  }
}

TEST(ScanToml, finds_the_line_and_the_column_in_characters) {
  try {
    scan_toml("a = 1\nb = 'ü' 'open");
    FAIL();
  } catch (const SyntaxTrouble& trouble) {
    EXPECT_EQ(trouble.line, 2);
    EXPECT_EQ(trouble.column, 9);
  }
}

TEST(ReadOptions, of_a_text_changed_at_random_reads_or_refuses_it) {
  const std::string good =
      "name = \"incision\"\nduration = \"4 s\"\ngravity = ['0 mm/s^2', 1, -9.81]\n[tissue]\n"
      "mesh = '''liver.msh'''\nmaterial = { young_modulus = \"5 kPa\", law = \"linear\" }\n"
      "[camera]\nsize = [1280, 720] # pixels\n[[instrument]]\npath = [{ time = 1 }]\n";
  const std::string alphabet = "\"'[]{}=.,#\\\n\t 019eEmsx-+\x7f\xc3\xbc";
  std::mt19937 random(7);
  int n_read = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string text = good;
    for (std::size_t k = random() % 4; k > 0; --k) {
      const std::size_t at = random() % text.size();
      const std::size_t n_cut = random() % 3;
      text.replace(at, n_cut, 1, alphabet[random() % alphabet.size()]);
    }
    const std::string error = scene_error(text);  // anything but InputError ends the test
    ASSERT_TRUE(error.empty() || error.rfind("s.toml:", 0) == 0) << error;
    if (error.empty()) ++n_read;
  }
  // A quarter is unchanged, so that both sides are exercised.
  EXPECT_GT(n_read, 1000);
  EXPECT_LT(n_read, 4500);
}

}  // namespace
}  // namespace trocar
