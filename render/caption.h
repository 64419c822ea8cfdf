// Text in a small bitmap font of our own, drawn into a picture.
#pragma once

#include <string>

#include "render/renderer.h"

namespace trocar {

inline constexpr int glyph_width = 5, glyph_height = 7;
inline constexpr int glyph_advance = glyph_width + 1;

// Row `row` (0 top … 6) of a printable ASCII character: bit 4 is the leftmost of its five pixels.
// Others show a box.
int glyph_row(char character, int row);

struct TextPlace {
  int x = 0, y = 0;  // of the upper left corner [pixel]
  int scale = 1;     // pixels a dot
};
// White with a dark outline of one dot; what lies outside the picture is left out.
void draw_text(Image& image, const std::string& text, const TextPlace& place);
// Lower left corner, with a size that fits the picture's. Empty: nothing.
void draw_caption(Image& image, const std::string& text);

}  // namespace trocar
