// What is said of outputs before a run.
#include "engine/output_check.h"

#include <gtest/gtest.h>

#include "error_of.h"
#include "test_files.h"

namespace trocar {
namespace {

std::string warnings_of_time(double duration, double frame_rate) {
  const TestFolder folder;
  Scene scene;
  scene.time.duration = duration;
  scene.time.frame_rate = frame_rate;
  testing::internal::CaptureStderr();
  warn_of_outputs(scene, folder.path());
  return testing::internal::GetCapturedStderr();
}

TEST(OutputCheck, names_the_frame_rate_as_it_was_given) {
  EXPECT_TRUE(contains(warnings_of_time(1, 29.97), "is no whole number of frames of 29.97 Hz: it "))
      << warnings_of_time(1, 29.97);
  EXPECT_TRUE(contains(warnings_of_time(1.03, 50), "is no whole number of frames of 50 Hz: it "));
  EXPECT_EQ(warnings_of_time(1, 50), "");
}

}  // namespace
}  // namespace trocar
