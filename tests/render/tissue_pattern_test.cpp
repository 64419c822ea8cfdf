#include "render/tissue_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

using namespace trocar;

namespace {

// Greatest step between neighbours in direction x: within the cube, and from its last texel to its
// first.
std::pair<int, int> greatest_steps(const std::vector<std::uint8_t>& texel, int n, int channel) {
  int within = 0, across = 0;
  for (int row = 0; row < n * n; ++row)
    for (int i = 0; i < n; ++i) {
      const int a = texel[(row * n + i) * 4 + channel],
                b = texel[(row * n + (i + 1) % n) * 4 + channel];
      int& greatest = i + 1 < n ? within : across;
      greatest = std::max(greatest, std::abs(a - b));
    }
  return {within, across};
}

}  // namespace

TEST(TissuePattern, repeats_without_a_seam) {
  const TissuePattern pattern = make_tissue_pattern(32, 4);
  ASSERT_EQ(pattern.field.size(), 4u * 32 * 32 * 32);
  ASSERT_EQ(pattern.bump.size(), pattern.field.size());
  for (int channel = 0; channel < 4; ++channel)
    for (const auto* texel : {&pattern.field, &pattern.bump}) {
      const auto [within, across] = greatest_steps(*texel, 32, channel);
      EXPECT_LE(across, within) << channel;
      EXPECT_GT(within, 2);
    }
}

TEST(TissuePattern, fields_use_their_range_and_rarely_clip) {
  const TissuePattern pattern = make_tissue_pattern(32, 4);
  for (int channel : {0, 2, 3}) {
    int low = 255, high = 0, n_clipped = 0;
    double sum = 0;
    for (std::size_t k = channel; k < pattern.field.size(); k += 4) {
      const int v = pattern.field[k];
      low = std::min(low, v);
      high = std::max(high, v);
      n_clipped += v == 0 || v == 255;
      sum += v;
    }
    EXPECT_LT(low, 70) << channel;
    EXPECT_GT(high, 185) << channel;
    EXPECT_LT(n_clipped, 32 * 32 * 32 / 100) << channel;
    EXPECT_NEAR(sum / (32 * 32 * 32), 127.5, 25) << channel;  // signed noise, about zero
  }
}
