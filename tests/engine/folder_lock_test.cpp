// One run at a time in an output folder.
#include "engine/folder_lock.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <optional>

#include "error_of.h"
#include "test_files.h"

namespace trocar {
namespace {

std::string lock_refusal(const TestFolder& folder) {
  return error_of([&] { const FolderLock lock(folder.path()); });
}

TEST(FolderLock, refuses_a_second_run_and_names_the_first) {
  const TestFolder folder;
  std::optional<FolderLock> first(folder.path());
  const std::string who = "in use by another run (process " + std::to_string(getpid()) + " on ";
  EXPECT_TRUE(contains(lock_refusal(folder), who)) << lock_refusal(folder);
  EXPECT_TRUE(contains(lock_refusal(folder), "choose another one with -o"));
  first.reset();
  EXPECT_EQ(lock_refusal(folder), "");
}

TEST(FolderLock, leaves_nothing_behind) {
  const TestFolder folder;
  EXPECT_EQ(lock_refusal(folder), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FolderLock, of_a_killed_run_locks_nothing) {
  const TestFolder folder;
  write_text(folder.file(".trocar-lock"), "process 1 on elsewhere");
  EXPECT_EQ(lock_refusal(folder), "");
}

TEST(FolderLock, goes_on_without_a_folder) {
  const TestFolder folder;
  EXPECT_EQ(error_of([&] { FolderLock(folder.file("missing")).give_up_room(); }), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FolderLock, keeps_room_for_a_summary_until_it_is_needed) {
  const TestFolder folder;
  FolderLock lock(folder.path());
  const auto bytes_on_disk = [&] {
    struct stat there {};
    EXPECT_EQ(stat(folder.file(".trocar-lock").c_str(), &there), 0);
    return 512 * static_cast<std::int64_t>(there.st_blocks);
  };
  EXPECT_GE(bytes_on_disk(), 65536);
  lock.give_up_room();
  EXPECT_EQ(bytes_on_disk(), 0);
}

}  // namespace
}  // namespace trocar
