#include "render/encoder_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>

#include "base/error.h"
#include "error_of.h"
#include "render_scene.h"

using namespace trocar;
using namespace trocar::testing;

namespace {

const std::vector<std::uint8_t> much(1 << 20, 'x');  // more than a pipe holds

}  // namespace

TEST(EncoderProcess, program_gets_every_byte) {
  const std::string expected = std::to_string(much.size());
  EncoderProcess process({"/bin/sh", "-c", "test $(wc -c) = " + expected});
  process.write(much);
  EXPECT_EQ(error_of<MachineError>([&] { process.finish(); }), "");
  EncoderProcess too_few({"/bin/sh", "-c", "test $(wc -c) = " + expected});
  EXPECT_NE(error_of<MachineError>([&] { too_few.finish(); }), "");
}

TEST(EncoderProcess, program_that_does_not_exist_is_an_error) {
  EXPECT_NE(
      error_of<MachineError>([] { EncoderProcess({"/no/such/program"}); }).find("/no/such/program"),
      std::string::npos);
}

// With three free numbers the second pipe can't be made.
TEST(EncoderProcess, without_a_pipe_nothing_stays_open) {
  std::array<int, 3> free{};
  for (int& number : free) number = dup(STDIN_FILENO);
  for (const int number : free) close(number);
  rlimit usual{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &usual), 0);
  rlimit few = usual;
  few.rlim_cur = static_cast<rlim_t>(free.back()) + 1;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  const std::string what = error_of<MachineError>([] { EncoderProcess({"/bin/true"}); });
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &usual), 0);
  EXPECT_NE(what.find("pipe"), std::string::npos) << what;
  for (const int number : free) EXPECT_EQ(fcntl(number, F_GETFD), -1) << number;
}

TEST(EncoderProcess, killed_program_is_an_error_not_a_signal) {
  EncoderProcess process({"/bin/sleep", "60"});
  kill(process.pid(), SIGKILL);
  const std::string what = error_of<MachineError>([&] { process.write(much); });
  EXPECT_NE(what.find("signal 9"), std::string::npos) << what;
}

TEST(EncoderProcess, stopped_program_is_ended_when_patience_is_over) {
  EncoderProcess process({"/bin/sleep", "60"}, 0.3);
  kill(process.pid(), SIGSTOP);
  const std::string what = error_of<MachineError>([&] { process.write(much); });
  EXPECT_NE(what.find("took no data"), std::string::npos) << what;
}

TEST(EncoderProcess, last_words_of_a_failed_program_are_in_the_error) {
  EncoderProcess process({"/bin/ls", "/no-such-thing"});
  const std::string what = error_of<MachineError>([&] { process.finish(); });
  EXPECT_NE(what.find("no-such-thing"), std::string::npos) << what;
  EXPECT_NE(what.find("code 2"), std::string::npos) << what;
}

TEST(EncoderProcess, arguments_meet_no_shell) {
  const TestFolder folder;
  const std::string canary = folder.file("canary");
  EncoderProcess process({"/bin/ls", "$(touch " + canary + ");touch " + canary});
  EXPECT_NE(error_of<MachineError>([&] { process.finish(); }), "");
  EXPECT_FALSE(std::filesystem::exists(canary));
}
