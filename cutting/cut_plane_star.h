// The elements around a node, and the energy of the area step as a function of the node's position.
#pragma once

#include <array>

#include "cutting/cut_four.h"
#include "cutting/cut_plane_patch.h"

namespace trocar {

inline constexpr int max_star = 24;  // nodes of as many elements stay where they are

// Elements around a node by their opposite edges, b to c, valid until one of them is flipped. They
// come in fours: the first one follows the last, without weight.
struct PlaneStar {
  PlaneStar() {}  // leaves the arrays as they are: zeroing them took 4 % of a cut
  int n = 0;      // 0: not yet found
  std::array<int, max_star> b, c;
  // Of sum_e (A / A0 - 1)^2 + w S / A, S the sum of squared edges: 1 / A0, 2 w, and the area below
  // which an element is invalid.
  Four per_A0[max_star / 4], weight[max_star / 4], least_area[max_star / 4];
};
void find_star(const PlanePatch& patch, int node, PlaneStar& star);

// Moves a node downhill by a damped Newton step, along `side` unless that is zero; returns the
// distance. With AVX2 where the machine has it, to the same bits.
double relax(PlanePatch& patch, int node, const Vec2& side, const PlaneStar& star);
double relax_plain(PlanePatch& patch, int node, const Vec2& side, const PlaneStar& star);
double relax_avx2(PlanePatch& patch, int node, const Vec2& side, const PlaneStar& star);

}  // namespace trocar
