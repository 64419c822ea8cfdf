// Files that no friend would send: each is refused with a sentence, quickly and without much
// memory.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>

#include "base/heap.h"
#include "base/options.h"
#include "base_scene_options.h"
#include "error_of.h"
#include "test_files.h"

namespace trocar {
namespace {

// Under the sanitizers of addresses and threads the bounds on time and memory mean nothing.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool has_bounds = false;
#else
constexpr bool has_bounds = true;
#endif

class HostileFile : public testing::Test {
 protected:
  std::string write(const std::string& text) const { return folder_.file("s.toml", text); }

  TestFolder folder_;
};

std::string refusal_of(const std::string& file) {
  const std::clock_t start = std::clock();
  const std::string message = error_of([&] { read_options(scene_options(), file); });
  // At most 2 s; in time of the processor, which does not depend on what else the machine does.
  EXPECT_TRUE(!has_bounds || std::clock() - start < 2 * CLOCKS_PER_SEC) << message;
  EXPECT_LT(message.size(), 100'000u);
  return message;
}

std::string repeated(const std::string& text, int n) {
  std::string all;
  for (int i = 0; i < n; ++i) all += text;
  return all;
}

TEST_F(HostileFile, that_is_good_is_read) {
  const std::string file = write("[tissue]\nmesh = 'a'\n");
  const Located<Scene> scene = read_options(scene_options(), file);
  EXPECT_EQ(scene.value.tissue.mesh, "a");
  EXPECT_EQ(scene.where.find("tissue.mesh").file, file);
}

TEST_F(HostileFile, that_does_not_exist_is_named) {
  expect_part(refusal_of(folder_.file("none.toml")), "none.toml: there is no file of this name");
}

TEST_F(HostileFile, that_is_empty_is_refused) {
  expect_part(refusal_of(write("")), "is empty");
}

TEST_F(HostileFile, that_is_a_directory_is_refused) {
  expect_part(refusal_of(folder_.path()), "is a directory, not a file");
}

TEST_F(HostileFile, that_is_a_fifo_is_refused_without_waiting) {
  ASSERT_EQ(mkfifo(folder_.file("fifo").c_str(), 0600), 0);
  expect_part(refusal_of(folder_.file("fifo")), "is not a regular file");
}

TEST_F(HostileFile, that_is_a_device_is_refused) {
  expect_part(refusal_of("/dev/zero"), "/dev/zero: is not a regular file");
}

TEST_F(HostileFile, of_more_than_16_mb_is_refused) {
  const std::string file = write("");
  ASSERT_EQ(truncate(file.c_str(), static_cast<off_t>(max_options_bytes) + 1), 0);
  expect_part(refusal_of(file), "is larger than 16 MB");
}

TEST_F(HostileFile, with_a_nul_byte_is_refused_with_its_place) {
  expect_part(refusal_of(write(std::string("a = 1\nb\0 = 2\n", 13))), "s.toml:2:2: a NUL byte");
}

TEST_F(HostileFile, that_is_not_utf_8_is_refused_with_its_place) {
  // A stray continuation, a cut character, an overlong one, a surrogate, one beyond U+10FFFF.
  for (const char* bytes : {"\x80", "\xc3", "\xe2\x82", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80",
                            "\xf0\x80\x80\x80", "\xf4\x90\x80\x80", "\xff\xfe"})
    expect_part(refusal_of(write("# ü\n# \xc3\xbc" + std::string(bytes) + "\n")),
                "s.toml:2:4: a byte that is not UTF-8");
}

TEST_F(HostileFile, nested_a_million_deep_is_refused) {
  const int n = 1'000'000;
  expect_part(refusal_of(write(std::string("a = ").append(n, '['))),
              "s.toml:1:69: nested deeper than 64");
  expect_part(refusal_of(write(std::string("a = ").append(repeated("{a=", n)))),
              "nested deeper than 64 levels");
  expect_part(refusal_of(write(std::string("a").append(repeated(".a", n)) + " = 1")),
              "nested deeper than 64 levels");
  expect_part(refusal_of(write(std::string("[a").append(repeated(".a", n)) + "]")),
              "nested deeper than 64 levels");
}

TEST_F(HostileFile, nested_in_every_way_at_once_is_refused) {
  std::string text;
  for (int i = 0; i < 60; ++i)
    text.append("a").append(repeated(".a", 60)).append(i < 59 ? " = {" : " = 1");
  EXPECT_NE(refusal_of(write(text + std::string(59, '}'))), "");
}

TEST_F(HostileFile, with_brackets_inside_texts_and_comments_is_no_nesting) {
  const std::string open(200, '[');
  const std::string file = write("# " + open + "'\nname = \"\"\"" + open + " \\\" ''' \"\"\"\n" +
                                 "[tissue]\nmesh = '" + open + "'\n");
  EXPECT_EQ(refusal_of(file), "");
}

TEST_F(HostileFile, with_millions_of_values_is_refused) {
  expect_part(refusal_of(write(std::string("gravity = [").append(repeated("1,", 8'000'000)) + "]")),
              "more than 200000 values");
  expect_part(refusal_of(write(repeated("[[a]]\n", 2'500'000))), "more than 200000 values");
}

TEST_F(HostileFile, with_as_many_values_as_allowed_is_read_in_time) {
  EXPECT_NE(refusal_of(write(std::string("gravity = [").append(repeated("1,", 199'000)) + "]")),
            "");
  EXPECT_NE(refusal_of(write(repeated("[[instrument]]\n", 99'000))), "");
  std::string keys;
  for (int i = 0; i < 199'000; ++i) keys.append("k").append(std::to_string(i)).append(" = 1\n");
  expect_part(refusal_of(write(keys)), "more errors");
  std::string tables;
  for (int i = 0; i < 199'000; ++i) tables.append("[t").append(std::to_string(i)).append("]\n");
  expect_part(refusal_of(write(tables)), "more errors");
  std::string dotted;
  for (int i = 0; i < 99'000; ++i) dotted.append("t").append(std::to_string(i)).append(".a.b=1\n");
  expect_part(refusal_of(write(dotted)), "more errors");
}

TEST_F(HostileFile, with_huge_keys_and_texts_gives_a_short_message) {
  const std::string huge(15'000'000, 'x');
  const std::string ones(15'000'000, '1');
  expect_part(refusal_of(write(huge + " = 1")), "unknown key");
  expect_part(refusal_of(write("is_fast = '" + huge + "'")), "found the text \"xxx");
  expect_part(refusal_of(write("duration = '" + huge + "'")), "does not begin with a number");
  expect_part(refusal_of(write("duration = '" + ones + " s'")), "too large");
  expect_part(refusal_of(write("duration = " + ones)), "not TOML");
  expect_part(refusal_of(write("#" + huge)), "missing");
  EXPECT_NE(refusal_of(write(std::string(15'000'000, '\n') + "x")), "");
}

TEST_F(HostileFile, with_numbers_beyond_double_is_refused) {
  for (const char* number : {"1e999", "-1e999", "nan", "+inf", "99999999999999999999", "'1e999 s'"})
    expect_part(refusal_of(write(std::string("duration = ") + number + "\n[tissue]\nmesh = 'a'\n")),
                "s.toml:1:");
}

TEST_F(HostileFile, takes_less_than_256_mb) {
  // The most nodes that the limits let pass, then the longest key and text; each is also in this
  // test's own memory.
  std::string tables;
  for (int i = 0; i < 199'000; ++i) tables.append("t").append(std::to_string(i)).append(".b=1\n");
  EXPECT_NE(refusal_of(write(tables)), "");
  const std::string huge(16'000'000, 'x');
  EXPECT_NE(refusal_of(write(huge + " = 1")), "");
  EXPECT_NE(refusal_of(write("name = '" + huge + "'")), "");
  EXPECT_TRUE(!has_bounds || peak_memory_bytes() < 256 << 20) << peak_memory_bytes();
}

}  // namespace
}  // namespace trocar
