// A walk from corner to corner: along uncrossed edges inside elements, and to the same corner of
// the elements across facets, whether this stroke opened them or not.
#include "cutting/cut_flake.h"

#include <algorithm>
#include <optional>

#include "cutting/cut_patch.h"

namespace trocar {

// More elements than any flake has: a walk that meets so many has left it.
static constexpr std::size_t n_walked = 2000;

namespace {

// A facet that this stroke opened, and the element that has it.
struct OpenedFacet {
  std::array<Vec3, 3> X;  // in the order of their coordinates
  std::int32_t element;
};

// Where a walk has come, and the place before it; -1: it began here.
struct Met {
  std::int32_t element, corner;
  std::ptrdiff_t before;
};

struct Walk {
  const Mesh& mesh;
  const CutIndex& index;
  const CutStroke& stroke;
  std::optional<std::vector<OpenedFacet>> lip;   // sorted; once one has been met
  std::vector<OfElement<std::uint8_t>> visited;  // bit c: corner c
  std::vector<Met> met;                          // the nearest first
  std::ptrdiff_t now = -1;
};

}  // namespace

static bool is_lip_before(const OpenedFacet& a, const OpenedFacet& b) {
  return std::lexicographical_compare(a.X.begin(), a.X.end(), b.X.begin(), b.X.end(), is_before);
}

static OpenedFacet lip_of(const Mesh& mesh, std::int32_t e, int f) {
  OpenedFacet lip{{}, e};
  for (std::size_t k = 0; k < 3; ++k) lip.X[k] = mesh.X[mesh.corners(e)[tet_facets[f][k]]];
  std::ranges::sort(lip.X, is_before);
  return lip;
}

static std::vector<OpenedFacet> lips(const Mesh& mesh, const CutStroke& stroke) {
  std::vector<OpenedFacet> lip;
  for (const auto& [e, mask] : stroke.opened)
    for (int f = 0; f < 4; ++f)
      if ((mask >> f & 1) != 0) lip.push_back(lip_of(mesh, e, f));
  std::ranges::sort(lip, is_lip_before);
  return lip;
}

std::int32_t element_across(const Mesh& mesh, const CutIndex& index, std::int32_t e, int f) {
  const std::span<const std::int32_t> c = mesh.corners(e);
  const auto has_facet = [&](std::int32_t u) {
    return u != e && mesh.element_type[u] == ElementType::tet4 &&
           std::ranges::all_of(tet_facets[f], [&](int k) {
             return std::ranges::find(mesh.corners(u), c[k]) != mesh.corners(u).end();
           });
  };
  const std::span<const std::int32_t> star = index.star(c[tet_facets[f][0]]);
  const auto at = std::ranges::find_if(star, has_facet);
  return at == star.end() ? -1 : *at;
}

// The element across facet f before this stroke; -1: none.
static std::int32_t element_before(Walk& walk, std::int32_t e, int f) {
  const std::uint8_t* opened = find_element(walk.stroke.opened, e);
  if (opened == nullptr || (*opened >> f & 1) == 0)
    return element_across(walk.mesh, walk.index, e, f);
  if (!walk.lip) walk.lip = lips(walk.mesh, walk.stroke);
  const auto [first, last] =
      std::equal_range(walk.lip->begin(), walk.lip->end(), lip_of(walk.mesh, e, f), is_lip_before);
  const auto other =
      std::find_if(first, last, [&](const OpenedFacet& lip) { return lip.element != e; });
  return other == last ? -1 : other->element;
}

// Nodes that this stroke put on its surface lie on neither side.
static void visit(Walk& walk, std::int32_t e, std::size_t c) {
  if (std::ranges::binary_search(walk.stroke.made_node, walk.mesh.corners(e)[c])) return;
  auto at = std::ranges::lower_bound(walk.visited, e, {}, &OfElement<std::uint8_t>::element);
  if (at == walk.visited.end() || at->element != e) at = walk.visited.insert(at, {e, 0});
  if ((at->value >> c & 1) != 0) return;
  at->value = static_cast<std::uint8_t>(at->value | 1U << c);
  walk.met.push_back({e, static_cast<std::int32_t>(c), walk.now});
}

static void go_on(Walk& walk, std::int32_t e, std::size_t c) {
  const std::span<const CutHit> hits = hits_of(walk.stroke, e);
  const auto is_crossed = [&](std::size_t edge) {
    return std::ranges::find(hits, static_cast<std::int32_t>(edge), &CutHit::edge) != hits.end();
  };
  for (std::size_t k = 0; k < 6; ++k) {
    const auto a = static_cast<std::size_t>(tet_edges[k][0]),
               b = static_cast<std::size_t>(tet_edges[k][1]);
    if ((a == c || b == c) && !is_crossed(k)) visit(walk, e, a + b - c);
  }
  const Vec3& X = walk.mesh.X[walk.mesh.corners(e)[c]];
  for (std::size_t f = 0; f < 4; ++f) {
    const std::int32_t u = f == c ? -1 : element_before(walk, e, static_cast<int>(f));
    for (std::size_t k = 0; u >= 0 && k < 4; ++k)
      if (walk.mesh.X[walk.mesh.corners(u)[k]] == X) visit(walk, u, k);
  }
}

// Begins at corners that crossed edges put on that side.
static void begin(Walk& walk, const std::vector<std::int32_t>& piece, int side) {
  for (const std::int32_t e : piece)
    for (const CutHit& hit : hits_of(walk.stroke, e)) {
      const auto& [a, b] = tet_edges[hit.edge];
      visit(walk, e, static_cast<std::size_t>(hit.is_first_plus == (side > 0) ? a : b));
    }
}

static std::vector<std::int32_t> nodes_back(const Walk& walk) {
  std::vector<std::int32_t> nodes;
  for (std::ptrdiff_t k = walk.now; k >= 0;) {
    const auto& [e, c, before] = walk.met[k];
    nodes.push_back(walk.mesh.corners(e)[c]);
    k = before;
  }
  return nodes;
}

Flake find_flake(const Mesh& mesh, const CutIndex& index, const CutStroke& stroke,
                 const std::vector<std::int32_t>& piece, int side,
                 const std::vector<OfElement<std::int8_t>>& given) {
  Walk walk{mesh, index, stroke, {}, {}, {}};
  begin(walk, piece, side);
  for (walk.now = 0; walk.now < std::ssize(walk.met); ++walk.now) {
    const auto [e, c, before] = walk.met[walk.now];
    if (!std::ranges::binary_search(piece, e)) {
      const std::int8_t* known = find_element(given, e);
      if (known == nullptr) known = find_element(stroke.side, e);
      if (known != nullptr && *known == side) return {true, nodes_back(walk)};
    }
    if (walk.visited.size() > n_walked) return {true, {}};
    go_on(walk, e, static_cast<std::size_t>(c));
  }
  return {};
}

}  // namespace trocar
