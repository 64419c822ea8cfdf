#include "cutting/cut_plane_slit.h"

#include <algorithm>
#include <cmath>

#include "base/segment.h"
#include "cutting/cut_plane_path.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

constexpr double beside = 0.3;       // h, off a lip, of a path that runs in the slit
constexpr double spacing = 0.1;      // h, between two looks at the path
constexpr double along_lip = 0.966;  // cosine of the path to a lip that it runs along: 15 degrees
constexpr double on_lip = 0.01;      // h
constexpr double wavering = 0.5;     // h
constexpr double at_tip = 0.45;      // h, of a path that leaves the slit there

// A facet that a cut has opened, the tissue to its left.
struct Lip {
  std::array<std::int32_t, 2> node;
  Vec2 from, along;

  Vec2 foot(const Vec2& p) const { return from + share_to(from, along, p) * along; }
  bool is_beside(const Vec2& p) const {
    constexpr double slack = 0.05;  // over the lip's length: an end may have slid along a surface
    const double t = share_on_line(from, along, p);
    return t >= -slack && t <= 1 + slack;
  }
};

std::vector<Lip> find_lips(const Mesh& mesh) {
  std::vector<Lip> lips;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      if ((mesh.cut_facets[e] >> f & 1) == 0) continue;
      const std::array<int, 4> corner = facet_corners(ElementType::tri3, f);
      const std::int32_t a = mesh.corners(e)[corner[0]], b = mesh.corners(e)[corner[1]];
      lips.push_back({{a, b}, mesh.X[a].head<2>(), (mesh.X[b] - mesh.X[a]).head<2>()});
    }
  return lips;
}

// Over half an edge to both sides of s, as far as the path goes: tissue that the blade pushes aside
// lets it waver. Not where it has just begun at a tip, which may be a bend.
Vec2 way_around(const SubPath& path, double s, double h) {
  if (path.tip >= 0 && s < wavering * h) return tangent(path, s);
  return position(path, std::min(path.length(), s + wavering * h)) -
         position(path, std::max(0.0, s - wavering * h));
}

bool is_in_slit(std::span<const Lip> lips, const SubPath& path, double s, double h) {
  const Vec2 p = position(path, s), way = tangent(path, s), around = way_around(path, s, h);
  const auto is_along = [](const Lip& lip, const Vec2& d) {
    return std::abs(lip.along.dot(d)) >= along_lip * lip.along.norm() * d.norm();
  };
  return std::ranges::any_of(lips, [&](const Lip& lip) {
    return (is_along(lip, way) || is_along(lip, around)) && lip.is_beside(p) &&
           (p - lip.foot(p)).norm() <= beside * h;
  });
}

bool is_in_body(const Mesh& mesh, const Vec2& p) {
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const auto X = [&](int a) -> Vec2 { return mesh.X[mesh.corners(e)[a]].head<2>(); };
    if (is_in_triangle(X(0), X(1), X(2), p, 1e-6)) return true;
  }
  return false;
}

// Arc length up to which the path runs in the slit. It may come to its mouth from outside, or turn
// into it within `ahead`: one that begins on a lip goes on beside it.
double length_in_slit(const Mesh& mesh, std::span<const Lip> lips, const SubPath& path,
                      double ahead, double h) {
  double in_slit = 0;
  bool has_met = false;
  for (int k = 0; (k - 1) * spacing * h < path.length(); ++k) {
    const double s = std::min(k * spacing * h, path.length());
    if (is_in_slit(lips, path, s, h)) {
      has_met = true;
      in_slit = s;
    } else if (has_met || (s >= ahead && is_in_body(mesh, position(path, s)))) {
      break;
    }
  }
  return in_slit;
}

// Whether the second lip begins where the first ends and leads back along it, with no tissue
// between them: there is the slit's tip.
bool meet_at_tip(const Lip& to, const Lip& from) {
  constexpr double back = -0.9, rounding = 1e-6;
  const double lengths = to.along.norm() * from.along.norm();
  return to.node[1] == from.node[0] && to.along.dot(from.along) < back * lengths &&
         cross(to.along, from.along) <= rounding * lengths;
}

bool is_tip(std::span<const Lip> lips, std::int32_t node) {
  return std::ranges::any_of(lips, [&](const Lip& to) {
    return to.node[1] == node &&
           std::ranges::any_of(lips, [&](const Lip& from) { return meet_at_tip(to, from); });
  });
}

// The slit's tip at p; -1: none.
std::int32_t find_tip(const Mesh& mesh, std::span<const Lip> lips, const Vec2& p, double h) {
  std::int32_t nearest = -1;
  double least = at_tip * h;
  for (const Lip& lip : lips) {
    const double distance = (mesh.X[lip.node[1]].head<2>() - p).norm();
    if (distance >= least || !is_tip(lips, lip.node[1])) continue;
    least = distance;
    nearest = lip.node[1];
  }
  return nearest;
}

SubPath path_along(std::span<const Vec3> points) {
  std::vector<Vec2> point;
  for (const Vec3& X : points) point.emplace_back(X.head<2>());
  return make_sub_path(std::move(point));
}

Vec2 nearest_on_lips(std::span<const Lip> lips, const Vec2& p) {
  const auto nearest = std::ranges::min_element(
      lips, {}, [&](const Lip& lip) { return (p - lip.foot(p)).squaredNorm(); });
  return nearest->foot(p);
}

}  // namespace

PathFromSlit past_slit(const Mesh& mesh, std::span<const Vec3> path, std::int32_t tip, double h) {
  const std::vector<Lip> lips = find_lips(mesh);
  if (tip >= 0 && !is_tip(lips, tip)) tip = -1;  // another blade has gone on from there
  const PathFromSlit as_it_is{{path.begin(), path.end()}, tip};
  if (lips.empty() || path.size() < 2) return as_it_is;
  SubPath whole = path_along(path);
  whole.tip = tip;
  const double off = (nearest_on_lips(lips, whole.point[0]) - whole.point[0]).norm();
  const bool is_on_lip = tip < 0 && off < on_lip * h;
  const double s = length_in_slit(mesh, lips, whole, is_on_lip ? at_tip * h : 0, h);
  const Vec2 end = position(whole, s);
  const std::int32_t at = s < whole.length() ? find_tip(mesh, lips, end, h) : -1;
  if (s == 0 && (at < 0 || tip >= 0)) return as_it_is;
  const Vec2 start = at >= 0 ? Vec2(mesh.X[at].head<2>()) : nearest_on_lips(lips, end);
  PathFromSlit rest{{Vec3(start.x(), start.y(), path.front().z())}, at};
  for (std::size_t k = 0; k < path.size(); ++k)
    if (whole.s[k] > s) rest.point.push_back(path[k]);
  return rest;
}

std::vector<Vec3> before_slit(const Mesh& mesh, const PathFromSlit& path, double h) {
  if (path.point.size() < 2 || path_along(path.point).length() < h) return path.point;
  const std::vector<Vec3> back(path.point.rbegin(), path.point.rend());
  const PathFromSlit before = past_slit(mesh, back, -1, h);
  if (before.point.size() < 2 || (before.tip >= 0 && before.tip == path.tip)) return path.point;
  return {before.point.rbegin(), before.point.rend()};
}

}  // namespace trocar
