#include "cutting/cut_in_slit.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

constexpr double beside = 0.15;         // h
constexpr double least_cosine = 0.966;  // of the angle between band and lip
constexpr double slack = 0.05;          // barycentric

// A facet that another stroke has opened, and its unit normal out of the element.
struct OpenFacet {
  std::array<std::int32_t, 3> node;
  Vec3 normal;
};

std::vector<OpenFacet> older_facets(const Mesh& mesh, std::span<const std::int32_t> elements,
                                    const CutStroke& stroke) {
  std::vector<OpenFacet> facets;
  for (const std::int32_t e : elements) {
    unsigned mask = mesh.cut_facets[static_cast<std::size_t>(e)];
    if (mask == 0) continue;
    if (const std::uint8_t* own = find_element(stroke.opened, e)) mask &= ~unsigned{*own};
    for (int f = 0; mask >> f != 0; ++f) {
      if ((mask >> f & 1) == 0) continue;
      const std::array<int, 4> corner = facet_corners(ElementType::tet4, f);
      OpenFacet facet;
      for (std::size_t k = 0; k < 3; ++k) facet.node[k] = mesh.corners(e)[corner[k]];
      const auto X = [&](std::size_t k) { return mesh.X[facet.node[k]]; };
      facet.normal = (X(1) - X(0)).cross(X(2) - X(0)).normalized();
      facets.push_back(facet);
    }
  }
  return facets;
}

// Whether both lips have a node of the facet: it lies at the slit's front, where the cut goes on.
bool is_at_front(const OpenFacet& facet, std::span<const OpenFacet> facets) {
  return std::ranges::any_of(facets, [&](const OpenFacet& other) {
    return other.normal.dot(facet.normal) < 0 &&
           std::ranges::find_first_of(other.node, facet.node) != other.node.end();
  });
}

}  // namespace

OlderSlits::OlderSlits(const Mesh& mesh, std::span<const std::int32_t> elements,
                       const CutStroke& stroke, double h)
    : beside_(beside * h) {
  const std::vector<OpenFacet> facets = older_facets(mesh, elements, stroke);
  std::vector<OpenFacet> lips;
  std::vector<std::int32_t> front;  // nodes
  for (const OpenFacet& facet : facets)
    if (is_at_front(facet, facets))
      front.insert(front.end(), facet.node.begin(), facet.node.end());
    else
      lips.push_back(facet);
  sort_unique(front);
  const auto is_front = [&](std::int32_t i) { return std::ranges::binary_search(front, i); };
  for (const auto& [node, normal] : lips)
    lips_.push_back({{mesh.X[node[0]], mesh.X[node[1]], mesh.X[node[2]]},
                     normal,
                     std::ranges::any_of(node, is_front)});
}

OlderSlits::Place OlderSlits::place_of(const Vec3& X, const Vec3& N) const {
  const auto holds = [&](const Lip& lip) {
    const Vec3 way = X - lip.X[0];
    if (std::abs(lip.normal.dot(way)) > beside_ || std::abs(lip.normal.dot(N)) < least_cosine)
      return false;
    const Vec3 p = lip.X[1] - lip.X[0], q = lip.X[2] - lip.X[0], n = p.cross(q);
    const double v = n.dot(way.cross(q)) / n.squaredNorm(),
                 w = n.dot(p.cross(way)) / n.squaredNorm();
    return v >= -slack && w >= -slack && v + w <= 1 + slack;
  };
  Place place = Place::outside;
  for (const Lip& lip : lips_)
    if ((place == Place::outside || lip.is_near_front) && holds(lip))
      place = lip.is_near_front ? Place::near_front : Place::inside;
  return place;
}

}  // namespace trocar
