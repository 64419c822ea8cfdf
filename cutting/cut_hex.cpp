// The tetrahedra of a body with hexahedra.
#include "cutting/cut_hex.h"

#include <algorithm>
#include <limits>

#include "base/check.h"
#include "base/sort_unique.h"
#include "cutting/cut_hex_shape.h"
#include "cutting/cut_patch.h"
#include "mesh/hex_split.h"

namespace trocar {

// Least step bound of a hexahedron's tetrahedra over its own below which it is not split.
static constexpr double least_step_part = 0.15;

// Of a tetrahedron, present over reference volume, below which it counts as nearly flat.
static constexpr double flat_volume_ratio = 0.1;

bool was_hexahedral(const Mesh& mesh) {
  return !mesh.split_hexahedra.empty() || has_type(mesh, ElementType::hex8);
}

// Whether the triangles' common edge begins where hex_tets has it.
static bool has_own_diagonal(const Mesh& mesh, const SplitQuad& quad) {
  const auto &s = quad.triangle[0].node, &t = quad.triangle[1].node;
  std::int32_t first = -1;
  for (const auto& nodes : {s, t})
    for (const std::int32_t i : nodes)
      if (i >= 0 && (first < 0 || is_diagonal_at(mesh, i, first))) first = i;
  return std::find(s.begin(), s.end(), first) != s.end() &&
         std::find(t.begin(), t.end(), first) != t.end();
}

// Of all tetrahedra of hexahedron e; not positive if one is inverted.
static double least_step_bound(const Mesh& mesh, std::int32_t e) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::array<std::int32_t, 4>& node : hex_tet_nodes(mesh, e))
    least = std::min(least, step_bound(mesh.X, node));
  return least;
}

std::vector<std::uint8_t> hex_split_ranks(const Mesh& mesh) {
  if (!has_type(mesh, ElementType::hex8)) return {};
  Mesh ranked = mesh;
  ranked.hex_split_rank = diagonal_ranks(mesh);
  std::vector<std::uint8_t> rank = ranked.hex_split_rank;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    if (mesh.element_type[e] != ElementType::hex8) continue;
    if (least_step_bound(ranked, e) >=
        least_step_part * hex_step_bound(corner_positions(mesh, e, mesh.X)))
      continue;
    for (const std::int32_t i : mesh.corners(e)) rank[i] |= whole_bit;
  }
  if (std::ranges::count(rank, 0) == std::ssize(rank)) rank.clear();
  return rank;
}

static bool is_marked_whole(const Mesh& mesh, std::int32_t e) {
  return !mesh.hex_split_rank.empty() && std::ranges::all_of(mesh.corners(e), [&](std::int32_t i) {
    return (mesh.hex_split_rank[mesh.uncut_node(i)] & whole_bit) != 0;
  });
}

std::vector<std::int32_t> whole_hexahedra(const Mesh& mesh) {
  std::vector<std::int32_t> whole;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    if (mesh.element_type[e] == ElementType::hex8 &&
        (is_marked_whole(mesh, e) || !(least_step_bound(mesh, e) > 0)))
      whole.push_back(e);
  for (const SplitQuad& quad : split_quads(mesh, single_sides(mesh)))
    if (!has_own_diagonal(mesh, quad)) whole.push_back(quad.hex);
  sort_unique(whole);
  return whole;
}

static bool is_bent(const HexTets& tets, std::span<const Vec3> x, std::int32_t hex) {
  for (std::int32_t s = tets.first[hex]; s < tets.end(hex); ++s) {
    const std::array<std::int32_t, 4> node = tet_nodes(tets.mesh, s);
    if (!(six_volumes(x, node) > flat_volume_ratio * six_volumes(tets.mesh.X, node))) return true;
  }
  return false;
}

// Of the body's elements.
static std::vector<std::int32_t> nodes_of(const HexTets& tets,
                                          std::span<const std::int32_t> elements) {
  std::vector<std::int32_t> nodes;
  for (const std::int32_t e : elements)
    for (std::int32_t s = tets.first[e]; s < tets.end(e); ++s)
      nodes.insert(nodes.end(), tets.mesh.corners(s).begin(), tets.mesh.corners(s).end());
  sort_unique(nodes);
  return nodes;
}

std::vector<std::int32_t> bent_nodes(const HexTets& tets, PresentPositions& positions,
                                     std::span<const std::int32_t> element) {
  std::vector<std::int32_t> hex;
  for (const std::int32_t s : element)
    if (const std::int32_t e = tets.source[s]; tets.is_hexahedron(e)) hex.push_back(e);
  sort_unique(hex);
  positions.find(nodes_of(tets, hex));
  std::erase_if(hex, [&](std::int32_t e) { return !is_bent(tets, positions.x(), e); });
  return nodes_of(tets, hex);
}

static void add_as_tets(const Mesh& body, std::int32_t e, HexTets& tets) {
  tets.first[e] = tets.mesh.n_elements();
  for (const std::array<std::int32_t, 4>& node : hex_tet_nodes(body, e)) {
    add_element(tets.mesh, ElementType::tet4, node, body.element_region[e]);
    tets.mesh.cut_facets.back() = cut_facets_in_hex(body, e, node);
    tets.source.push_back(e);
  }
}

static void add_as_it_is(const Mesh& body, std::int32_t e, HexTets& tets) {
  tets.first[e] = tets.mesh.n_elements();
  add_element(tets.mesh, body.element_type[e], body.corners(e), body.element_region[e]);
  tets.mesh.cut_facets.back() = body.cut_facets[e];
  tets.source.push_back(e);
}

// (n_elements) Of split hexahedra, and -1; of the other tetrahedra of these, -2.
static std::vector<std::int32_t> first_parts(const Mesh& body) {
  std::vector<std::int32_t> first(body.element_type.size(), -1);
  for (const SplitHexahedron& split : body.split_hexahedra) {
    first[split.element] = split.first_part;
    std::fill_n(first.begin() + split.first_part, n_hex_tets - 1, -2);
  }
  return first;
}

static HexTets make_hex_tets(const Mesh& body) {
  HexTets tets;
  tets.mesh.X = body.X;
  tets.mesh.copied_node = body.copied_node;
  tets.mesh.region_name = body.region_name;
  tets.first.resize(body.element_type.size());
  const std::vector<std::int32_t> whole = whole_hexahedra(body), parts = first_parts(body);
  for (std::int32_t e = 0; e < body.n_elements(); ++e) {
    if (parts[e] < -1) continue;
    if (body.element_type[e] == ElementType::hex8 &&
        !std::binary_search(whole.begin(), whole.end(), e)) {
      add_as_tets(body, e, tets);
      continue;
    }
    add_as_it_is(body, e, tets);
    for (std::int32_t k = 0; k < n_hex_tets - 1 && parts[e] >= 0; ++k)
      add_as_it_is(body, parts[e] + k, tets);
  }
  return tets;
}

bool are_tets_of(const HexTets& tets, const Mesh& body) {
  return tets.mesh.X.size() == body.X.size() && tets.first.size() == body.element_type.size();
}

void update_hex_tets(const Mesh& body, HexTets& tets) {
  if (!are_tets_of(tets, body)) tets = make_hex_tets(body);
  DCHECK(tets.mesh.X == body.X);
}

}  // namespace trocar
