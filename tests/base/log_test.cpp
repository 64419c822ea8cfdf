#include "base/log.h"

#include <gtest/gtest.h>

#include <functional>

namespace trocar {
namespace {

std::string printed(const std::function<void()>& action) {
  testing::internal::CaptureStderr();
  action();
  return testing::internal::GetCapturedStderr();
}

void log_all() {
  log_info("mesh read");
  log_warning("slow disk");
  log_error("no mesh");
}

TEST(Log, prints_plain_lines_and_names_warnings_and_errors) {
  start_log(0, false);
  EXPECT_EQ(printed(log_all), "mesh read\n[warning] slow disk\n[error] no mesh\n");
}

TEST(Log, keeps_warnings_when_it_is_quiet) {
  start_log(0, true);
  EXPECT_EQ(printed(log_all), "[warning] slow disk\n[error] no mesh\n");
}

TEST(Log, prints_nothing_on_other_ranks) {
  start_log(1, false);
  EXPECT_EQ(printed(log_all), "");
}

TEST(Log, takes_braces_as_text) {
  start_log(0, false);
  EXPECT_EQ(printed([] { log_info("{} {0}"); }), "{} {0}\n");
}

TEST(ProgressBar, prints_a_line_every_tenth_where_there_is_no_terminal) {
  start_log(0, false);
  const std::string text = printed([] {
    ProgressBar bar("run");
    for (int i = 0; i <= 1000; ++i) bar.update(i / 1000.0, "x 2");
  });
  std::string expected;
  for (int tenth = 1; tenth <= 10; ++tenth)
    expected += "run: " + std::to_string(10 * tenth) + " %  x 2\n";
  EXPECT_EQ(text, expected);
}

TEST(ProgressBar, prints_nothing_when_it_is_quiet) {
  start_log(0, true);
  EXPECT_EQ(printed([] { ProgressBar("run").update(0.5, ""); }), "");
}

}  // namespace
}  // namespace trocar
