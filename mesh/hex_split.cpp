// The lowest corner is joined to the two triangles of each facet that doesn't touch it.
#include "mesh/hex_split.h"

#include <algorithm>

#include "mesh/element_shape.h"

namespace trocar {

bool is_diagonal_at(const Mesh& mesh, std::int32_t i, std::int32_t j) {
  const std::int32_t a = mesh.uncut_node(i), b = mesh.uncut_node(j);
  const auto rank = [&](std::int32_t k) {
    return mesh.hex_split_rank.empty() ? 0 : mesh.hex_split_rank[k] & rank_bits;
  };
  return rank(a) != rank(b) ? rank(a) > rank(b) : a < b;
}

// Outward normal of facet f at corner `a`.
static Vec3 corner_normal(const Mesh& mesh, std::int32_t e, int f, int a) {
  const std::array<int, 4> quad = facet_corners(ElementType::hex8, f);
  const auto k = static_cast<std::size_t>(std::find(quad.begin(), quad.end(), a) - quad.begin());
  const auto X = [&](std::size_t m) { return mesh.X[mesh.corners(e)[quad[m % 4]]]; };
  return (X(k + 1) - X(k)).cross(X(k + 3) - X(k)).normalized();
}

// How nearly the two facets at an edge of hexahedron e lie in one plane at its end `a`: 0 up to an
// angle of 127 degrees, 1 at 180.
static double flatness(const Mesh& mesh, std::int32_t e, const std::array<int, 2>& edge, int a) {
  std::array<Vec3, 2> normal;
  std::size_t n = 0;
  for (int f = 0; f < 6; ++f) {
    const std::array<int, 4> quad = facet_corners(ElementType::hex8, f);
    if (std::ranges::count(quad, edge[0]) + std::ranges::count(quad, edge[1]) == 2)
      normal[n++] = corner_normal(mesh, e, f, a);
  }
  constexpr double least_cosine = 0.6;
  return std::max(0.0, (normal[0].dot(normal[1]) - least_cosine) / (1 - least_cosine));
}

std::vector<std::uint8_t> diagonal_ranks(const Mesh& mesh) {
  std::vector<double> sum(mesh.X.size());
  std::vector<int> n_hexahedra(mesh.X.size());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    if (mesh.element_type[e] != ElementType::hex8) continue;
    for (const std::int32_t i : mesh.corners(e)) ++n_hexahedra[i];
    for (const std::array<int, 2>& edge : edge_corners(ElementType::hex8))
      for (const int a : edge) sum[mesh.corners(e)[a]] += flatness(mesh, e, edge, a);
  }
  constexpr double n_edges = 3;  // at a corner: all flat at most
  std::vector<std::uint8_t> rank;
  for (std::size_t i = 0; i < sum.size(); ++i)
    rank.push_back(
        static_cast<std::uint8_t>(rank_bits * sum[i] / (n_edges * std::max(1, n_hexahedra[i]))));
  return rank;
}

std::array<std::array<int, 4>, n_hex_tets> hex_tets(const Mesh& mesh, std::int32_t e) {
  const std::span<const std::int32_t> node = mesh.corners(e);
  const auto is_lower = [&](int a, int b) { return is_diagonal_at(mesh, node[a], node[b]); };
  int apex = 0;
  for (int a = 1; a < 8; ++a)
    if (is_lower(a, apex)) apex = a;
  std::array<std::array<int, 4>, n_hex_tets> tets{};
  std::size_t n = 0;
  for (int f = 0; f < 6; ++f) {
    std::array<int, 4> quad = facet_corners(ElementType::hex8, f);
    if (std::find(quad.begin(), quad.end(), apex) != quad.end()) continue;
    std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end(), is_lower), quad.end());
    tets[n++] = {apex, quad[0], quad[1], quad[2]};
    tets[n++] = {apex, quad[0], quad[2], quad[3]};
  }
  return tets;
}

std::array<std::int32_t, 4> tet_nodes(const Mesh& mesh, std::int32_t e,
                                      const std::array<int, 4>& tet) {
  const std::span<const std::int32_t> c = mesh.corners(e);
  return {c[tet[0]], c[tet[1]], c[tet[2]], c[tet[3]]};
}

std::array<std::array<std::int32_t, 4>, n_hex_tets> hex_tet_nodes(const Mesh& mesh,
                                                                  std::int32_t e) {
  std::array<std::array<std::int32_t, 4>, n_hex_tets> nodes{};
  std::ranges::transform(hex_tets(mesh, e), nodes.begin(),
                         [&](const std::array<int, 4>& tet) { return tet_nodes(mesh, e, tet); });
  return nodes;
}

int hex_facet_of(const Mesh& mesh, std::int32_t e, const std::array<std::int32_t, 4>& tet, int f) {
  const std::span<const std::int32_t> node = mesh.corners(e);
  const auto is_on = [&](std::int32_t i, int g) {
    const std::array<int, 4> quad = facet_corners(ElementType::hex8, g);
    return std::any_of(quad.begin(), quad.end(), [&](int a) { return node[a] == i; });
  };
  for (int g = 0; g < 6; ++g) {
    int n = 0;
    for (int c = 0; c < 4; ++c) n += c != f && is_on(tet[c], g) ? 1 : 0;
    if (n == 3) return g;
  }
  return -1;
}

std::uint8_t cut_facets_in_hex(const Mesh& mesh, std::int32_t e,
                               const std::array<std::int32_t, 4>& tet) {
  return tet_facets_on(mesh.cut_facets[e], [&](int f) { return hex_facet_of(mesh, e, tet, f); });
}

static const FacetSide* find_triangle(const std::vector<FacetSide>& triangle, std::int32_t a,
                                      std::int32_t b, std::int32_t c) {
  std::array<std::int32_t, 4> node{-1, a, b, c};
  std::sort(node.begin(), node.end());
  const auto at =
      std::lower_bound(triangle.begin(), triangle.end(), node,
                       [](const FacetSide& s, const auto& wanted) { return s.node < wanted; });
  return at != triangle.end() && at->node == node ? &*at : nullptr;
}

std::vector<SplitQuad> split_quads(const Mesh& mesh, std::span<const FacetSide> single) {
  if (!has_type(mesh, ElementType::hex8) || !has_type(mesh, ElementType::tet4)) return {};
  std::vector<FacetSide> quad, triangle;
  for (const FacetSide& side : single) (side.node[0] < 0 ? triangle : quad).push_back(side);
  std::vector<SplitQuad> found;
  for (const FacetSide& q : quad) {
    std::array<std::int32_t, 4> n{};
    for (std::size_t a = 0; a < 4; ++a)
      n[a] = mesh.corners(q.element)[facet_corners(ElementType::hex8, q.facet)[a]];
    for (int turn = 0; turn < 2; ++turn) {
      const FacetSide *s = find_triangle(triangle, n[0], n[1], n[2]),
                      *t = find_triangle(triangle, n[0], n[2], n[3]);
      if (s != nullptr && t != nullptr) found.push_back({q.element, q.facet, {*s, *t}});
      std::rotate(n.begin(), n.begin() + 1, n.end());
    }
  }
  return found;
}

}  // namespace trocar
