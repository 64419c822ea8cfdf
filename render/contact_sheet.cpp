// Many pictures in one.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "render/caption.h"
#include "render/image_file.h"

namespace trocar {

namespace {

constexpr int gap = 4;  // between tiles [pixel]
constexpr int text_scale = 2;
constexpr int caption_height = (glyph_height + 6) * text_scale;
constexpr std::uint8_t paper = 24;

// Linear light of an sRGB byte (IEC 61966-2-1), in 1 / 65535, so that sums are exact.
std::array<std::uint32_t, 256> make_linear_light() {
  std::array<std::uint32_t, 256> table{};
  for (int k = 0; k < 256; ++k) {
    const double s = k / 255.0;
    const double light = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    table[k] = static_cast<std::uint32_t>(std::lround(65535 * light));
  }
  return table;
}

std::uint8_t to_srgb(double light) {
  const double s = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(s, 0.0, 1.0)));
}

// Mean of the pixels that a small pixel covers, in linear light.
void average_pixel(const Image& image, const std::array<int, 4>& from_to,
                   const std::array<std::uint32_t, 256>& light, std::uint8_t* out) {
  const auto [x0, y0, x1, y1] = from_to;
  std::array<std::uint64_t, 3> sum{};
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      for (int c = 0; c < 3; ++c)
        sum[c] += light[image.rgb[(static_cast<std::size_t>(y) * image.width + x) * 3 + c]];
  const double n = 65535.0 * (x1 - x0) * (y1 - y0);
  for (int c = 0; c < 3; ++c) out[c] = to_srgb(static_cast<double>(sum[c]) / n);
}

Image scaled_down(const Image& image, int width) {
  const std::array<std::uint32_t, 256> light = make_linear_light();
  Image small;
  small.width = std::min(width, image.width);
  small.height = std::max(1, static_cast<int>(std::lround(static_cast<double>(image.height) *
                                                          small.width / image.width)));
  small.rgb.resize(std::size_t{3} * small.width * small.height);
  // Borders of the small pixels, rounded to whole pixels; none is empty.
  const auto border = [](int k, int n, int n_large) {
    return static_cast<int>(static_cast<std::int64_t>(k) * n_large / n);
  };
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const int x0 = border(x, small.width, image.width);
      const int y0 = std::min(border(y, small.height, image.height), image.height - 1);
      const int x1 = std::max(x0 + 1, border(x + 1, small.width, image.width));
      const int y1 = std::max(y0 + 1, border(y + 1, small.height, image.height));
      average_pixel(image, {x0, y0, x1, y1}, light,
                    &small.rgb[(static_cast<std::size_t>(y) * small.width + x) * 3]);
    }
  return small;
}

void paste(const Image& tile, int x, int y, Image& sheet) {
  for (int row = 0; row < tile.height; ++row)
    std::copy_n(&tile.rgb[std::size_t{3} * row * tile.width], std::size_t{3} * tile.width,
                &sheet.rgb[(static_cast<std::size_t>(y + row) * sheet.width + x) * 3]);
}

}  // namespace

Image draw_contact_sheet(const ContactSheet& sheet) {
  CHECK(sheet.columns > 0 && sheet.tile_width > 0);
  CHECK(!sheet.images.empty() && sheet.captions.size() == sheet.images.size());
  std::vector<Image> tiles;
  int width = 0, height = 0;
  for (const Image& image : sheet.images) {
    CHECK(image.width > 0 && image.height > 0);
    tiles.push_back(scaled_down(image, sheet.tile_width));
    width = std::max(width, tiles.back().width);
    height = std::max(height, tiles.back().height);
  }
  const int n = static_cast<int>(tiles.size());
  const int columns = std::min(sheet.columns, n), rows = (n + columns - 1) / columns;
  const int row_height = height + caption_height;
  Image all{.width = columns * (width + gap) + gap, .height = rows * (row_height + gap) + gap};
  all.rgb.assign(std::size_t{3} * all.width * all.height, paper);
  for (int k = 0; k < n; ++k) {
    const int x = gap + k % columns * (width + gap), y = gap + k / columns * (row_height + gap);
    paste(tiles[k], x, y, all);
    draw_text(all, sheet.captions[k],
              {.x = x + 4 * text_scale, .y = y + height + 3 * text_scale, .scale = text_scale});
  }
  return all;
}

}  // namespace trocar
