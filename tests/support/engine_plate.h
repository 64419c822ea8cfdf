// A plate in its plane, and the way of a scalpel's tip along it.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace trocar {

// Of a path, in s and mm.
inline std::string key(double time, double x, double y, double z) {
  const auto mm = [](double a) { return "\"" + std::to_string(a) + " mm\""; };
  return "{ time = " + std::to_string(time) + ", position = [" + mm(x) + ", " + mm(y) + ", " +
         mm(z) + "], direction = [0, 0, -1] },\n";
}

// The keys in a text with a way that the edge faces.
inline std::string facing(std::string text, const std::string& forward) {
  const std::string direction = "direction = [0, 0, -1]";
  for (std::size_t at = text.find(direction); at != std::string::npos;
       at = text.find(direction, at + 1))
    text.insert(at + direction.size(), ", forward = " + forward);
  return text;
}

// A plate of 70 x 40 mm, 20 x 16 cells, and a scalpel with these keys.
inline std::string plate_with_keys(const std::string& keys) {
  return "[time]\nduration = 4\n[tissue]\nthickness = 0.005\n[tissue.shape]\nkind = \"rectangle\"\n"
         "high = [0.07, 0.04, 0]\ncells = [20, 16, 1]\n[solver]\nmass_damping = 20\n"
         "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n"
         "[[instrument]]\nkind = \"scalpel\"\nradius = 0.001\npath = [\n" +
         keys + "]\n";
}

// The same; the tip goes along the points [mm] at 50 mm/s.
inline std::string plate_text(const std::vector<std::pair<double, double>>& points) {
  std::string keys;
  double time = 0.1;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [x, y] = points[k];
    if (k > 0) time += std::hypot(x - points[k - 1].first, y - points[k - 1].second) / 50;
    keys += key(time, x, y, 0);
  }
  return plate_with_keys(keys + key(time + 0.1, points.back().first, points.back().second, 20));
}

}  // namespace trocar
