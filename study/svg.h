// The few SVG shapes that a plot is made of, as text.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace trocar {

struct SvgPoint {
  double x = 0, y = 0;  // pixels, y downward
};

struct SvgStroke {
  std::string colour = "#333333";
  double width = 1;
  std::string dash;  // "6 4", "" for a solid line
};

enum class SvgAnchor { start, middle, end };

struct SvgText {
  std::string text;
  SvgAnchor anchor = SvgAnchor::start;
  double size = 13;
  std::string colour = "#222222";
  bool is_upright = false;  // turned by 90 degrees, reads upward
  bool is_bold = false;
};

std::string svg_line(SvgPoint a, SvgPoint b, const SvgStroke& stroke);
std::string svg_polyline(const std::vector<SvgPoint>& points, const SvgStroke& stroke);
std::string svg_rectangle(SvgPoint low, SvgPoint high, const std::string& fill);
std::string svg_text(SvgPoint at, const SvgText& text);
// Shape 0 circle, 1 square, 2 triangle, 3 diamond, and so on again. One with a title, which a
// browser shows on hovering, is of class "point".
std::string svg_marker(SvgPoint at, int shape, const std::string& colour, bool is_filled,
                       const std::string& title);
std::string svg_document(double width, double height, const std::string& title,
                         const std::string& content);

}  // namespace trocar
