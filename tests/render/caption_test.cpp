#include "render/caption.h"

#include <gtest/gtest.h>

#include <set>

using namespace trocar;

TEST(Caption, printable_characters_all_look_different) {
  std::set<std::vector<int>> seen;
  for (char c = 32; c < 127; ++c) {
    std::vector<int> rows;
    for (int row = 0; row < glyph_height; ++row) {
      rows.push_back(glyph_row(c, row));
      EXPECT_LT(rows.back(), 1 << glyph_width);
    }
    EXPECT_TRUE(seen.insert(rows).second) << c;
  }
}

TEST(Caption, letter_I_is_a_bar_between_two_serifs) {
  EXPECT_EQ(glyph_row('I', 0), 0b01110);
  for (int row = 1; row < 6; ++row) EXPECT_EQ(glyph_row('I', row), 0b00100);
  EXPECT_EQ(glyph_row('I', 6), 0b01110);
}

TEST(Caption, dots_are_light_with_a_dark_outline) {
  Image image{.width = 30, .height = 30, .rgb = std::vector<std::uint8_t>(2700, 128)};
  draw_text(image, "-",
            {.x = 10, .y = 10, .scale = 2});  // its row 3: pixels y 16 and 17, x 10 to 19
  const auto level = [&](int x, int y) { return image.rgb[(y * 30 + x) * 3]; };
  EXPECT_GT(level(10, 16), 200);
  EXPECT_GT(level(19, 17), 200);
  EXPECT_LT(level(9, 16), 40);
  EXPECT_LT(level(12, 15), 40);
  EXPECT_LT(level(12, 18), 40);
  EXPECT_EQ(level(12, 20), 128);
}

TEST(Caption, text_outside_the_picture_is_left_out) {
  Image image{.width = 8, .height = 8, .rgb = std::vector<std::uint8_t>(192, 128)};
  draw_text(image, "\x01 long text \xff", {.x = -3, .y = -3, .scale = 3});
  draw_text(image, "far", {.x = 100, .y = 100, .scale = 3});
  draw_caption(image, "caption");
  EXPECT_EQ(image.rgb.size(), 192u);
}
