#include <gtest/gtest.h>

#include <cmath>

#include "render/image_file.h"
#include "render_scene.h"

using namespace trocar;
using namespace trocar::testing;

namespace {

Image plain_image(int width, int height, std::uint8_t grey) {
  return {.width = width,
          .height = height,
          .rgb = std::vector<std::uint8_t>(std::size_t{3} * width * height, grey)};
}

}  // namespace

TEST(ContactSheet, black_and_white_pixels_average_to_half_the_light) {
  Image image = plain_image(64, 64, 0);
  for (int k = 0; k < 64 * 64; ++k)
    if ((k % 64 + k / 64) % 2) std::fill_n(&image.rgb[3 * k], 3, 255);
  const Image sheet =
      draw_contact_sheet({.images = {image}, .captions = {""}, .columns = 1, .tile_width = 16});
  const double half =
      255 * (1.055 * std::pow(0.5, 1 / 2.4) - 0.055);  // 187.5: rounding of table and result
  EXPECT_NEAR(mean_level(sheet, sheet.width / 2, 12, 3, 0), half, 1);
}

TEST(ContactSheet, pictures_stand_in_rows_with_room_for_captions) {
  ContactSheet order{.columns = 3, .tile_width = 32};
  for (int k = 0; k < 5; ++k) {
    order.images.push_back(plain_image(64, 32, static_cast<std::uint8_t>(40 * k + 40)));
    order.captions.push_back("t");
  }
  const Image sheet = draw_contact_sheet(order);
  EXPECT_GT(sheet.width, 3 * 32);
  EXPECT_GT(sheet.height, 2 * 16 + 2 * 7);
  ASSERT_EQ(sheet.rgb.size(), std::size_t{3} * sheet.width * sheet.height);
  // The second picture of the second row: right of a third of the width, below half of the height.
  EXPECT_EQ(mean_level(sheet, sheet.width / 2, sheet.height / 2 + 8, 2, 1), 200);
  EXPECT_EQ(mean_level(sheet, sheet.width / 6, 10, 2, 1), 40);
}

TEST(ContactSheet, pictures_smaller_than_a_tile_keep_their_size) {
  const Image sheet =
      draw_contact_sheet({.images = {plain_image(5, 3, 99)}, .captions = {"x"}, .tile_width = 640});
  EXPECT_LT(sheet.width, 20);
}
