// What a good place for a node is: f = h^2/6 sum_a 1/altitude_a^2 of its elements (the explicit
// stability bound, 1 for the regular tetrahedron of edge h) squared, plus its squared distance to
// the swept surface. Exact derivatives: the volume is linear in a node, the sum of squared face
// areas quadratic.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "cutting/cut_four.h"

namespace trocar {

struct NodeEnergy {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
  Mat3 hessian = Mat3::Zero();
};

// A point with a fourth coordinate that nobody reads: it is loaded at once.
struct WidePoint {
  explicit WidePoint(const Vec3& p) : x{p.x(), p.y(), p.z(), 0} {}
  Four x;
};

// Four symmetric matrices.
struct FourForms {
  Four xx, yy, zz, yx, zx, zy;
};

// Four tetrahedra as functions of the way s that the node at one of their corners goes.
struct FourTets {
  Four V;  // six times the volume: V + dV.s
  Four S;  // the sum of the squared double areas of the facets: S + 2 half_dS.s + s.M s
  FourVectors dV, half_dS;
  FourForms M;
};

// The elements around a node; the last one fills up the last four.
struct TetStar {
  int n = 0;
  std::vector<FourTets> tets;
};

// What a star is made from.
struct StarNodes {
  std::span<const WidePoint> X;
  std::span<const std::array<std::int32_t, 4>> corner;  // of all elements
  std::span<const std::int32_t> element;                // those around the node
  std::int32_t node = 0;
};

// Takes up the star and adds the f^2 of its tetrahedra, which must have volume, and their
// derivatives by the node's position. With AVX2 where the machine has it, to the same bits.
void expand_star(const StarNodes& nodes, double h, TetStar& star, NodeEnergy& energy);
void expand_star_plain(const StarNodes& nodes, double h, TetStar& star, NodeEnergy& energy);
void expand_star_avx2(const StarNodes& nodes, double h, TetStar& star, NodeEnergy& energy);

// What a trial must keep to.
struct TrialLimits {
  double h = 0;      // [m]
  double step = 0;   // no step bound may sink below this [m]
  double least = 0;  // nor may the energy get here
};
// `value` and the f^2 of the star once the node has gone the way s; infinite where that breaks a
// limit.
double try_star(const TetStar& star, const Vec3& s, const TrialLimits& limits, double value);
double try_star_plain(const TetStar& star, const Vec3& s, const TrialLimits& limits, double value);
double try_star_avx2(const TetStar& star, const Vec3& s, const TrialLimits& limits, double value);

}  // namespace trocar
