#include "cutting/cut_in_slit.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/box.h"
#include "base/sort_unique.h"
#include "base/triangle.h"
#include "cutting/cut_patch.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

// How far from a lip, or from where a blade has been, a crossing counts as parted (over h, cosine
// of the angle between the surfaces, barycentric).
struct Reach {
  double beside, cosine, slack;
};
constexpr Reach strict{0.15, 0.966, 0.05};
// Lips lie that far from the blade that parted them, and turn to and fro about its surface.
constexpr Reach where_parted{1, 0.3, 0.3};

// A facet that another stroke has opened, and its unit normal out of the element.
struct OpenFacet {
  std::array<std::int32_t, 3> node;
  Vec3 normal;
};

std::vector<OpenFacet> older_facets(const Mesh& mesh, std::span<const std::int32_t> elements,
                                    const CutStroke& stroke) {
  std::vector<OpenFacet> facets;
  for (const std::int32_t e : elements) {
    unsigned mask = mesh.cut_facets[e];
    if (mask == 0) continue;
    if (const std::uint8_t* own = find_element(stroke.opened, e)) mask &= ~unsigned{*own};
    for (int f = 0; mask >> f != 0; ++f) {
      if ((mask >> f & 1) == 0) continue;
      const std::array<int, 4> corner = facet_corners(ElementType::tet4, f);
      OpenFacet facet;
      for (std::size_t k = 0; k < 3; ++k) facet.node[k] = mesh.corners(e)[corner[k]];
      const auto X = [&](std::size_t k) { return mesh.X[facet.node[k]]; };
      facet.normal = area_normal({X(0), X(1), X(2)}).normalized();
      facets.push_back(facet);
    }
  }
  return facets;
}

// Of each facet, whether both lips have a node of it: it lies at the slit's front, where the cut
// goes on.
std::vector<std::uint8_t> are_at_front(std::span<const OpenFacet> facets) {
  std::vector<std::pair<std::int32_t, std::size_t>> use;  // node, facet
  for (std::size_t k = 0; k < facets.size(); ++k)
    for (const std::int32_t i : facets[k].node) use.emplace_back(i, k);
  std::ranges::sort(use);
  std::vector<std::uint8_t> is_at_front(facets.size(), 0);
  for (auto begin = use.begin(); begin != use.end();) {
    const auto end = std::find_if(begin, use.end(),
                                  [&](const auto& other) { return other.first != begin->first; });
    for (auto a = begin; a != end; ++a)
      for (auto b = begin; b != a; ++b)
        if (facets[a->second].normal.dot(facets[b->second].normal) < 0)
          is_at_front[a->second] = is_at_front[b->second] = 1;
    begin = end;
  }
  return is_at_front;
}

// Of points that ascend by x those at most h beside the elements' box.
std::vector<SurfacePoint> points_near(const Mesh& mesh, std::span<const std::int32_t> elements,
                                      double h, std::span<const SurfacePoint> points) {
  Box box;
  for (const std::int32_t e : elements)
    for (const std::int32_t i : mesh.corners(e)) box.add(mesh.X[i]);
  const auto x = [](const SurfacePoint& p) { return p.X.x(); };
  const auto begin = std::ranges::lower_bound(points, box.low.x() - h, {}, x),
             end = std::ranges::upper_bound(points, box.high.x() + h, {}, x);
  std::vector<SurfacePoint> near;
  std::copy_if(begin, end, std::back_inserter(near),
               [&](const SurfacePoint& p) { return box.holds(p.X, h); });
  return near;
}

}  // namespace

OlderSlits::OlderSlits(const Mesh& mesh, std::span<const std::int32_t> elements,
                       const CutStroke& stroke, double h)
    : h_(h) {
  const std::vector<OpenFacet> facets = older_facets(mesh, elements, stroke);
  std::vector<OpenFacet> lips;
  std::vector<std::int32_t> front;  // nodes
  const std::vector<std::uint8_t> is_at_front = are_at_front(facets);
  for (std::size_t k = 0; k < facets.size(); ++k)
    if (is_at_front[k] != 0)
      front.insert(front.end(), facets[k].node.begin(), facets[k].node.end());
    else
      lips.push_back(facets[k]);
  sort_unique(front);
  const auto is_front = [&](std::int32_t i) { return std::ranges::binary_search(front, i); };
  for (const auto& [node, normal] : lips)
    lips_.push_back({{mesh.X[node[0]], mesh.X[node[1]], mesh.X[node[2]]},
                     normal,
                     std::ranges::any_of(node, is_front)});
  if (lips_.empty()) return;
  parted_ = points_near(mesh, elements, h, stroke.left.parted);
  at_end_ = points_near(mesh, elements, h, stroke.left.at_end);
}

// The nearest of them; nullptr if it lies farther than h, or X not along the surface there.
static const SurfacePoint* point_along(const std::vector<SurfacePoint>& points, const Vec3& X,
                                       const Vec3& N, double h) {
  const auto distance = [&](const SurfacePoint& p) { return (p.X - X).squaredNorm(); };
  const auto nearest = std::ranges::min_element(points, {}, distance);
  const bool is_along = nearest != points.end() && distance(*nearest) < h * h &&
                        std::abs(nearest->N.dot(N)) >= strict.cosine &&
                        std::abs(nearest->N.dot(X - nearest->X)) <= strict.beside * h;
  return is_along ? &*nearest : nullptr;
}

OlderSlits::Place OlderSlits::place_of(const Vec3& X, const Vec3& N) const {
  if (lips_.empty()) return Place::outside;
  const SurfacePoint* const parted = point_along(parted_, X, N, h_);
  if (parted != nullptr && std::ranges::find(at_end_, parted->X, &SurfacePoint::X) != at_end_.end())
    return Place::outside;
  const Reach& reach = parted != nullptr ? where_parted : strict;
  const auto holds = [&](const Lip& lip) {
    return std::abs(lip.normal.dot(X - lip.X[0])) <= reach.beside * h_ &&
           std::abs(lip.normal.dot(N)) >= reach.cosine && least_share(lip.X, X) >= -reach.slack;
  };
  Place place = Place::outside;
  for (const Lip& lip : lips_)
    if ((place == Place::outside || lip.is_near_front) && holds(lip))
      place = lip.is_near_front ? Place::near_front : Place::inside;
  return place;
}

}  // namespace trocar
