// Where a hull touches a triangle beside their nearest points: with those alone, a corner of the
// hull comes through one side of the triangle while the other one is being pushed out.
#pragma once

#include <array>
#include <cstddef>

#include "collision/narrow_phase.h"

namespace trocar {

struct ManifoldPoint {
  std::array<double, 3> weight{};  // of the point of the triangle
  Vec3 point = Vec3::Zero();       // of the hull [m]
  Vec3 normal = Vec3::Zero();      // from tool to tissue, unit
};

struct Manifold {
  // Of the hull's corners over the triangle those that reach deepest, and two of each edge.
  static constexpr std::size_t most_corners = 4, most_points = most_corners + 2 * 3;
  std::array<ManifoldPoint, most_points> of;
  std::size_t n_points = 0;

  const ManifoldPoint* begin() const { return of.data(); }
  const ManifoldPoint* end() const { return of.data() + n_points; }
};

// Corners of the hull over the triangle touch it along its normal. Edges of the triangle touch
// along the normal of the hull's face that the triangle lies on, where they cross that face's rim.
// (Its corners: ContactDetector::touch_node.) In the tool's frame; none of a core that is no hull
// or a flat one, none whose gap is margin or more, and none that lies much deeper in the hull than
// the nearest points, whose gap is nearest_gap: those have come from another side. [m]
Manifold find_manifold(const PieceCore& core, const Triangle& triangle, double nearest_gap,
                       double margin);

}  // namespace trocar
