// A flat bounding-volume tree over the triangles of a surface: built once per topology, refitted
// to new positions. Its answers do not depend on how the tree was split: a rebuilt tree gives the
// same bits.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/box.h"
#include "collision/closest_point.h"

namespace trocar {

class SurfaceTree {
 public:
  // Splits at the median centroid along the longest side. triangle: node numbers into x.
  SurfaceTree(std::vector<std::array<std::int32_t, 3>> triangle, std::span<const Vec3> x);

  // Fits all boxes to new positions (n_nodes), which every query then refers to.
  void refit(std::span<const Vec3> x);

  // Triangles whose own bounding box overlaps `box`, ascending.
  void overlapping(const Box& box, std::vector<std::int32_t>& triangles) const;

  // How often the closed surface winds round p: 0 outside, 1 inside, 2 where it overlaps itself.
  int winding_number(const Vec3& p) const;

  // The nearest triangle that p lies behind (lowest number of equals): the way out for a p inside.
  // Nothing within `reach`: -1.
  std::int32_t nearest_exit(const Vec3& p, double reach) const;

  // Nodes and triangles, ascending, that face each other: a triangle of the node's has an outward
  // normal at more than 96 degrees to the triangle's. On the way from the positions of the last
  // refit to `ahead` (n_nodes) the node comes nearer to the triangle's box than `reach`, and at its
  // beginning or end it lies between `depth` below and `reach` over the triangle's plane, or passes
  // it. On a smooth surface that is little, and found without a look at most of it: parts of the
  // tree carry a box of their normals.
  struct Facing {
    std::int32_t node = 0, triangle = 0;
    double opposition = 0;  // the least n·n of the triangle and one of the node's
    std::int32_t own = 0;   // this one of the node's
  };
  std::vector<Facing> facing(std::span<const Vec3> ahead, double reach, double depth) const;

  Triangle corners(std::int32_t triangle) const;
  const Vec3& position(std::int32_t node) const { return x_[node]; }
  const std::array<std::int32_t, 3>& nodes(std::int32_t t) const { return triangle_[t]; }

 private:
  // The left child follows its parent. Leaves hold [first, first + count) of order_.
  struct Node {
    Box box;
    std::int32_t right = 0;
    std::int32_t first = 0, count = 0;  // count 0: not a leaf
  };
  void split(std::span<const Vec3> centroid, std::int32_t first, std::int32_t count);
  template <class Enters, class Visit>
  void walk(Enters enters, Visit visit) const;
  friend class FacingSearch;

  std::vector<std::array<std::int32_t, 3>> triangle_;
  std::vector<std::int32_t> order_;  // triangles as the leaves hold them
  std::vector<Box> box_;             // (n_triangles)
  std::vector<Node> node_;
  std::vector<Vec3> x_;  // positions of the last refit
};

}  // namespace trocar
