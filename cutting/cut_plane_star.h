// The elements around a node, and the energy of the area step as a function of the node's position.
// Two elements are computed at a time; sums go over the elements in their order.
#pragma once

#include <array>

#include "cutting/cut_plane_patch.h"

namespace trocar {

inline constexpr int max_star = 24;  // nodes of as many elements stay where they are

// Elements around a node by their opposite edges, b to c, valid until one of them is flipped.
struct PlaneStar {
  PlaneStar() {}  // leaves the arrays as they are: zeroing them took 4 % of a cut
  int n = 0;      // 0: not yet found
  bool is_ring;   // c of each element is b of the next one: the node is an inner one
  std::array<int, max_star> b, c;
  std::array<double, max_star + 1> per_A0;  // and the first once more
};
void find_star(const PlanePatch& patch, int node, PlaneStar& star);

// sum_e (A/A0 - 1)^2 + w S/A with S the sum of squared edges; infinite if an element is inverted.
double star_energy(const PlanePatch& patch, const PlaneStar& star, const Vec2& x);

struct StarExpansion {
  double E = 0;
  Vec2 g = Vec2::Zero();
  double Hxx = 0, Hxy = 0, Hyy = 0;
};
// The same with its derivatives.
StarExpansion expand_energy(const PlanePatch& patch, const PlaneStar& star, const Vec2& x);

}  // namespace trocar
