#include "render/caption.h"

#include <gtest/gtest.h>

#include <algorithm>
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

// n x n pixels.
static Image grey_square(int n) {
  return {.width = n,
          .height = n,
          .rgb = std::vector<std::uint8_t>(static_cast<std::size_t>(3 * n * n), 128)};
}

// The n x n pixels in the middle, behind a rim on each side.
static Image cropped(const Image& image, int rim, int n) {
  Image part = grey_square(n);
  for (int y = 0; y < n; ++y)
    std::copy_n(image.rgb.begin() + 3 * ((y + rim) * image.width + rim), 3 * n,
                part.rgb.begin() + 3 * y * n);
  return part;
}

TEST(Caption, dots_are_light_with_a_dark_outline) {
  Image image = grey_square(30);
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
  Image image = grey_square(8);
  draw_text(image, "far", {.x = 100, .y = 100, .scale = 3});
  draw_text(image, "far", {.x = -100, .y = 3, .scale = 3});
  EXPECT_EQ(image.rgb, grey_square(8).rgb);
}

TEST(Caption, text_at_the_rim_of_a_picture_is_what_a_larger_one_shows_there) {
  const std::string text = "\x01 long text \xff";
  const int n = 8, rim = 300;  // more than the text's width, 13 glyphs of 6 dots of 3 pixels
  for (const TextPlace place : {TextPlace{-3, -3, 3}, TextPlace{4, 5, 1}, TextPlace{-185, 0, 3}}) {
    Image image = grey_square(n), large = grey_square(n + 2 * rim);
    draw_text(image, text, place);
    draw_text(large, text, {place.x + rim, place.y + rim, place.scale});
    EXPECT_NE(image.rgb, grey_square(n).rgb);
    EXPECT_EQ(image.rgb, cropped(large, rim, n).rgb) << place.x << ", " << place.y;
  }
}

TEST(Caption, of_a_tiny_picture_is_what_fits) {
  Image image = grey_square(8), by_text = grey_square(8);
  draw_caption(image, "caption");
  draw_text(by_text, "caption", {.x = 5, .y = -4, .scale = 1});
  EXPECT_EQ(image.rgb, by_text.rgb);
}
