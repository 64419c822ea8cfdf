// Closed surfaces of instruments' primitives: surfaces of revolution, boxes and plates.
#include "mesh/triangle_mesh.h"

#include <string>

#include "base/error.h"

namespace trocar {

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = static_cast<std::int32_t>(mesh.X.size());
  mesh.X.insert(mesh.X.end(), other.X.begin(), other.X.end());
  for (const auto& [a, b, c] : other.triangle)
    mesh.triangle.push_back({first + a, first + b, first + c});
}

// (cos, sin) of a quarter turn times k / n, 0 <= k <= n, by the Taylor series to 1e-22: shapes are
// on the path of the state, and libm's sine may differ between machines.
static Vec2 quarter_turn(int k, int n) {
  constexpr double half_pi = 1.57079632679489661923;
  const double angle = half_pi * k / n;
  double cosine = 0, sine = 0, term = 1;
  for (int power = 0; power < 28; ++power) {
    (power % 2 == 0 ? cosine : sine) += (power / 2) % 2 == 0 ? term : -term;
    term *= angle / (power + 1);
  }
  return {cosine, sine};
}

// Point k of n on the unit circle, exact at the quarter turns.
static Vec2 circle_point(int k, int n) {
  const Vec2 p = quarter_turn(4 * k % n, n);
  switch (4 * k / n % 4) {
    case 0:
      return p;
    case 1:
      return {-p.y(), p.x()};
    case 2:
      return -p;
    default:
      return {p.y(), -p.x()};
  }
}

// A point of the profile of a surface of revolution: position along the axis and distance from it.
struct ProfilePoint {
  double along = 0, radius = 0;
};
// Where the axis starts and its frame, right-handed: side x other = axis.
struct AxisFrame {
  Vec3 origin, axis, side, other;
};

static AxisFrame axis_frame(const Vec3& origin, const Vec3& direction) {
  AxisFrame frame;
  frame.origin = origin;
  frame.axis = direction.normalized();
  // The coordinate direction that is least along the axis, the first one of equals.
  Eigen::Index least = 0;
  frame.axis.cwiseAbs().minCoeff(&least);
  frame.side = frame.axis.cross(Vec3::Unit(least)).normalized();
  frame.other = frame.axis.cross(frame.side);
  return frame;
}

// First vertex of each ring (a point on the axis has one vertex), then the number of vertices.
static std::vector<std::int32_t> add_rings(TriangleMesh& mesh, const AxisFrame& frame,
                                           const std::vector<ProfilePoint>& profile, int n) {
  std::vector<std::int32_t> ring;
  for (const ProfilePoint& point : profile) {
    ring.push_back(static_cast<std::int32_t>(mesh.X.size()));
    const Vec3 centre = frame.origin + point.along * frame.axis;
    if (point.radius == 0) mesh.X.push_back(centre);
    for (int k = 0; k < n && point.radius > 0; ++k) {
      const Vec2 p = point.radius * circle_point(k, n);
      mesh.X.push_back(centre + p.x() * frame.side + p.y() * frame.other);
    }
  }
  ring.push_back(static_cast<std::int32_t>(mesh.X.size()));
  return ring;
}

// The profile runs along the axis and begins and ends on it (radius 0).
static TriangleMesh surface_of_revolution(const AxisFrame& frame,
                                          const std::vector<ProfilePoint>& profile, int n) {
  TriangleMesh mesh;
  const std::vector<std::int32_t> ring = add_rings(mesh, frame, profile, n);
  for (std::size_t j = 0; j + 1 < profile.size(); ++j) {
    const bool has_low = profile[j].radius > 0, has_high = profile[j + 1].radius > 0;
    for (int k = 0; k < n; ++k) {
      const int next = (k + 1) % n;
      const std::int32_t a = ring[j] + (has_low ? k : 0), b = ring[j] + (has_low ? next : 0);
      const std::int32_t c = ring[j + 1] + (has_high ? next : 0);
      const std::int32_t d = ring[j + 1] + (has_high ? k : 0);
      if (has_low) mesh.triangle.push_back({a, b, c});
      if (has_high) mesh.triangle.push_back({a, c, d});
    }
  }
  return mesh;
}

