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

}  // namespace
}  // namespace trocar::test
