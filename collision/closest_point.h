// Closest points of points, segments and triangles (Ericson, Real-Time Collision Detection, 2005,
// chapter 5), as pure functions. Degenerate input is allowed: a segment may be a point.
#pragma once

#include <array>
#include <optional>

#include "base/triangle.h"
#include "base/vec.h"

namespace trocar {

using Segment = std::array<Vec3, 2>;

// A point of a triangle: its position and its barycentric weights (sum 1, none negative).
struct TrianglePoint {
  Vec3 point = Vec3::Zero();
  std::array<double, 3> weight{};
};
TrianglePoint with_weights(const Triangle& triangle, const std::array<double, 3>& weight);
TrianglePoint closest_point_triangle(const Vec3& p, const Triangle& triangle);

// s and t in [0, 1] along the two segments.
struct SegmentPair {
  double s = 0, t = 0;
  Vec3 first = Vec3::Zero(), second = Vec3::Zero();
  double distance2 = 0;
};
SegmentPair closest_points_segments(const Segment& first, const Segment& second);

// distance2 is 0 where the segment crosses the triangle.
struct SegmentTrianglePair {
  Vec3 on_segment = Vec3::Zero();
  TrianglePoint on_triangle;
  double distance2 = 0;
};
SegmentTrianglePair closest_points_segment_triangle(const Segment& segment,
                                                    const Triangle& triangle);

// The part of a segment, [t0, t1], whose projection along the triangle's normal lies in the
// triangle; nothing if there is none. normal: unit_normal(triangle).
struct SegmentPart {
  double t0 = 0, t1 = 1;
};
std::optional<SegmentPart> part_over_triangle(const Segment& segment, const Triangle& triangle,
                                              const Vec3& normal);
// Cuts `part` by the half-space inside·(x - origin) >= 0; false if nothing is left.
bool clip_segment(const Segment& segment, const Vec3& origin, const Vec3& inside,
                  SegmentPart& part);

inline Vec3 point_at(const Segment& segment, double t) {
  return segment[0] + t * (segment[1] - segment[0]);
}

}  // namespace trocar
