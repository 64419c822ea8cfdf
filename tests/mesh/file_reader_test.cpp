// Numbers from text and bytes, and where a failure is said to be.
#include "mesh/file_reader.h"

#include <gtest/gtest.h>

#include <bit>

#include "base/error.h"
#include "error_of.h"
#include "mesh/xml_tag.h"

namespace trocar::test {
namespace {

TEST(FileReader, reads_words_and_numbers_one_after_the_other) {
  FileReader in("f", " a\t+5 -7\r\n+1.5e-3\n");
  EXPECT_EQ(in.word("w"), "a");
  EXPECT_EQ(in.integer("i"), 5);
  EXPECT_EQ(in.integer("i"), -7);
  EXPECT_EQ(in.real("r"), 1.5e-3);
  EXPECT_TRUE(in.is_at_end());
}

TEST(FileReader, names_the_line_of_text) {
  FileReader in("f", "1\n\n x");
  in.integer("i");
  EXPECT_EQ(error_of([&] { in.integer("a count"); }),
            "f:3: a count should be an integer, not \"x\"");
  EXPECT_EQ(error_of([&] { in.integer("a count"); }),
            "f:3: the file ends where a count should stand");
}

TEST(FileReader, numbers_with_something_behind_them_are_refused) {
  for (const char* text : {"12abc", "+-5", "0x10", "-", "+", "1.5"})
    EXPECT_THROW(FileReader("f", text).integer("i"), InputError) << text;
  for (const char* text : {"1.5f", "1e", "inf", "-nan", "1e400", "+-1"})
    EXPECT_THROW(FileReader("f", text).real("r"), InputError) << text;
}

TEST(FileReader, reads_both_byte_orders) {
  const std::string_view bytes("\x01\x02\x03\x04", 4);
  const bool is_big = std::endian::native == std::endian::big;
  EXPECT_EQ(FileReader::load_number<std::uint32_t>(bytes.data(), !is_big), 0x01020304U);
  EXPECT_EQ(FileReader::load_number<std::uint32_t>(bytes.data(), is_big), 0x04030201U);
}

TEST(FileReader, names_the_byte_of_binary_data) {
  FileReader in("f", "12345");
  in.is_binary = true;
  in.take(2, "a mark");
  EXPECT_EQ(error_of([&] { in.raw<std::int32_t>("a count"); }),
            "f: byte 2: the file ends within a count: 4 bytes are needed, 3 are left");
}

TEST(FileReader, counts_are_compared_with_the_bytes_left) {
  const FileReader in("f", "0123456789");
  EXPECT_EQ(in.check_count(5, 2, "things"), 5U);
  EXPECT_THROW(in.check_count(6, 2, "things"), InputError);
  EXPECT_THROW(in.check_count(-1, 2, "things"), InputError);
  EXPECT_THROW(in.check_count(INT64_MAX, 2, "things"), InputError);
}

TEST(XmlTag, gives_names_attributes_and_the_text_between) {
  FileReader in("f", "<?xml?> <!-- <x> --> text <a b=\"1>2\" c = 'd'/>t</e >");
  XmlTag tag;
  ASSERT_TRUE(next_tag(in, tag));
  EXPECT_EQ(tag.name, "a");
  EXPECT_TRUE(tag.is_empty);
  EXPECT_EQ(tag.before, " text ");
  EXPECT_EQ(attribute(tag, "b"), "1>2");
  EXPECT_EQ(attribute(tag, "c"), "d");
  EXPECT_EQ(attribute(tag, "x"), "");
  ASSERT_TRUE(next_tag(in, tag));
  EXPECT_EQ(tag.name, "e");
  EXPECT_TRUE(tag.is_end);
  EXPECT_FALSE(next_tag(in, tag));
}

TEST(XmlTag, broken_tags_are_refused) {
  XmlTag tag;
  for (const char* text : {"<a", "<a b>", "<a b=1>", "<a b=\"1>", "<!-- ", "<a b=>"}) {
    FileReader in("f", text);
    EXPECT_THROW(next_tag(in, tag), InputError) << text;
  }
}

}  // namespace
}  // namespace trocar::test
