#include "cutting/cut_in_slit.h"

#include <algorithm>

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
  for (const OpenFacet& facet : facets) {
    if (is_at_front(facet, facets)) continue;
    const auto X = [&](std::size_t k) { return mesh.X[facet.node[k]]; };
    lips_.push_back({{X(0), X(1), X(2)}, facet.normal});
  }
}

bool OlderSlits::hold(const Vec3& X, const Vec3& N) const {
  return std::ranges::any_of(lips_, [&](const Lip& lip) {
    const Vec3 way = X - lip.X[0];
    if (std::abs(lip.normal.dot(way)) > beside_ || std::abs(lip.normal.dot(N)) < least_cosine)
      return false;
    const Vec3 p = lip.X[1] - lip.X[0], q = lip.X[2] - lip.X[0], n = p.cross(q);
    const double v = n.dot(way.cross(q)) / n.squaredNorm(),
                 w = n.dot(p.cross(way)) / n.squaredNorm();
    return v >= -slack && w >= -slack && v + w <= 1 + slack;
  });
}

}  // namespace trocar
