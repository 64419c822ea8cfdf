#include "study/svg.h"

#include "base/number_text.h"
#include "mesh/xml_tag.h"

namespace trocar {

namespace {

std::string number(double value) {
  return with_decimals(value, 1);
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + escaped_xml(value) + "\"";
}

std::string stroke_attributes(const SvgStroke& stroke) {
  return attribute("stroke", stroke.colour) + attribute("stroke-width", number(stroke.width)) +
         (stroke.dash.empty() ? "" : attribute("stroke-dasharray", stroke.dash));
}

std::string point_list(const std::vector<SvgPoint>& points) {
  std::string text;
  for (const SvgPoint& p : points)
    text += (text.empty() ? "" : " ") + number(p.x) + "," + number(p.y);
  return text;
}

// Corners around the centre, for a marker as wide as a circle of radius 4.5.
std::vector<SvgPoint> marker_corners(int shape) {
  if (shape == 1) return {{-4.2, -4.2}, {4.2, -4.2}, {4.2, 4.2}, {-4.2, 4.2}};
  if (shape == 2) return {{0, -5.5}, {5, 4}, {-5, 4}};
  return {{0, -6}, {5, 0}, {0, 6}, {-5, 0}};
}

}  // namespace

std::string svg_line(SvgPoint a, SvgPoint b, const SvgStroke& stroke) {
  return "<line" + attribute("x1", number(a.x)) + attribute("y1", number(a.y)) +
         attribute("x2", number(b.x)) + attribute("y2", number(b.y)) + stroke_attributes(stroke) +
         "/>\n";
}

std::string svg_polyline(const std::vector<SvgPoint>& points, const SvgStroke& stroke) {
  return "<polyline fill=\"none\"" + attribute("points", point_list(points)) +
         stroke_attributes(stroke) + "/>\n";
}

std::string svg_rectangle(SvgPoint low, SvgPoint high, const std::string& fill) {
  return "<rect" + attribute("x", number(low.x)) + attribute("y", number(low.y)) +
         attribute("width", number(high.x - low.x)) + attribute("height", number(high.y - low.y)) +
         attribute("fill", fill) + "/>\n";
}

std::string svg_text(SvgPoint at, const SvgText& text) {
  constexpr const char* anchors[] = {"start", "middle", "end"};
  const std::string place = number(at.x) + " " + number(at.y);
  return "<text" + attribute("x", number(at.x)) + attribute("y", number(at.y)) +
         attribute("font-size", number(text.size)) + attribute("fill", text.colour) +
         attribute("text-anchor", anchors[static_cast<int>(text.anchor)]) +
         (text.is_bold ? " font-weight=\"bold\"" : "") +
         (text.is_upright ? attribute("transform", "rotate(-90 " + place + ")") : "") + ">" +
         escaped_xml(text.text) + "</text>\n";
}

std::string svg_marker(SvgPoint at, int shape, const std::string& colour, bool is_filled,
                       const std::string& title) {
  const std::string look = (title.empty() ? "" : attribute("class", "point")) +
                           attribute("fill", is_filled ? colour : "#ffffff") +
                           attribute("stroke", colour) + " stroke-width=\"1.6\"";
  const std::string tail = ">" + (title.empty() ? "" : "<title>" + escaped_xml(title) + "</title>");
  if (shape % 4 == 0)
    return "<circle" + attribute("cx", number(at.x)) + attribute("cy", number(at.y)) +
           " r=\"4.5\"" + look + tail + "</circle>\n";
  std::vector<SvgPoint> corners = marker_corners(shape % 4);
  for (SvgPoint& p : corners) p = {at.x + p.x, at.y + p.y};
  return "<polygon" + attribute("points", point_list(corners)) + look + tail + "</polygon>\n";
}

std::string svg_document(double width, double height, const std::string& title,
                         const std::string& content) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", number(width)) +
         attribute("height", number(height)) +
         attribute("viewBox", "0 0 " + number(width) + " " + number(height)) +
         " font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\">\n<title>" + escaped_xml(title) +
         "</title>\n" + svg_rectangle({0, 0}, {width, height}, "#ffffff") + content + "</svg>\n";
}

}  // namespace trocar