static void check_shape(double radius, int n) {
  if (!(radius > 0)) throw InputError("the radius of a shape must be positive");
  if (n < 3)
    throw InputError("a round shape needs at least 3 segments round its axis, not " +
                     std::to_string(n));
}

static double check_axis(const Vec3& a, const Vec3& b) {
  const double length = (b - a).norm();
  if (!(length > 0)) throw InputError("the two ends of a shape's axis must differ");
  return length;
}

// Half circle of latitude from pole to equator, `from` and `to` in quarter turns of m steps.
static void add_arc(std::vector<ProfilePoint>& profile, double centre, double radius, int from,
                    int to, int m) {
  for (int k = from; k <= to; ++k) {
    const Vec2 p = quarter_turn(k < 0 ? -k : k, m);
    const double along = k < 0 ? -p.y() : p.y();
    const bool is_pole = k == -m || k == m;
    profile.push_back(
        {centre + radius * (is_pole ? (k < 0 ? -1 : 1) : along), is_pole ? 0 : radius * p.x()});
  }
}

TriangleMesh make_sphere_surface(const Vec3& centre, double radius, int n) {
  check_shape(radius, n);
  const int m = n < 8 ? 2 : n / 4;
  std::vector<ProfilePoint> profile;
  add_arc(profile, 0, radius, -m, m, m);
  return surface_of_revolution(axis_frame(centre, Vec3::UnitZ()), profile, n);
}

TriangleMesh make_capsule_surface(const Vec3& a, const Vec3& b, double radius, int n) {
  check_shape(radius, n);
  const double length = check_axis(a, b);
  const int m = n < 8 ? 2 : n / 4;
  std::vector<ProfilePoint> profile;
  add_arc(profile, 0, radius, -m, 0, m);
  add_arc(profile, length, radius, 0, m, m);
  return surface_of_revolution(axis_frame(a, b - a), profile, n);
}

TriangleMesh make_cone_surface(const Vec3& a, const Vec3& b, double radius_a, double radius_b,
                               int n) {
  if (!(radius_a >= 0) || !(radius_b >= 0))
    throw InputError("the radii of a cone must not be negative");
  check_shape(radius_a > radius_b ? radius_a : radius_b, n);
  const double length = check_axis(a, b);
  std::vector<ProfilePoint> profile;
  profile.push_back({0, 0});
  if (radius_a > 0) profile.push_back({0, radius_a});
  if (radius_b > 0) profile.push_back({length, radius_b});
  profile.push_back({length, 0});
  return surface_of_revolution(axis_frame(a, b - a), profile, n);
}

TriangleMesh make_box_surface(const Vec3& low, const Vec3& high) {
  if (!(low.array() < high.array()).all())
    throw InputError("the low corner of a box must lie below the high corner in each direction");
  const std::vector<Vec3> outline = {{low.x(), low.y(), 0},
                                     {high.x(), low.y(), 0},
                                     {high.x(), high.y(), 0},
                                     {low.x(), high.y(), 0}};
  TriangleMesh mesh = make_plate_surface(outline, Vec3::UnitZ(), 1);
  for (Vec3& X : mesh.X) X.z() = X.z() < 0 ? low.z() : high.z();
  return mesh;
}

TriangleMesh make_plate_surface(const std::vector<Vec3>& outline, const Vec3& axis,
                                double thickness) {
  if (outline.size() < 3) throw InputError("the outline of a plate needs at least 3 points");
  if (!(thickness > 0)) throw InputError("the thickness of a plate must be positive");
  TriangleMesh mesh;
  const auto n = static_cast<std::int32_t>(outline.size());
  for (const Vec3& X : outline) mesh.X.push_back(X - thickness / 2 * axis);
  for (const Vec3& X : outline) mesh.X.push_back(X + thickness / 2 * axis);
  for (std::int32_t i = 1; i + 1 < n; ++i) {
    mesh.triangle.push_back({0, i + 1, i});
    mesh.triangle.push_back({n, n + i, n + i + 1});
  }
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t next = (i + 1) % n;
    mesh.triangle.push_back({i, next, n + next});
    mesh.triangle.push_back({i, n + next, n + i});
  }
  return mesh;
}

}  // namespace trocar
