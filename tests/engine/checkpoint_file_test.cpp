#include "engine/checkpoint_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>

#include "error_of.h"
#include "test_files.h"

namespace trocar {
namespace {

void replace(const std::string& file, const std::string& text) {
  replace_file(file, [&](const ByteSink& sink) { sink(std::as_bytes(std::span(text))); });
}

int n_files(const TestFolder& folder) {
  const std::filesystem::directory_iterator begin(folder.path());
  return static_cast<int>(std::distance(begin, {}));
}

TEST(CheckpointFile, holds_what_was_written_last_and_leaves_nothing_beside_it) {
  const TestFolder folder;
  replace(folder.file("c"), std::string(100000, 'a'));
  replace(folder.file("c"), "second");
  EXPECT_EQ(read_text(folder.file("c")), "second");
  EXPECT_EQ(n_files(folder), 1);
}

TEST(CheckpointFile, that_can_not_be_written_says_why_and_how_much_it_needs) {
  const TestFolder folder;
  const std::string file = folder.file("no/such/folder/c");
  EXPECT_EQ(error_of<MachineError>([&] { replace(file, "12345"); }),
            file + ": can't be written (No such file or directory, 5 bytes needed)");
}

// A limit on the size of files stands for a full disk: the write stops in the middle.
TEST(CheckpointFile, stays_the_old_one_when_the_disk_is_full) {
  const TestFolder folder;
  replace(folder.file("c"), "old");
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit small{.rlim_cur = 1000, .rlim_max = 1000};
    setrlimit(RLIMIT_FSIZE, &small);
    _exit(error_of<MachineError>([&] { replace(folder.file("c"), std::string(5000, 'b')); }).empty()
              ? 1
              : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(read_text(folder.file("c")), "old");
  EXPECT_EQ(n_files(folder), 1);
}

TEST(CheckpointFile, is_whole_when_its_writer_is_killed_at_any_moment) {
  for (long microseconds = 0; microseconds < 4000; microseconds += 50) {
    const TestFolder folder;
    replace(folder.file("c"), std::string(50000, 'a'));
    const pid_t child = fork();
    if (child == 0)
      for (char letter = 'b';; letter = letter == 'z' ? 'b' : static_cast<char>(letter + 1))
        replace(folder.file("c"), std::string(50000, letter));
    const timespec wait{.tv_sec = 0, .tv_nsec = 1000 * microseconds};
    nanosleep(&wait, nullptr);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::string text = read_text(folder.file("c"));
    ASSERT_EQ(text.size(), 50000u);
    EXPECT_EQ(text, std::string(50000, text[0]));
  }
}

TEST(CheckpointFile, is_removed_with_the_remains_of_a_killed_writer) {
  const TestFolder folder;
  write_text(folder.file("checkpoint.bin"), "old");
  write_text(folder.file("checkpoint.bin.new"), "half");
  remove_checkpoint(folder.path());
  EXPECT_EQ(n_files(folder), 0);
}

}  // namespace
}  // namespace trocar
