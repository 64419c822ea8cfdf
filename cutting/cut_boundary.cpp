// Classification of nodes on the outer surface and between regions by the angles between the facets
// around them.
#include "cutting/cut_boundary.h"

#include <algorithm>
#include <cmath>

#include "base/segment.h"
#include "base/triangle.h"

namespace trocar {

// Facets that meet at more than 40 degrees make a sharp edge; an edge that bends by more is a
// corner.
static constexpr double cos_sharp_edge = 0.766;

namespace {

// Outer, or between two regions.
struct BoundFacet {
  std::array<std::int32_t, 3> node;
  Vec3 normal;                                  // length: twice the area
  bool is_cut;                                  // opened by an older stroke
  std::array<std::int32_t, 2> between{-1, -1};  // the regions; none of outer facets
};

}  // namespace

static bool is_opened(const CutPatch& patch, const CutStroke& stroke, std::int32_t e, int f) {
  const std::uint8_t* opened = find_element(stroke.opened, patch.element[e]);
  return opened != nullptr && (*opened >> f & 1) != 0;
}

static std::vector<BoundFacet> outer_facets(const CutPatch& patch, const CutStroke& stroke,
                                            std::span<const std::uint8_t> cut_facets,
                                            std::int32_t i) {
  std::vector<BoundFacet> outer;
  for (const std::int32_t e : patch.star(i)) {
    for (int f = 0; f < 4; ++f) {
      if (patch.across[e][f] >= 0 || patch.corner[e][f] == i) continue;
      if (is_opened(patch, stroke, e, f)) continue;
      const std::array<std::int32_t, 3> node = facet_nodes(patch, e, f);
      outer.push_back(
          {node, facet_normal(patch, node), (cut_facets[patch.element[e]] >> f & 1) != 0});
    }
  }
  return outer;
}

std::vector<Vec3> outer_normals(const CutPatch& patch, const CutStroke& stroke,
                                std::span<const std::uint8_t> cut_facets, std::int32_t i) {
  std::vector<Vec3> normals;
  for (const BoundFacet& facet : outer_facets(patch, stroke, cut_facets, i))
    if (!facet.is_cut) normals.push_back(facet.normal.normalized());
  return normals;
}

// Each once, outward of the region of the lower number.
static void add_interfaces(const CutPatch& patch, std::int32_t i, std::vector<BoundFacet>& bound) {
  for (const std::int32_t e : patch.star(i))
    for (int f = 0; f < 4; ++f) {
      const std::int32_t u = patch.across[e][f];
      if (u < 0 || patch.corner[e][f] == i || patch.region[e] >= patch.region[u]) continue;
      const std::array<std::int32_t, 3> node = facet_nodes(patch, e, f);
      bound.push_back({node, facet_normal(patch, node), false, {patch.region[e], patch.region[u]}});
    }
}

// Node other than i that both facets have, -1 if there is none.
static std::int32_t shared_node(const BoundFacet& p, const BoundFacet& q, std::int32_t i) {
  for (const std::int32_t j : p.node)
    if (j != i && std::find(q.node.begin(), q.node.end(), j) != q.node.end()) return j;
  return -1;
}

// Whether the edge that both have is sharp, or where an interface meets another facet.
static bool is_sharp(const BoundFacet& p, const BoundFacet& q) {
  if (p.between != q.between) return true;
  return !(p.normal.dot(q.normal) >= cos_sharp_edge * p.normal.norm() * q.normal.norm());
}

static void add_end(std::int32_t j, std::vector<std::int32_t>& end) {
  if (std::ranges::find(end, j) == end.end()) end.push_back(j);
}

// Other ends of the edges at node i that it may not leave: sharp ones, those of interfaces and of
// areas. `has_rim`: one of them is the inner rim of an older cut.
static std::vector<std::int32_t> sharp_ends(const CutPatch& patch,
                                            const std::vector<BoundFacet>& bound, std::int32_t i,
                                            bool& has_rim) {
  std::vector<std::int32_t> end;
  has_rim = false;
  for (std::size_t p = 0; p < bound.size(); ++p)
    for (std::size_t q = p + 1; q < bound.size(); ++q) {
      const std::int32_t j = shared_node(bound[p], bound[q], i);
      if (j < 0 || !is_sharp(bound[p], bound[q])) continue;
      add_end(j, end);
      has_rim = has_rim || (bound[p].is_cut && bound[q].is_cut);
    }
  auto at = std::lower_bound(patch.border.begin(), patch.border.end(), BorderEdge{i, -1});
  for (; at != patch.border.end() && (*at)[0] == i; ++at) add_end((*at)[1], end);
  return end;
}

// Unless it is a corner.
static void set_edge(const CutPatch& patch, std::int32_t i, std::int32_t j, std::int32_t k,
                     NodeBoundary& boundary) {
  const Vec3 &X = patch.X[i], forward = patch.X[j] - X, back = X - patch.X[k];
  boundary.freedom = NodeFreedom::fixed;
  if (forward.dot(back) < cos_sharp_edge * forward.norm() * back.norm()) return;
  boundary.freedom = NodeFreedom::edge;
  boundary.direction = (patch.X[j] - patch.X[k]).normalized();
  boundary.piece = {{X, patch.X[j], patch.X[j]}, {X, patch.X[k], patch.X[k]}};
}

NodeBoundary node_boundary(const CutPatch& patch, const CutStroke& stroke,
                           std::span<const std::uint8_t> cut_facets, std::int32_t i) {
  NodeBoundary boundary;
  if (patch.is_locked[i] != 0 || !patch.is_whole(i)) {
    boundary.freedom = NodeFreedom::fixed;
    return boundary;
  }
  std::vector<BoundFacet> bound = outer_facets(patch, stroke, cut_facets, i);
  const std::size_t n_outer = bound.size();
  if (!patch.region.empty()) add_interfaces(patch, i, bound);
  if (bound.empty()) return boundary;
  boundary.is_interface = bound.size() > n_outer;
  bool has_rim = false;
  const std::vector<std::int32_t> end = sharp_ends(patch, bound, i, has_rim);
  if (end.size() == 2 && !has_rim) {
    set_edge(patch, i, end[0], end[1], boundary);
    return boundary;
  }
  Vec3 normal = Vec3::Zero();
  for (const BoundFacet& facet : bound) {
    normal += facet.normal;
    boundary.piece.push_back(
        {patch.X[facet.node[0]], patch.X[facet.node[1]], patch.X[facet.node[2]]});
  }
  boundary.freedom = end.empty() ? NodeFreedom::surface : NodeFreedom::fixed;
  boundary.direction = normal.normalized();
  return boundary;
}

// The foot of the perpendicular if it lies inside, else the nearest point of the three sides.
static Vec3 nearest_on_triangle(const std::array<Vec3, 3>& t, const Vec3& X) {
  const Vec3 n = area_normal(t);
  const double n2 = n.squaredNorm();
  const auto is_within = [&](const Vec3& a, const Vec3& b) {
    return (b - a).cross(X - a).dot(n) >= 0;
  };
  if (n2 > 0 && is_within(t[0], t[1]) && is_within(t[1], t[2]) && is_within(t[2], t[0]))
    return X - n * (n.dot(X - t[0]) / n2);
  Vec3 nearest = nearest_on_segment(t[0], t[1], X);
  for (std::size_t k = 1; k < 3; ++k) {
    const Vec3 candidate = nearest_on_segment(t[k], t[(k + 1) % 3], X);
    if ((candidate - X).squaredNorm() < (nearest - X).squaredNorm()) nearest = candidate;
  }
  return nearest;
}

Vec3 project_to_boundary(const NodeBoundary& boundary, const Vec3& X) {
  if (boundary.freedom == NodeFreedom::free) return X;
  Vec3 nearest = X;
  double least = 0;
  bool is_first = true;
  for (const std::array<Vec3, 3>& piece : boundary.piece) {
    const Vec3 candidate = piece[1] == piece[2] ? nearest_on_segment(piece[0], piece[1], X)
                                                : nearest_on_triangle(piece, X);
    const double distance = (candidate - X).squaredNorm();
    if (!is_first && distance >= least) continue;
    nearest = candidate;
    least = distance;
    is_first = false;
  }
  return nearest;
}

Vec3 allowed_part(const NodeBoundary& boundary, const Vec3& displacement) {
  const Vec3& d = boundary.direction;
  switch (boundary.freedom) {
    case NodeFreedom::fixed:
      return Vec3::Zero();
    case NodeFreedom::edge:
      return d * d.dot(displacement);
    case NodeFreedom::surface:
      return displacement - d * d.dot(displacement);
    case NodeFreedom::free:
      break;
  }
  return displacement;
}

}  // namespace trocar
