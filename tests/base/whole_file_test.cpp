#include "base/whole_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "error_of.h"
#include "test_files.h"

namespace trocar::test {
namespace {

std::string refusal_to_write(const std::string& file) {
  return error_of<MachineError>([&] { write_whole_file(file, "content"); });
}

TEST(WriteWholeFile, a_folder_that_is_not_there_is_named) {
  const TestFolder folder;
  const std::string file = folder.file("none/a.msh");
  EXPECT_EQ(refusal_to_write(file), file + ": can't be written: No such file or directory");
}

TEST(WriteWholeFile, a_failed_write_leaves_neither_half_a_file_nor_a_temporary_one) {
  const TestFolder folder;
  std::filesystem::create_directory(folder.file("a.msh"));  // so that renaming fails
  EXPECT_NE(refusal_to_write(folder.file("a.msh")), "");
  EXPECT_TRUE(std::filesystem::is_directory(folder.file("a.msh")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.msh.part")));
}

TEST(WriteWholeFile, a_full_disk_is_reported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this machine has no /dev/full";
  const TestFolder folder;
  write_text(folder.file("a.msh"), "old");
  std::filesystem::create_symlink("/dev/full", folder.file("a.msh.part"));
  EXPECT_EQ(refusal_to_write(folder.file("a.msh")),
            folder.file("a.msh") + ": can't be written: No space left on device");
  EXPECT_EQ(read_text(folder.file("a.msh")), "old");
}

TEST(WriteWholeFile, a_device_is_written_into_and_stays) {
  if (!std::filesystem::exists("/dev/null")) GTEST_SKIP() << "this machine has no /dev/null";
  const TestFolder folder;
  std::filesystem::create_symlink("/dev/null", folder.file("null"));
  EXPECT_EQ(refusal_to_write(folder.file("null")), "");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("null")));
  EXPECT_FALSE(std::filesystem::exists("/dev/null.part"));
}

TEST(WriteWholeFile, what_a_link_leads_to_is_written) {
  const TestFolder folder;
  write_text(folder.file("a"), "old");
  std::filesystem::create_symlink(folder.file("a"), folder.file("link"));
  EXPECT_EQ(refusal_to_write(folder.file("link")), "");
  EXPECT_NE(read_text(folder.file("a")), "old");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
}

std::string refusal_to_read(const std::string& file, std::size_t most_bytes) {
  return error_of([&] { read_whole_file(file, most_bytes); });
}

TEST(ReadWholeFile, gives_every_byte) {
  const TestFolder folder;
  const std::string content = std::string("a\0b\r\n", 5) + std::string(300'000, 'x');
  EXPECT_EQ(read_whole_file(write_text(folder.file("a"), content)), content);
  EXPECT_EQ(read_whole_file(write_text(folder.file("b"), "x")), "x");
}

TEST(ReadWholeFile, of_as_many_bytes_as_allowed_is_no_error_and_of_one_more_is) {
  constexpr std::size_t most = std::size_t{1} << 20;
  const TestFolder folder;
  const std::string file = write_text(folder.file("a"), std::string(most, 'x'));
  EXPECT_EQ(refusal_to_read(file, most), "");
  write_text(file, std::string(most + 1, 'x'));
  EXPECT_EQ(refusal_to_read(file, most), file + ": is larger than 1 MB, the limit for such a file");
}

TEST(ReadWholeFile, whose_size_is_not_known_beforehand_is_read_to_its_end) {
  if (!std::filesystem::exists("/proc/self/status")) GTEST_SKIP() << "this machine has no /proc";
  EXPECT_TRUE(contains(read_whole_file("/proc/self/status"), "VmRSS"));
}

TEST(ReadWholeFile, of_a_name_with_a_nul_byte_is_refused) {
  const TestFolder folder;
  const std::string file = write_text(folder.file("a"), "x");
  EXPECT_EQ(refusal_to_read(file + std::string("\0b", 2), 1),
            file + ": a file name can't hold a NUL byte");
}

TEST(ReadWholeFile, that_is_a_pipe_is_refused_without_waiting) {
  const TestFolder folder;
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  const std::string refusal =
      folder.file("pipe") + ": is not a regular file (a pipe or a device " + "can't be read)";
  EXPECT_EQ(refusal_to_read(folder.file("pipe"), 1), refusal);
  EXPECT_EQ(fault_of_file(folder.file("pipe")), refusal);
}

}  // namespace
}  // namespace trocar::test
