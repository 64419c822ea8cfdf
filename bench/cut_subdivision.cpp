// Subdivision at the exact intersection: crossed edges are bisected in one order for all elements
// around them, so that neighbours agree.
#include <map>
#include <numeric>

#include "cut_case.h"

namespace trocar::cut_bench {

namespace {

using Edge = std::array<std::int32_t, 2>;
using Tet = std::array<std::int32_t, 4>;

struct Splitting {
  std::map<Edge, std::int32_t> node;  // where the surface meets an edge
  std::vector<std::int8_t> side;      // of each node; 0: on the surface
};

}  // namespace

static Edge edge_of(std::int32_t a, std::int32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

// The root of phi between a and b, to the last bits.
static Vec3 crossing(const Stroke& stroke, Vec3 a, Vec3 b) {
  const bool is_a_plus = stroke.phi(a) > 0;
  for (int k = 0; k < 50; ++k) {
    const Vec3 m = 0.5 * (a + b);
    ((stroke.phi(m) > 0) == is_a_plus ? a : b) = m;
  }
  return 0.5 * (a + b);
}

static Splitting split_edges(const Stroke& stroke, Mesh& mesh) {
  Splitting splitting;
  for (const Vec3& X : mesh.X) {
    const double phi = stroke.phi(X);
    splitting.side.push_back(static_cast<std::int8_t>((phi > 0) - (phi < 0)));
  }
  for (const Edge& edge : mesh_edges(mesh)) {
    if (splitting.side[edge[0]] * splitting.side[edge[1]] != -1) continue;
    splitting.node[edge] = mesh.n_nodes();
    mesh.X.push_back(crossing(stroke, mesh.X[edge[0]], mesh.X[edge[1]]));
    splitting.side.push_back(0);
  }
  return splitting;
}

static void split_tet(const Splitting& splitting, const Tet& tet, std::vector<Tet>& result) {
  auto first = splitting.node.end();
  for (const auto& [a, b] : tet_edges) {
    const auto at = splitting.node.find(edge_of(tet[a], tet[b]));
    if (at != splitting.node.end() && (first == splitting.node.end() || at->first < first->first))
      first = at;
  }
  if (first == splitting.node.end()) {
    result.push_back(tet);
    return;
  }
  for (const std::int32_t end : first->first) {
    Tet half = tet;
    *std::find(half.begin(), half.end(), end) = first->second;
    split_tet(splitting, half, result);
  }
}

// Pieces through facets between elements on the same side of all surfaces.
static std::vector<double> piece_volumes(const Mesh& mesh, const std::vector<int>& code) {
  const FacetNeighbours across = facet_neighbours(mesh);
  std::vector<double> volume;
  std::vector<std::uint8_t> is_seen(code.size(), 0);
  for (std::int32_t first = 0; first < mesh.n_elements(); ++first) {
    if (is_seen[first] != 0) continue;
    double sum = 0;
    std::vector<std::int32_t> open{first};
    is_seen[first] = 1;
    while (!open.empty()) {
      const std::int32_t e = open.back();
      open.pop_back();
      sum += element_volume(mesh, e, mesh.X);
      for (int f = 0; f < 4; ++f) {
        const std::int32_t u = across.of(e, f);
        if (u < 0 || is_seen[u] != 0 || code[u] != code[e]) continue;
        is_seen[u] = 1;
        open.push_back(u);
      }
    }
    volume.push_back(sum);
  }
  return volume;
}

Subdivision subdivide(const Mesh& mesh, const std::vector<Stroke>& strokes) {
  Subdivision result{mesh, {}};
  std::vector<int> code(mesh.element_type.size(), 0);  // bit s: side of stroke s
  for (std::size_t s = 0; s < strokes.size(); ++s) {
    Mesh next;
    next.region_name = {""};
    next.X = result.mesh.X;
    const Splitting splitting = split_edges(strokes[s], result.mesh);
    next.X = result.mesh.X;
    std::vector<int> next_code;
    for (std::int32_t e = 0; e < result.mesh.n_elements(); ++e) {
      std::vector<Tet> part;
      split_tet(splitting, tet_nodes(result.mesh, e), part);
      for (const Tet& tet : part) {
        add_element(next, ElementType::tet4, tet);
        const int sum = splitting.side[tet[0]] + splitting.side[tet[1]] + splitting.side[tet[2]] +
                        splitting.side[tet[3]];
        next_code.push_back(code[e] | (sum > 0 ? 1 << s : 0));
      }
    }
    result.mesh = std::move(next);
    code = std::move(next_code);
  }
  result.piece_volume = piece_volumes(result.mesh, code);
  return result;
}

}  // namespace trocar::cut_bench
