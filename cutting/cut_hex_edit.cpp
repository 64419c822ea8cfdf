// An edit of the tetrahedra as one of the body: which hexahedra stay, and the numbers of the rest.
#include <algorithm>
#include <limits>

#include "base/sort_unique.h"
#include "cutting/cut_hex.h"
#include "cutting/cut_hex_shape.h"
#include "cutting/cut_patch.h"
#include "mesh/barycentric.h"
#include "mesh/hex_split.h"
#include "mesh/node_corners.h"

namespace trocar {

// A hexahedron whose Jacobian falls below this part of the centre's is converted: in the reference,
// and in the present configuration, where the load bends it too.
static constexpr double least_reference_ratio = 0.2, least_bent_ratio = 0.02;

namespace {

// What an edit of the tetrahedra means for the body, and the numbers of parts.
struct Translation {
  const Mesh& body;
  std::span<const Vec3> x;
  const MeshEdit& edit;  // of tets.mesh
  const HexTets& tets;
  std::vector<ElementSplit> splits;  // ascending
  SplitNumbers numbers;              // theirs, once all are known

  bool is_split(std::int32_t e) const { return numbers.is_split(e); }
  // Of element s of tets.mesh in the body after the edit.
  std::int32_t number_after(std::int32_t s) const {
    const std::int32_t e = tets.source[s];
    return is_split(e) ? numbers.part(e, s - tets.first[e]) : e;
  }
};

// A hexahedron that stays one.
struct KeptHex {
  std::array<std::int32_t, 8> node{};
  std::uint8_t cut_facets = 0;
};

}  // namespace

// Reference and present position of a node after the edit; a copy lies where its parent does.
static std::array<Vec3, 2> position_after(const Translation& t, std::int32_t i) {
  const std::int32_t n = t.body.n_nodes();
  while (i >= n) i = t.edit.duplicate_parent[i - n];
  const auto at =
      std::lower_bound(t.edit.moves.begin(), t.edit.moves.end(), i,
                       [](const NodeMove& move, std::int32_t node) { return move.node < node; });
  if (at == t.edit.moves.end() || at->node != i) return {t.body.X[i], t.x[i]};
  return {at->X, interpolate(t.tets.mesh.corners(at->host), at->weight, t.x)};
}

// The hexahedron's corners after the edit; false if its tetrahedra don't agree about one of them.
static bool join_corners(const Translation& t, std::int32_t e, KeptHex& hex) {
  const std::span<const std::int32_t> corner = t.body.corners(e);
  hex.node.fill(-1);
  for (std::int32_t s = t.tets.first[e]; s < t.tets.end(e); ++s)
    for (std::int32_t c = 0; c < 4; ++c) {
      const std::int32_t old = t.tets.mesh.corners(s)[c];
      const auto a = std::find(corner.begin(), corner.end(), old) - corner.begin();
      std::int32_t& node = hex.node[a];
      const std::int32_t next = node_after(t.edit, t.tets.mesh, s, c);
      if (node >= 0 && node != next) return false;
      node = next;
    }
  return true;
}

// Its opened facets; false if one of them is open in one of its two triangles only.
static bool join_facets(const Translation& t, std::int32_t e, KeptHex& hex) {
  std::array<int, 6> n_open{};
  for (std::int32_t s = t.tets.first[e]; s < t.tets.end(e); ++s) {
    const std::array<std::int32_t, 4> node = tet_nodes(t.tets.mesh, s);
    const std::uint8_t mask = cut_facets_after(t.edit, t.tets.mesh, s);
    for (int f = 0; f < 4 && mask != 0; ++f) {
      if ((mask >> f & 1) == 0) continue;
      const int g = hex_facet_of(t.body, e, node, f);
      if (g < 0) return false;
      ++n_open[g];
    }
  }
  unsigned bits = 0;
  for (std::size_t g = 0; g < 6; ++g) bits |= n_open[g] == 2 ? 1U << g : 0U;
  hex.cut_facets = static_cast<std::uint8_t>(bits);
  return std::find(n_open.begin(), n_open.end(), 1) == n_open.end();
}

// Valid in both configurations, and no nearer to instability than its tetrahedra would be.
static bool is_sound(const Translation& t, std::int32_t e, const KeptHex& hex) {
  std::array<Vec3, 8> X, x;
  for (std::size_t a = 0; a < 8; ++a) {
    const auto [reference, present] = position_after(t, hex.node[a]);
    X[a] = reference;
    x[a] = present;
  }
  if (least_gauss_ratio(X) < least_reference_ratio || least_gauss_ratio(x) < least_bent_ratio)
    return false;
  double least = std::numeric_limits<double>::infinity();
  for (std::int32_t s = t.tets.first[e]; s < t.tets.end(e); ++s) {
    std::array<Vec3, 4> corner;
    for (std::size_t a = 0; a < 4; ++a) corner[a] = position_after(t, t.tets.mesh.corners(s)[a])[0];
    least = std::min(least, step_bound(corner, {0, 1, 2, 3}));
  }
  return hex_step_bound(X) >= least;
}

static bool stays_hexahedron(const Translation& t, std::int32_t e, KeptHex& hex) {
  return join_corners(t, e, hex) && join_facets(t, e, hex) && is_sound(t, e, hex);
}

// Elements of the body around moved nodes and at parted ones, whose stars the index has split up.
static std::vector<std::int32_t> moved_elements(const Translation& t, const CutIndex& index) {
  std::vector<std::int32_t> element;
  for (const CornerChange& change : t.edit.corners)
    element.push_back(t.tets.source[change.element]);
  for (const NodeMove& move : t.edit.moves)
    for (const std::int32_t s : index.star(move.node)) element.push_back(t.tets.source[s]);
  sort_unique(element);
  return element;
}

static std::vector<std::int32_t> touched_hexahedra(const Translation& t, const CutIndex& index) {
  std::vector<std::int32_t> element = moved_elements(t, index);
  for (const CutFacets& change : t.edit.cut_facets)
    element.push_back(t.tets.source[change.element]);
  sort_unique(element);
  std::erase_if(element, [&](std::int32_t e) { return !t.tets.is_hexahedron(e); });
  return element;
}

static ElementSplit split_of(const Translation& t, std::int32_t e) {
  ElementSplit split{.element = e};
  for (std::int32_t k = 0; k < n_hex_tets; ++k)
    split.corner[k] = tet_nodes(t.tets.mesh, t.tets.first[e] + k);
  return split;
}

// The host is the body's element; weights go to the corners that its tetrahedron has of it.
static NodeMove move_in_body(const Translation& t, const NodeMove& move) {
  NodeMove result{move.node, move.X, t.tets.source[move.host], {}};
  const std::span<const std::int32_t> tet = t.tets.mesh.corners(move.host),
                                      host = t.body.corners(result.host);
  for (std::size_t a = 0; a < tet.size(); ++a) {
    const auto at = std::find(host.begin(), host.end(), tet[a]) - host.begin();
    result.weight[at] = move.weight[a];
  }
  return result;
}

static void keep_hexahedron(const Translation& t, std::int32_t e, const KeptHex& hex,
                            MeshEdit& edit) {
  for (std::int32_t a = 0; a < 8; ++a)
    if (const std::int32_t node = hex.node[a]; node != t.body.corners(e)[a])
      edit.corners.push_back({e, a, node});
  if (hex.cut_facets != t.body.cut_facets[e]) edit.cut_facets.push_back({e, hex.cut_facets});
}

static void take_over_tetrahedra(const Translation& t, MeshEdit& edit) {
  const auto is_tet = [&](std::int32_t s) {
    return !t.tets.is_hexahedron(t.tets.source[s]) || t.is_split(t.tets.source[s]);
  };
  for (const CornerChange& change : t.edit.corners)
    if (is_tet(change.element))
      edit.corners.push_back({t.number_after(change.element), change.corner, change.node});
  for (const CutFacets& change : t.edit.cut_facets)
    if (is_tet(change.element))
      edit.cut_facets.push_back({t.number_after(change.element), change.mask});
  std::sort(edit.corners.begin(), edit.corners.end(), [](const auto& a, const auto& b) {
    return std::pair{a.element, a.corner} < std::pair{b.element, b.corner};
  });
  std::sort(edit.cut_facets.begin(), edit.cut_facets.end(),
            [](const auto& a, const auto& b) { return a.element < b.element; });
}

// Of what an element of the body is after the edit: itself or its tetrahedra.
static std::vector<double> volumes_after(const Translation& t, std::int32_t e,
                                         const KeptHex* kept) {
  std::vector<double> volumes;
  const auto add = [&](ElementType type, std::span<const std::int32_t> node) {
    std::vector<Vec3> X;
    for (const std::int32_t i : node) X.push_back(position_after(t, i)[0]);
    volumes.push_back(element_volume(type, X));
  };
  if (kept != nullptr) add(ElementType::hex8, kept->node);
  for (std::int32_t s = t.tets.first[e]; s < t.tets.end(e) && kept == nullptr; ++s) {
    std::array<std::int32_t, 4> node{};
    for (std::int32_t c = 0; c < 4; ++c) node[c] = node_after(t.edit, t.tets.mesh, s, c);
    add(ElementType::tet4, node);
  }
  return volumes;
}

// Of hexahedra that stay, ascending.
using KeptHexahedra = std::vector<std::pair<std::int32_t, KeptHex>>;

static const KeptHex* find_kept(const KeptHexahedra& kept, std::int32_t e) {
  const auto at = std::lower_bound(kept.begin(), kept.end(), e,
                                   [](const auto& hex, std::int32_t k) { return hex.first < k; });
  return at != kept.end() && at->first == e ? &at->second : nullptr;
}

// Of the elements that changed shape or kind.
static std::vector<DensityChange> density_changes(const Translation& t, const CutIndex& index,
                                                  const KeptHexahedra& kept) {
  std::vector<std::int32_t> changed = moved_elements(t, index);
  for (const ElementSplit& split : t.splits) changed.push_back(split.element);
  sort_unique(changed);
  std::vector<Reshaped> reshaped;
  for (const std::int32_t e : changed) {
    double before = element_volume(t.body, e, t.body.X);
    std::int32_t k = 0;
    for (const double after : volumes_after(t, e, find_kept(kept, e))) {
      reshaped.push_back({t.numbers.part(e, k++), t.body.element_region[e],
                          t.body.density_factor[e], before, after});
      before = 0;
    }
  }
  std::vector<DensityChange> change = keep_masses(reshaped, t.body.region_name.size());
  std::ranges::sort(change, {}, &DensityChange::element);
  return change;
}

void edit_hex_tets(std::span<const ElementSplit> splits, const MeshEdit& edit, HexTets& tets) {
  for (const ElementSplit& split : splits)
    for (std::int32_t k = 1, s = tets.first[split.element] + 1; k < split.n_tets; ++k, ++s) {
      tets.source[s] = static_cast<std::int32_t>(tets.first.size());
      tets.first.push_back(s);
    }
  apply_edit(edit, tets.mesh);
}

MeshEdit edit_of_body(const Mesh& body, PresentPositions& positions, const CutIndex& index,
                      const MeshEdit& edit, HexTets& tets, CutFigures& figures) {
  Translation t{body, positions.x(), edit, tets, {}, SplitNumbers({}, 0)};
  KeptHexahedra kept;
  const std::vector<std::int32_t> touched = touched_hexahedra(t, index);
  positions.find(nodes_of(body, touched));
  for (const std::int32_t e : touched) {
    KeptHex hex;
    if (stays_hexahedron(t, e, hex))
      kept.emplace_back(e, hex);
    else
      t.splits.push_back(split_of(t, e));
  }
  t.numbers = SplitNumbers(t.splits, body.n_elements());
  MeshEdit result;
  result.splits = t.splits;
  for (const NodeMove& move : edit.moves) result.moves.push_back(move_in_body(t, move));
  result.duplicate_parent = edit.duplicate_parent;
  for (const auto& [e, hex] : kept) keep_hexahedron(t, e, hex, result);
  take_over_tetrahedra(t, result);
  result.density = density_changes(t, index, kept);
  figures.n_converted = static_cast<std::int32_t>(t.splits.size());
  figures.n_kept_hexahedra = static_cast<std::int32_t>(kept.size());
  edit_hex_tets(t.splits, edit, tets);
  return result;
}

}  // namespace trocar
