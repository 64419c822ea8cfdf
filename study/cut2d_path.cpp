#include "study/cut2d_path.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/quoted.h"

namespace trocar {

namespace {

// Of a coordinate: squares and products of lengths stay exact enough and far from an overflow.
constexpr double farthest = 1e9;   // [mm]
constexpr double straight = 1e-9;  // sine of the turn of three points that count as one line

double read_number(const std::string& text, const std::string& point) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError("a point of a path is two numbers in mm as in 17.8,35.2, not " +
                     in_quotes(point));
  if (std::abs(value) > farthest)
    throw InputError("a point of a path lies within 1e9 mm of the axes, " + in_quotes(point) +
                     " does not: are its numbers in mm?");
  return value;
}

Vec3 read_point(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) read_number("", text);
  return {mm * read_number(text.substr(0, comma), text),
          mm * read_number(text.substr(comma + 1), text), 0};
}

// Centre of the circle through a, b and c.
Vec3 circle_centre(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 p = b - a, q = c - a;
  const Vec3 d = q * p.squaredNorm() - p * q.squaredNorm();
  return a + Vec3(d.y(), -d.x(), 0) / (2 * cross_z(p, q));
}

// Appends the arc from the last point to `to`, halved `depth` times by square roots alone. `sense`
// > 0 turns left: the arc is then to the right of its chord.
void add_arc(Cut2dPath& path, const Vec3& centre, const Vec3& to, double sense, int depth) {
  if (depth == 0) {
    path.push_back(to);
    return;
  }
  const Vec3 from = path.back(), chord = (to - from).normalized();
  const Vec3 outward = (sense > 0 ? 1.0 : -1.0) * Vec3(chord.y(), -chord.x(), 0);
  add_arc(path, centre, centre + (from - centre).norm() * outward, sense, depth - 1);
  add_arc(path, centre, to, sense, depth - 1);
}

}  // namespace

Cut2dPath read_path(const std::string& text) {
  std::istringstream words(text);
  Cut2dPath path;
  for (std::string word; words >> word;) {
    const Vec3 point = read_point(word);
    if (path.empty() || path.back() != point) path.push_back(point);
  }
  if (path.size() < 2)
    throw InputError("a path needs at least two different points as in '10,20 40,25', not " +
                     in_quotes(text));
  return path;
}

Cut2dPath read_arc(const std::string& text) {
  const Cut2dPath three = read_path(text);
  if (three.size() != 3 || three[0] == three[2])
    throw InputError("an arc goes through three different points, not " + in_quotes(text));
  const Vec3 p = three[1] - three[0], q = three[2] - three[1];
  const double sense = cross_z(p, q);
  if (std::abs(sense) < straight * p.norm() * q.norm()) return three;
  const Vec3 centre = circle_centre(three[0], three[1], three[2]);
  Cut2dPath path = {three[0]};
  add_arc(path, centre, three[1], sense, 5);
  add_arc(path, centre, three[2], sense, 5);
  return path;
}

}  // namespace trocar
