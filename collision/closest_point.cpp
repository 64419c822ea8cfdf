#include "collision/closest_point.h"

#include <algorithm>

#include "base/segment.h"

namespace trocar {

namespace {

// For a triangle without area, whose face has no region of its own.
TrianglePoint closest_point_on_edges(const Vec3& p, const Triangle& x) {
  TrianglePoint best;
  double best2 = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const double t = share_to<Vec3>(x[k], x[next] - x[k], p);
    const Vec3 point = point_at({x[k], x[next]}, t);
    const double distance2 = (p - point).squaredNorm();
    if (best2 >= 0 && distance2 >= best2) continue;
    best2 = distance2;
    best = {.point = point};
    best.weight[k] = 1 - t;
    best.weight[next] = t;
  }
  return best;
}

double unit_clamp(double t) {
  return std::clamp(t, 0.0, 1.0);
}

}  // namespace

TrianglePoint with_weights(const Triangle& x, const std::array<double, 3>& w) {
  return {.point = w[0] * x[0] + w[1] * x[1] + w[2] * x[2], .weight = w};
}

TrianglePoint closest_point_triangle(const Vec3& p, const Triangle& x) {
  const Vec3 ab = x[1] - x[0], ac = x[2] - x[0];
  const Vec3 ap = p - x[0], bp = p - x[1], cp = p - x[2];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return with_weights(x, {1, 0, 0});
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return with_weights(x, {0, 1, 0});
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return with_weights(x, {0, 0, 1});
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) {
    const double v = d1 / (d1 - d3);
    return with_weights(x, {1 - v, v, 0});
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) {
    const double w = d2 / (d2 - d6);
    return with_weights(x, {1 - w, 0, w});
  }
  const double va = d3 * d6 - d5 * d4;
  const double to_c = d4 - d3, to_b = d5 - d6;
  if (va <= 0 && to_c >= 0 && to_b >= 0 && to_c + to_b > 0) {
    const double w = to_c / (to_c + to_b);
    return with_weights(x, {0, 1 - w, w});
  }
  const double sum = va + vb + vc;
  if (!(va > 0 && vb > 0 && vc > 0)) return closest_point_on_edges(p, x);
  // 1 less the others may be -1e-17, which contact would take for a lever without end.
  return with_weights(x, {va / sum, vb / sum, vc / sum});
}

SegmentPair closest_points_segments(const Segment& first, const Segment& second) {
  const Vec3 d1 = first[1] - first[0], d2 = second[1] - second[0], r = first[0] - second[0];
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r), c = d1.dot(r);
  SegmentPair pair;
  if (a > 0 && e > 0) {
    const double b = d1.dot(d2);
    const double denominator = a * e - b * b;
    // Parallel within rounding: any s of the overlap is nearest, s = 0 is one of its ends.
    if (denominator > 1e-14 * a * e) pair.s = unit_clamp((b * f - c * e) / denominator);
    pair.t = (b * pair.s + f) / e;
    if (pair.t < 0) {
      pair.s = unit_clamp(-c / a);
    } else if (pair.t > 1) {
      pair.s = unit_clamp((b - c) / a);
    }
    pair.t = unit_clamp(pair.t);
  } else if (a > 0) {
    pair.s = unit_clamp(-c / a);
  } else if (e > 0) {
    pair.t = unit_clamp(f / e);
  }
  pair.first = point_at(first, pair.s);
  pair.second = point_at(second, pair.t);
  pair.distance2 = (pair.first - pair.second).squaredNorm();
  return pair;
}

bool clip_segment(const Segment& segment, const Vec3& origin, const Vec3& inside,
                  SegmentPart& part) {
  const double h0 = inside.dot(segment[0] - origin), h1 = inside.dot(segment[1] - origin);
  if (h0 < 0 && h1 < 0) return false;
  if (h0 < 0) part.t0 = std::max(part.t0, h0 / (h0 - h1));
  if (h1 < 0) part.t1 = std::min(part.t1, h0 / (h0 - h1));
  return part.t0 <= part.t1;
}

std::optional<SegmentPart> part_over_triangle(const Segment& segment, const Triangle& x,
                                              const Vec3& normal) {
  SegmentPart part;
  for (std::size_t k = 0; k < 3; ++k)
    if (!clip_segment(segment, x[k], normal.cross(x[(k + 1) % 3] - x[k]), part))
      return std::nullopt;
  return part;
}

namespace {

// Where the segment passes through the triangle's face.
std::optional<SegmentTrianglePair> crossing(const Segment& segment, const Triangle& x) {
  const std::optional<Vec3> n = unit_normal(x);
  if (!n) return std::nullopt;
  const double h0 = n->dot(segment[0] - x[0]), h1 = n->dot(segment[1] - x[0]);
  if ((h0 > 0) == (h1 > 0) || h0 == h1) return std::nullopt;
  const std::optional<SegmentPart> part = part_over_triangle(segment, x, *n);
  const double t = h0 / (h0 - h1);
  if (!part || t < part->t0 || t > part->t1) return std::nullopt;
  const Vec3 p = point_at(segment, t);
  return SegmentTrianglePair{.on_segment = p, .on_triangle = closest_point_triangle(p, x)};
}

}  // namespace

SegmentTrianglePair closest_points_segment_triangle(const Segment& segment, const Triangle& x) {
  if (const auto pair = crossing(segment, x)) return *pair;
  SegmentTrianglePair best;
  bool is_first = true;
  const auto offer = [&](const Vec3& p, const TrianglePoint& q) {
    const double distance2 = (p - q.point).squaredNorm();
    if (!is_first && distance2 >= best.distance2) return;
    is_first = false;
    best = {.on_segment = p, .on_triangle = q, .distance2 = distance2};
  };
  for (const Vec3& end : segment) offer(end, closest_point_triangle(end, x));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const SegmentPair pair = closest_points_segments(segment, {x[k], x[next]});
    TrianglePoint q{.point = pair.second};
    q.weight[k] = 1 - pair.t;
    q.weight[next] = pair.t;
    offer(pair.first, q);
  }
  return best;
}

}  // namespace trocar
