// The tetrahedra of a body with hexahedra.
#include "cutting/cut_hex.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "cutting/cut_patch.h"
#include "mesh/hex_split.h"

namespace trocar {

bool has_hexahedra(const Mesh& mesh) {
  return std::find(mesh.element_type.begin(), mesh.element_type.end(), ElementType::hex8) !=
         mesh.element_type.end();
}

static std::array<std::int32_t, 4> tet_nodes(const Mesh& mesh, std::int32_t e,
                                             const std::array<int, 4>& tet) {
  std::array<std::int32_t, 4> node{};
  for (std::size_t a = 0; a < 4; ++a) node[a] = mesh.corners(e)[static_cast<std::size_t>(tet[a])];
  return node;
}

// Whether the triangles' common edge begins at the quad's lowest node, as hex_tets has it.
static bool has_own_diagonal(const Mesh& mesh, const SplitQuad& quad) {
  const auto &s = quad.triangle[0].node, &t = quad.triangle[1].node;
  std::int32_t lowest = -1;
  for (const auto& nodes : {s, t})
    for (const std::int32_t i : nodes)
      if (i >= 0 && (lowest < 0 || mesh.uncut_node(i) < mesh.uncut_node(lowest))) lowest = i;
  return std::find(s.begin(), s.end(), lowest) != s.end() &&
         std::find(t.begin(), t.end(), lowest) != t.end();
}

std::vector<std::int32_t> whole_hexahedra(const Mesh& mesh) {
  std::vector<std::int32_t> whole;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    if (mesh.element_type[e] != ElementType::hex8) continue;
    const auto tets = hex_tets(mesh, e);
    if (std::any_of(tets.begin(), tets.end(), [&](const std::array<int, 4>& tet) {
          return !(six_volumes(mesh.X, tet_nodes(mesh, e, tet)) > 0);
        }))
      whole.push_back(e);
  }
  for (const SplitQuad& quad : split_quads(mesh, sorted_facet_sides(mesh)))
    if (!has_own_diagonal(mesh, quad)) whole.push_back(quad.hex);
  sort_unique(whole);
  return whole;
}

static void add_as_tets(const Mesh& body, std::int32_t e, HexTets& tets) {
  for (const std::array<int, 4>& tet : hex_tets(body, e)) {
    const std::array<std::int32_t, 4> node = tet_nodes(body, e, tet);
    add_element(tets.mesh, ElementType::tet4, node, body.element_region[e]);
    unsigned mask = 0;
    for (int f = 0; f < 4; ++f) {
      const int g = hex_facet_of(body, e, node, f);
      if (g >= 0 && (body.cut_facets[e] >> g & 1) != 0) mask |= 1U << f;
    }
    tets.mesh.cut_facets.back() = static_cast<std::uint8_t>(mask);
    tets.source.push_back(e);
  }
}

static HexTets make_hex_tets(const Mesh& body) {
  HexTets tets;
  tets.mesh.X = body.X;
  tets.mesh.copied_node = body.copied_node;
  tets.mesh.region_name = body.region_name;
  const std::vector<std::int32_t> whole = whole_hexahedra(body);
  for (std::int32_t e = 0; e < body.n_elements(); ++e) {
    tets.first.push_back(tets.mesh.n_elements());
    if (body.element_type[e] == ElementType::hex8 &&
        !std::binary_search(whole.begin(), whole.end(), e)) {
      add_as_tets(body, e, tets);
      continue;
    }
    add_element(tets.mesh, body.element_type[e], body.corners(e), body.element_region[e]);
    tets.mesh.cut_facets.back() = body.cut_facets[e];
    tets.source.push_back(e);
  }
  tets.first.push_back(tets.mesh.n_elements());
  return tets;
}

void update_hex_tets(const Mesh& body, HexTets& tets) {
  if (tets.mesh.X.size() == body.X.size() && tets.first.size() == body.element_type.size() + 1)
    tets.mesh.X = body.X;
  else
    tets = make_hex_tets(body);
}

}  // namespace trocar
