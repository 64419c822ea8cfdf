#include "engine/locate.h"

#include <algorithm>
#include <ranges>
#include <tuple>

#include "base/box.h"
#include "mesh/barycentric.h"
#include "mesh/element_boxes.h"
#include "mesh/hex_split.h"

namespace trocar {

namespace {

// Weights of an element's corners and the least of them that tells whether the element holds the
// point.
struct Weights {
  std::array<double, max_corners> weight{};
  double least = -1e300;
};

Weights simplex_weights(std::span<const std::int32_t> corner, std::span<const Vec3> x,
                        const Vec3& p) {
  const std::array<double, 4> weight = barycentric(corner, x, p);
  Weights w;
  std::copy(weight.begin(), weight.end(), w.weight.begin());
  w.least = *std::min_element(weight.begin(),
                              weight.begin() + static_cast<std::ptrdiff_t>(corner.size()));
  return w;
}

// Of the tetrahedron of the hexahedron whose least weight is largest.
Weights hexahedron_weights(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x,
                           const Vec3& p) {
  Weights best;
  for (const std::array<int, 4>& tet : hex_tets(mesh, e)) {
    const Weights w = simplex_weights(tet_nodes(mesh, e, tet), x, p);
    if (w.least <= best.least) continue;
    best = {.least = w.least};
    for (std::size_t a = 0; a < 4; ++a) best.weight[tet[a]] = w.weight[a];
  }
  return best;
}

Weights weights_of(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x, const Vec3& p) {
  if (mesh.element_type[e] == ElementType::hex8) return hexahedron_weights(mesh, e, x, p);
  return simplex_weights(mesh.corners(e), x, p);
}

constexpr double margin = 1e-12;

// `elements`: ascending numbers.
template <class Elements>
std::vector<Location> locate_in(const Mesh& mesh, std::span<const Vec3> x,
                                std::span<const Vec3> points, const Elements& elements) {
  std::vector<Location> location(points.size());
  const Box all = bounding_box(points);
  for (const std::int32_t e : elements) {
    const Box box = element_box(mesh, e, x);
    if (!box.overlaps(all, margin)) continue;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (location[k].element >= 0 || !box.holds(points[k], margin)) continue;
      const Weights w = weights_of(mesh, e, x, points[k]);
      if (w.least >= -margin) location[k] = {.element = e, .weight = w.weight};
    }
  }
  return location;
}

// Shares of a segment's way, 0 at its begin, and the element that has it.
struct Stretch {
  double begin = 0, end = 1;
  std::int32_t element = -1;
};

// Takes from the stretch what is outside a simplex: weights are linear along the segment.
void clip(std::span<const std::int32_t> corner, std::span<const Vec3> x,
          const std::array<Vec3, 2>& segment, Stretch& stretch) {
  const std::array<double, 4> first = barycentric(corner, x, segment[0]),
                              last = barycentric(corner, x, segment[1]);
  for (std::size_t a = 0; a < corner.size(); ++a) {
    const double from = first[a] + margin, to = last[a] + margin;
    if (from < 0 && to < 0) stretch.end = -1;
    if (from < 0 && to >= 0) stretch.begin = std::max(stretch.begin, from / (from - to));
    if (from >= 0 && to < 0) stretch.end = std::min(stretch.end, from / (from - to));
  }
}

void add_stretches(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x,
                   const std::array<Vec3, 2>& segment, std::vector<Stretch>& stretches) {
  const auto add = [&](std::span<const std::int32_t> corner) {
    Stretch stretch{.element = e};
    clip(corner, x, segment, stretch);
    if (stretch.begin < stretch.end) stretches.push_back(stretch);
  };
  if (mesh.element_type[e] != ElementType::hex8) return add(mesh.corners(e));
  for (const std::array<std::int32_t, 4>& corner : hex_tet_nodes(mesh, e)) add(corner);
}

}  // namespace

std::vector<SegmentPiece> locate_segment(const Mesh& mesh, std::span<const Vec3> x,
                                         const std::array<Vec3, 2>& segment,
                                         std::span<const std::int32_t> near) {
  std::vector<Stretch> stretches;
  const Box all = box_around(segment);
  for (const std::int32_t e : near)
    if (element_box(mesh, e, x).overlaps(all, margin))
      add_stretches(mesh, e, x, segment, stretches);
  std::ranges::sort(stretches, {}, [](const Stretch& s) { return std::tuple(s.begin, s.element); });
  const Vec3 way = segment[1] - segment[0];
  std::vector<SegmentPiece> pieces;
  double done = 0;
  for (const Stretch& stretch : stretches) {
    const double begin = std::max(done, stretch.begin);
    if (stretch.end <= begin + margin) continue;
    const Vec3 middle = segment[0] + 0.5 * (begin + stretch.end) * way;
    pieces.push_back({.middle = {.element = stretch.element,
                                 .weight = weights_of(mesh, stretch.element, x, middle).weight},
                      .length = (stretch.end - begin) * way.norm()});
    done = stretch.end;
  }
  return pieces;
}

std::vector<Location> locate_points(const Mesh& mesh, std::span<const Vec3> x,
                                    std::span<const Vec3> points) {
  return locate_in(mesh, x, points, std::views::iota(0, mesh.n_elements()));
}

std::vector<Location> locate_points(const Mesh& mesh, std::span<const Vec3> x,
                                    std::span<const Vec3> points,
                                    std::span<const std::int32_t> near) {
  return locate_in(mesh, x, points, near);
}

Box box_around(std::span<const Vec3> points) {
  return bounding_box(points).grown(2 * margin);
}

Location locate_nearest(const Mesh& mesh, std::span<const Vec3> x, const Vec3& point) {
  Location nearest = locate_points(mesh, x, std::span(&point, 1))[0];
  if (nearest.element >= 0) return nearest;
  double best = -1e300;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const Weights w = weights_of(mesh, e, x, point);
    if (w.least > best) {
      best = w.least;
      nearest = {.element = e, .weight = w.weight};
    }
  }
  return nearest;
}

Vec3 interpolate(const Mesh& mesh, const Location& location, std::span<const Vec3> field) {
  return interpolate(mesh.corners(location.element), location.weight, field);
}

}  // namespace trocar
