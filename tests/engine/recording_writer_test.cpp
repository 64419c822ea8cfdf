#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <random>

#include "engine/recording.h"
#include "engine_recording.h"
#include "error_of.h"
#include "test_files.h"

namespace trocar {
namespace {

TEST(RecordingWriter, replaces_a_file_of_that_name) {
  const TestFolder folder;
  write_run(example_run(5), folder.file("r"));
  write_run(example_run(2), folder.file("r"));
  EXPECT_EQ(RecordingReader(folder.file("r")).frames().size(), 2u);
}

TEST(RecordingWriter, leaves_a_single_file_after_finish) {
  const TestFolder folder;
  write_run(example_run(3), folder.file("r"));
  int n_files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path()))
    ++n_files;
  EXPECT_EQ(n_files, 1);
}

TEST(RecordingWriter, writes_the_same_bytes_for_the_same_run) {
  const TestFolder folder;
  write_run(example_run(6), folder.file("a"));
  write_run(example_run(6), folder.file("b"));
  EXPECT_EQ(read_text(folder.file("a")), read_text(folder.file("b")));
}

TEST(RecordingWriter, says_which_place_can_not_be_written) {
  const TestFolder folder;
  const std::string file = folder.file("no/such/folder/r");
  EXPECT_TRUE(contains(error_of<MachineError>([&] { RecordingWriter(file, example_run(1).head); }),
                       file + ": can't be written ("));
}

TEST(RecordingWriter, refuses_a_second_frame_of_the_same_number) {
  const TestFolder folder;
  const ExampleRun run = example_run(1);
  RecordingWriter writer(folder.file("r"), run.head);
  writer.add({}, run.frames[0]);
  EXPECT_THROW(writer.add({}, run.frames[0]), MachineError);
}

TEST(RecordingWriter, without_finish_leaves_all_frames_readable) {
  const TestFolder folder;
  const ExampleRun run = example_run(4);
  write_run(run, folder.file("r"), false);
  RecordingReader reader(folder.file("r"));
  EXPECT_TRUE(reader.damage().empty());
  EXPECT_EQ(reader.frames().size(), 4u);
}

// The frames and meshes that a reader finds are those of `run`, no more and no less.
void expect_whole(const std::string& file, const ExampleRun& run) {
  RecordingReader reader(file);
  EXPECT_TRUE(reader.damage().empty()) << reader.damage().front();
  ASSERT_EQ(reader.frames().size(), run.frames.size());
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    EXPECT_TRUE(is_equal(reader.read(run.frames[k].frame), run.frames[k])) << "frame " << k;
    EXPECT_TRUE(reader.mesh_at(run.frames[k].frame) == run.meshes[k]) << "frame " << k;
  }
}

TEST(RecordingWriter, goes_on_after_any_frame_of_a_finished_or_unfinished_recording) {
  const ExampleRun run = example_run(9);
  for (const bool with_finish : {true, false})
    for (std::size_t last = 1; last < run.frames.size(); ++last) {  // frame 0 has number 0: none
      const TestFolder folder;
      write_run(run, folder.file("r"), with_finish);
      {
        RecordingWriter writer(folder.file("r"), run.frames[last].frame);
        writer.sync();
        for (std::size_t k = last + 1; k < run.frames.size(); ++k)
          writer.add(run.edits[k], run.frames[k]);
        writer.finish();
      }
      expect_whole(folder.file("r"), run);
    }
}

TEST(RecordingWriter, does_not_go_on_after_a_frame_that_is_not_there) {
  const TestFolder folder;
  write_run(example_run(3), folder.file("r"));
  EXPECT_TRUE(contains(error_of<MachineError>([&] { RecordingWriter(folder.file("r"), 3); }),
                       "frame 3 is not recorded"));
}

TEST(RecordingWriter, does_not_go_on_with_a_file_that_is_not_there) {
  const TestFolder folder;
  EXPECT_TRUE(
      contains(error_of([&] { RecordingWriter(folder.file("r"), 1); }), "no such recording"));
}

// Writes frames until it is killed, and says after each one that it is safe.
[[noreturn]] void write_until_killed(const std::string& file, const ExampleRun& run, int pipe_end) {
  RecordingWriter writer(file, run.head);
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    writer.add(run.edits[k], run.frames[k]);
    const char done = 1;
    if (write(pipe_end, &done, 1) != 1) _exit(1);
  }
  writer.finish();
  for (;;) pause();
}

// Acknowledged frames of a writer that is killed `microseconds` after its `n_before`th frame.
std::size_t kill_writer(const std::string& file, const ExampleRun& run, std::size_t n_before,
                        long microseconds) {
  int ends[2];
  if (pipe(ends) != 0) return 0;
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    write_until_killed(file, run, ends[1]);
  }
  close(ends[1]);
  std::size_t n = 0;
  char done = 0;
  while (n < n_before && read(ends[0], &done, 1) == 1) ++n;
  const timespec wait{.tv_sec = 0, .tv_nsec = 1000 * microseconds};
  nanosleep(&wait, nullptr);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  while (read(ends[0], &done, 1) == 1) ++n;
  close(ends[0]);
  return n;
}

TEST(RecordingWriter, killed_at_any_moment_keeps_every_frame_that_it_acknowledged) {
  const ExampleRun run = example_run(60);
  std::mt19937 random(20240607);
  for (int k = 0; k < 20; ++k) {
    const TestFolder folder;
    const std::size_t n_before = 1 + random() % 50;
    const std::size_t n =
        kill_writer(folder.file("r"), run, n_before, static_cast<long>(random() % 500));
    ASSERT_GE(n, n_before);
    RecordingReader reader(folder.file("r"));
    EXPECT_TRUE(reader.damage().empty()) << reader.damage().front();
    ASSERT_GE(reader.frames().size(), n);  // at most one more: committed, but not yet acknowledged
    ASSERT_LE(reader.frames().size(), n + 1);
    for (std::size_t f = 0; f < reader.frames().size(); ++f) {
      EXPECT_TRUE(is_equal(reader.read(run.frames[f].frame), run.frames[f]))
          << "kill " << k << " frame " << f;
      EXPECT_TRUE(reader.mesh_at(run.frames[f].frame) == run.meshes[f])
          << "kill " << k << " frame " << f;
    }
  }
}

TEST(RecordingWriter, killed_before_the_head_is_written_leaves_a_file_that_is_refused_or_empty) {
  const ExampleRun run = example_run(2);
  for (long microseconds = 0; microseconds < 1000; microseconds += 100) {
    const TestFolder folder;
    kill_writer(folder.file("r"), run, 0, microseconds);
    try {
      RecordingReader reader(folder.file("r"));
      EXPECT_LE(reader.frames().size(), 2u);
      EXPECT_TRUE(is_equal(reader.head(), run.head));
    } catch (const InputError& error) {
      EXPECT_TRUE(contains(error.what(), folder.file("r"))) << error.what();
    }
  }
}

}  // namespace
}  // namespace trocar
