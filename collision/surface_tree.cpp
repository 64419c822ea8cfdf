#include "collision/surface_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trocar {

namespace {

constexpr std::int32_t leaf_size = 4;

// On which side of the line a -> b, seen from above, p lies: -1 or 1. Zeros are decided as if p
// were moved by (eps, eps^2), so that a ray never slips between two triangles.
int side_of(const Vec3& a, const Vec3& b, const Vec3& p) {
  const double area = (a.x() - p.x()) * (b.y() - p.y()) - (b.x() - p.x()) * (a.y() - p.y());
  if (area != 0) return area > 0 ? 1 : -1;
  if (a.y() != b.y()) return a.y() > b.y() ? 1 : -1;
  return b.x() > a.x() ? 1 : -1;
}

bool is_above(const Triangle& x, const Vec3& p) {
  const Vec3 normal = area_normal(x);
  const double height = normal.dot(x[0] - p);
  return normal.z() > 0 ? height > 0 : height < 0;
}

}  // namespace

SurfaceTree::SurfaceTree(std::vector<std::array<std::int32_t, 3>> triangle, std::span<const Vec3> x)
    : triangle_(std::move(triangle)), order_(triangle_.size()), box_(triangle_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> centroid(triangle_.size());
  for (std::size_t t = 0; t < triangle_.size(); ++t) {
    centroid[t].setZero();
    for (const std::int32_t i : triangle_[t]) centroid[t] += x[i];
  }
  if (!triangle_.empty()) split(centroid, 0, static_cast<std::int32_t>(order_.size()));
  refit(x);
}

void SurfaceTree::split(std::span<const Vec3> centroid, std::int32_t first, std::int32_t count) {
  const std::size_t self = node_.size();
  node_.push_back({.first = first, .count = count});
  if (count <= leaf_size) return;
  node_[self].count = 0;
  Box box;
  for (std::int32_t k = first; k < first + count; ++k) box.add(centroid[order_[k]]);
  Eigen::Index axis = 0;
  box.size().maxCoeff(&axis);
  const std::int32_t half = count / 2;
  std::nth_element(order_.begin() + first, order_.begin() + first + half,
                   order_.begin() + first + count, [&](std::int32_t a, std::int32_t b) {
                     const double xa = centroid[a][axis], xb = centroid[b][axis];
                     return xa != xb ? xa < xb : a < b;
                   });
  split(centroid, first, half);
  node_[self].right = static_cast<std::int32_t>(node_.size());
  split(centroid, first + half, count - half);
}

void SurfaceTree::refit(std::span<const Vec3> x) {
  x_.assign(x.begin(), x.end());
  for (std::size_t t = 0; t < triangle_.size(); ++t) {
    box_[t] = Box();
    for (const std::int32_t i : triangle_[t]) box_[t].add(x_[i]);
  }
  for (std::size_t k = node_.size(); k-- > 0;) {  // children stand behind their parents
    Node& node = node_[k];
    node.box = Box();
    if (node.count == 0) {
      node.box.add(node_[k + 1].box);
      node.box.add(node_[node.right].box);
    }
    for (std::int32_t j = node.first; j < node.first + node.count; ++j)
      node.box.add(box_[order_[j]]);
  }
}

template <class Enters, class Visit>
void SurfaceTree::walk(Enters enters, Visit visit) const {
  std::array<std::size_t, 64> stack{};  // halving 2^31 triangles goes 31 deep
  std::size_t depth = 0;
  if (!node_.empty()) stack[depth++] = 0;
  while (depth > 0) {
    const std::size_t k = stack[--depth];
    const Node& node = node_[k];
    if (!enters(node.box)) continue;
    if (node.count == 0) {
      stack[depth++] = static_cast<std::size_t>(node.right);
      stack[depth++] = k + 1;
    }
    for (std::int32_t j = node.first; j < node.first + node.count; ++j) {
      const std::int32_t t = order_[j];
      if (enters(box_[t])) visit(t);
    }
  }
}

void SurfaceTree::overlapping(const Box& box, std::vector<std::int32_t>& triangles) const {
  triangles.clear();
  walk([&](const Box& other) { return box.overlaps(other); },
       [&](std::int32_t t) { triangles.push_back(t); });
  std::sort(triangles.begin(), triangles.end());
}

int SurfaceTree::winding_number(const Vec3& p) const {
  int winding = 0;
  const auto can_be_above = [&](const Box& box) {
    return box.low.x() <= p.x() && p.x() <= box.high.x() && box.low.y() <= p.y() &&
           p.y() <= box.high.y() && box.high.z() >= p.z();
  };
  walk(can_be_above, [&](std::int32_t t) {
    const Triangle x = corners(t);
    const int side = side_of(x[0], x[1], p);
    if (side != side_of(x[1], x[2], p) || side != side_of(x[2], x[0], p)) return;
    if (is_above(x, p)) winding += side;
  });
  return winding;
}

std::int32_t SurfaceTree::nearest_exit(const Vec3& p, double reach) const {
  double best2 = reach * reach;
  std::int32_t best = -1;
  // The slack keeps triangles whose closest point lies outside their box by rounding.
  walk([&](const Box& box) { return box.distance2(p) * (1 - 1e-9) <= best2; },
       [&](std::int32_t t) {
         const Triangle x = corners(t);
         const Vec3 to_surface = closest_point_triangle(p, x).point - p;
         const double distance2 = to_surface.squaredNorm();
         if (distance2 > best2 || (distance2 == best2 && best >= 0 && t > best)) return;
         if (to_surface.dot(area_normal(x)) <= 0) return;
         best2 = distance2;
         best = t;
       });
  return best;
}

Triangle SurfaceTree::corners(std::int32_t t) const {
  const std::array<std::int32_t, 3>& node = nodes(t);
  return {x_[node[0]], x_[node[1]], x_[node[2]]};
}

}  // namespace trocar
