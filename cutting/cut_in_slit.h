// Where a blade runs in a slit that is there already, or closely beside it.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "cutting/cut_stroke.h"
#include "mesh/mesh.h"

namespace trocar {

// Facets that other strokes have opened, but for those at the front of a slit. What a blade crosses
// at most 0.15 mean edges beside them, along them, has been parted already; so has what it crosses
// a mean edge beside them where one of these strokes has crossed the same. Not around the ends of
// such a stroke: there the blade goes on with it (cut_go_on.h).
class OlderSlits {
 public:
  // Of these elements of the mesh; h: mean edge [m].
  OlderSlits(const Mesh& mesh, std::span<const std::int32_t> elements, const CutStroke& stroke,
             double h);
  enum class Place : std::uint8_t { outside, inside, near_front };
  // X: a crossing, N: unit normal of the band there, reference configuration.
  Place place_of(const Vec3& X, const Vec3& N) const;

 private:
  struct Lip {
    std::array<Vec3, 3> X;
    Vec3 normal;         // unit
    bool is_near_front;  // shares a node with a facet at the front
  };
  std::vector<Lip> lips_;
  std::vector<SurfacePoint> parted_, at_end_;  // as in CutLeft, around the elements
  double h_;                                   // [m]
};

}  // namespace trocar
