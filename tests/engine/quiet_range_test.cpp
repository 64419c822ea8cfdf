#include "engine/quiet_range.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

QuietRange range_of(const std::vector<std::vector<double>>& frames, std::size_t n_frames,
                    double share) {
  QuietRange range;
  for (const std::vector<double>& frame : frames) note_actions(frame, n_frames, range);
  narrow_range(frames[0].size(), share, range);
  return range;
}

bool is_left_by(QuietRange range, const std::vector<double>& values) {
  note_actions(values, 2, range);
  return leave_range(range);
}

TEST(QuietRange, is_left_beyond_what_the_kept_frames_had_and_a_share_of_the_vector) {
  // The first frame is forgotten; the largest component that is left is 4, a tenth of it 0.4.
  const QuietRange range = range_of({{90, 90, 90}, {1, 2, -4}, {3, 2, 0}}, 2, 0.1);
  EXPECT_FALSE(leave_range(range));
  EXPECT_FALSE(is_left_by(range, {0.7, 2.3, 0.3}));
  EXPECT_FALSE(is_left_by(range, {3.3, 1.7, -4.3}));
  EXPECT_TRUE(is_left_by(range, {0.5, 2, 0}));
  EXPECT_TRUE(is_left_by(range, {3.5, 2, 0}));
  EXPECT_TRUE(is_left_by(range, {2, 2.5, 0}));
  EXPECT_TRUE(is_left_by(range, {2, 2, -4.5}));
}

TEST(QuietRange, of_several_vectors_is_left_by_any_of_them) {
  const QuietRange range = range_of({{1, 1, 1, 0, 0, 0}, {1, 1, 1, 0, 0, 0}}, 2, 0.1);
  EXPECT_FALSE(is_left_by(range, {1.05, 1, 0.95, 0, 0, 0}));
  EXPECT_TRUE(is_left_by(range, {1, 1, 1, 0, 1e-9, 0})) << "a share of nothing";
}

// Who fell asleep first still needs its own range.
TEST(QuietRange, only_narrows_while_anybody_sleeps) {
  QuietRange range = range_of({{1, 0, 0}, {2, 0, 0}}, 2, 0);
  for (const double x : {1.5, 1.5}) note_actions(std::vector<double>{x, 0, 0}, 2, range);
  narrow_range(3, 0, range);
  EXPECT_TRUE(is_left_by(range, {1.6, 0, 0}));
  for (const double x : {1.0, 2.0}) note_actions(std::vector<double>{x, 0, 0}, 2, range);
  narrow_range(3, 0, range);
  EXPECT_TRUE(is_left_by(range, {1.6, 0, 0}));
  EXPECT_FALSE(is_left_by(range, {1.5, 0, 0}));
}

}  // namespace
}  // namespace trocar
