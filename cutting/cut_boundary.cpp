// Classification of boundary nodes by the angles between the facets around them.
#include "cutting/cut_boundary.h"

#include <algorithm>
#include <cmath>

namespace trocar {

// Facets that meet at more than 40 degrees make a sharp edge; an edge that bends by more is a
// corner.
static constexpr double cos_sharp = 0.766;

namespace {

struct OuterFacet {
  std::array<std::int32_t, 3> node;
  Vec3 normal;  // length: twice the area
  bool is_cut;  // opened by an older stroke
};

}  // namespace

static std::vector<OuterFacet> outer_facets(const CutPatch& patch, const CutStroke& stroke,
                                            std::span<const std::uint8_t> cut_facets,
                                            std::int32_t i) {
  std::vector<OuterFacet> outer;
  for (const std::int32_t e : patch.star(i)) {
    for (int f = 0; f < 4; ++f) {
      if (patch.across[e][f] >= 0 || patch.corner[e][f] == i) continue;
      const std::uint8_t* opened = find_element(stroke.opened, patch.element[e]);
      if (opened != nullptr && (*opened >> f & 1) != 0) continue;
      const std::array<std::int32_t, 3> node = facet_nodes(patch, e, f);
      const Vec3& o = patch.X[node[0]];
      outer.push_back({node, (patch.X[node[1]] - o).cross(patch.X[node[2]] - o),
                       (cut_facets[patch.element[e]] >> f & 1) != 0});
    }
  }
  return outer;
}

// Node other than i that both facets have, -1 if there is none.
static std::int32_t shared_node(const OuterFacet& p, const OuterFacet& q, std::int32_t i) {
  for (const std::int32_t j : p.node)
    if (j != i && std::find(q.node.begin(), q.node.end(), j) != q.node.end()) return j;
  return -1;
}

// Other ends of the sharp edges at node i; `has_rim`: one of them is the inner rim of an older cut.
static std::vector<std::int32_t> sharp_ends(const std::vector<OuterFacet>& outer, std::int32_t i,
                                            bool& has_rim) {
  std::vector<std::int32_t> end;
  has_rim = false;
  for (std::size_t p = 0; p < outer.size(); ++p)
    for (std::size_t q = p + 1; q < outer.size(); ++q) {
      const std::int32_t j = shared_node(outer[p], outer[q], i);
      if (j < 0) continue;
      const double cosine = outer[p].normal.dot(outer[q].normal);
      if (cosine >= cos_sharp * outer[p].normal.norm() * outer[q].normal.norm()) continue;
      end.push_back(j);
      has_rim = has_rim || (outer[p].is_cut && outer[q].is_cut);
    }
  return end;
}

static NodeBoundary edge_boundary(const CutPatch& patch, std::int32_t i, std::int32_t j,
                                  std::int32_t k) {
  const Vec3 &X = patch.X[i], forward = patch.X[j] - X, back = X - patch.X[k];
  NodeBoundary boundary;
  boundary.freedom = NodeFreedom::fixed;
  if (forward.dot(back) < cos_sharp * forward.norm() * back.norm()) return boundary;
  boundary.freedom = NodeFreedom::edge;
  boundary.direction = (patch.X[j] - patch.X[k]).normalized();
  boundary.piece = {{X, patch.X[j], patch.X[j]}, {X, patch.X[k], patch.X[k]}};
  return boundary;
}

NodeBoundary node_boundary(const CutPatch& patch, const CutStroke& stroke,
                           std::span<const std::uint8_t> cut_facets, std::int32_t i) {
  NodeBoundary boundary;
  if (patch.is_locked[i] != 0 || !patch.is_whole(i)) {
    boundary.freedom = NodeFreedom::fixed;
    return boundary;
  }
  const std::vector<OuterFacet> outer = outer_facets(patch, stroke, cut_facets, i);
  if (outer.empty()) return boundary;
  bool has_rim = false;
  const std::vector<std::int32_t> end = sharp_ends(outer, i, has_rim);
  if (end.size() == 2 && !has_rim) return edge_boundary(patch, i, end[0], end[1]);
  Vec3 normal = Vec3::Zero();
  for (const OuterFacet& facet : outer) {
    normal += facet.normal;
    boundary.piece.push_back(
        {patch.X[facet.node[0]], patch.X[facet.node[1]], patch.X[facet.node[2]]});
  }
  boundary.freedom = end.empty() ? NodeFreedom::surface : NodeFreedom::fixed;
  boundary.direction = normal.normalized();
  return boundary;
}

static Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& X) {
  const Vec3 d = b - a;
  const double s = d.dot(X - a) / d.squaredNorm();
  return a + std::clamp(s, 0.0, 1.0) * d;
}

// The foot of the perpendicular if it lies inside, else the nearest point of the three sides.
static Vec3 nearest_on_triangle(const std::array<Vec3, 3>& t, const Vec3& X) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
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
