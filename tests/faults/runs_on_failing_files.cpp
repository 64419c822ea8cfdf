// A run whose calls on files fail, one after the other: for every call that it makes, a kill there,
// a full disk from there on, a broken one. What it leaves is readable and goes on to the end that
// it would have had. Runs are forked, without MPI: starting it takes longer than they do.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/threads.h"
#include "engine/recording.h"
#include "engine/run.h"
#include "error_of.h"
#include "failing_files.h"
#include "failing_scene.h"
#include "solver/step.h"
#include "test_files.h"

namespace trocar {
namespace {

// As apps/main.cpp ends a run.
ExitCode run_as_main_does(const RunOptions& options) {
  Communicator alone;
  try {
    return run_scene(options, alone) ? ExitCode::done : ExitCode::stopped;
  } catch (const InputError& trouble) {
    log_error(trouble.what());
    return ExitCode::input;
  } catch (const SimulationError& trouble) {
    log_error(trouble.what());
    return ExitCode::simulation;
  } catch (const MachineError& trouble) {
    log_error(trouble.what());
    return ExitCode::machine;
  }
}

// Only in a child: what it says goes to the file.
[[noreturn]] void run_and_exit(const RunOptions& options, const std::string& fault,
                               const std::string& said) {
  dup2(open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), STDERR_FILENO);
  start_log(0, true);
  set_thread_count(1);
  select_simd("auto");
  fail_files(fault.c_str(), options.folder.c_str());
  const ExitCode code = run_as_main_does(options);
  std::fprintf(stderr, "calls: %d\n", n_file_calls());
  std::_Exit(static_cast<int>(code));
}

struct Ended {
  int code = -1;  // -1: killed
  Said said{""};
};

class FailingFiles : public testing::Test {
 protected:
  TestFolder folder_;
  std::string scene_ = folder_.file("s.toml", failing_scene), out_ = folder_.file("out");

  Ended run(const std::string& fault, bool is_resumed = false) const {
    const RunOptions options = {.scene_file = scene_, .folder = out_, .is_resumed = is_resumed};
    const std::string said = folder_.file("said");
    const pid_t child = fork();
    if (child == 0) run_and_exit(options, fault, said);
    Ended ended;
    int status = 0;
    if (waitpid(child, &status, 0) == child && WIFEXITED(status)) ended.code = WEXITSTATUS(status);
    ended.said = Said(read_text(said));
    return ended;
  }

  std::string digest() const { return digest_in(out_); }

  // An earlier run's are gone.
  void clear() const { std::filesystem::remove_all(out_); }

  int count_calls() const {
    const Ended ended = run("none@0");
    EXPECT_EQ(ended.code, 0) << ended.said.sentences;
    const std::string &text = ended.said.sentences, key = "calls: ";
    const std::size_t at = text.find(key);
    return at == text.npos ? 0 : std::atoi(text.c_str() + at + key.size());
  }

  // In a copy: reading mends what a kill left.
  std::size_t n_frames_readable() const {
    const std::string copy = folder_.file("copy"), recording = copy + "/r.trocar";
    if (!std::filesystem::exists(out_)) return 0;
    std::filesystem::remove_all(copy);
    std::filesystem::copy(out_, copy);
    std::size_t n = 0;
    // A file without its head is no recording yet.
    const std::string trouble = error_of([&] {
      RecordingReader reader(recording);
      EXPECT_TRUE(reader.damage().empty()) << reader.damage().front();
      for (const auto& [frame, time] : reader.frames()) reader.read(frame);
      n = reader.frames().size();
    });
    return trouble.empty() ? n : 0;
  }

  // All that is committed can be read, and the run comes to its end from there.
  void expect_to_go_on() const {
    EXPECT_GE(n_frames_readable(), n_metric_rows(out_));
    const std::string summary = read_text(out_ + "/summary.json");
    EXPECT_TRUE(summary.empty() || nlohmann::json::accept(summary)) << summary;
    const bool has_checkpoint = std::filesystem::exists(out_ + "/checkpoint.bin");
    const Ended ended = run("none@0", has_checkpoint);
    EXPECT_EQ(ended.code, 0) << ended.said.sentences;
    EXPECT_EQ(digest(), digest_);
    EXPECT_EQ(n_frames_readable(), std::size_t{n_failing_frames});
    EXPECT_EQ(n_metric_rows(out_), std::size_t{n_failing_frames});
    for (const char* left : {"/checkpoint.bin.new", "/summary.json.part", "/.trocar-lock"})
      EXPECT_FALSE(std::filesystem::exists(out_ + left)) << left;
  }

  // What fails is told, and named; or it does not matter to the run.
  void expect_error_or_success(const Ended& ended) const {
    if (ended.code == 0) {
      EXPECT_EQ(digest(), digest_);
      EXPECT_EQ(n_frames_readable(), std::size_t{n_failing_frames});
      return;
    }
    EXPECT_EQ(ended.code, static_cast<int>(ExitCode::machine));
    EXPECT_TRUE(ended.said.names_failed());
    expect_to_go_on();
  }

  // check(how the run ended): of each of the run's calls.
  template <class Check>
  void at_each_call(const std::string& fault, const Check& check) {
    const int n = count_calls();
    EXPECT_GT(n, 80);
    digest_ = digest();
    for (int k = 1; k <= n && !HasFailure(); ++k) {
      SCOPED_TRACE(fault + "@" + std::to_string(k));
      clear();
      const Ended ended = run(fault + "@" + std::to_string(k));
      SCOPED_TRACE(ended.said.sentences);
      check(ended);
    }
  }

  std::string digest_;  // of a run that nothing happens to
};

TEST_F(FailingFiles, kill_a_run_at_any_call_and_it_goes_on_with_the_same_bits) {
  at_each_call("kill", [&](const Ended& ended) {
    EXPECT_EQ(ended.code, -1);
    expect_to_go_on();
  });
}

// Other calls are killed above.
TEST_F(FailingFiles, kill_a_run_in_the_middle_of_any_write_and_it_goes_on_with_the_same_bits) {
  int n_writes = 0;
  at_each_call("half", [&](const Ended& ended) {
    EXPECT_EQ(ended.code, -1);
    ASSERT_EQ(ended.said.failed.size(), 1U);
    if (ended.said.failed[0].call.find("write") == std::string::npos) return;
    ++n_writes;
    expect_to_go_on();
  });
  EXPECT_GT(n_writes, 40);
}

TEST_F(FailingFiles,
       on_a_disk_that_gets_full_end_the_run_with_4_and_it_goes_on_once_there_is_room) {
  int n_told = 0;
  at_each_call("full", [&](const Ended& ended) {
    n_told += ended.code == 0 ? 0 : 1;
    expect_error_or_success(ended);
  });
  EXPECT_GT(n_told, 80);
}

TEST_F(FailingFiles, on_a_broken_disk_end_the_run_with_4_or_do_not_matter) {
  int n_told = 0;
  at_each_call("eio", [&](const Ended& ended) {
    n_told += ended.code == 0 ? 0 : 1;
    expect_error_or_success(ended);
  });
  EXPECT_GT(n_told, 60);
}

TEST_F(FailingFiles, that_take_less_than_they_are_given_lose_nothing) {
  at_each_call("short", [&](const Ended& ended) { expect_error_or_success(ended); });
}

}  // namespace
}  // namespace trocar
