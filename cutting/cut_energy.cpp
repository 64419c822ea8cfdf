// f^2 = (h^2/6)^2 S^2 / V^4 with S = sum of |2 area|^2 and V = 6 volumes.
#include "cutting/cut_energy.h"

#include <algorithm>
#include <limits>

#include "cutting/cut_patch.h"

namespace trocar {

TetShape tet_shape(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner) {
  const Vec3& o = X[corner[0]];
  const Vec3 a = X[corner[1]] - o, b = X[corner[2]] - o, c = X[corner[3]] - o;
  const Vec3 n = a.cross(b), m = b.cross(c), k = c.cross(a);
  return {n.dot(c),
          n.squaredNorm() + m.squaredNorm() + k.squaredNorm() + (n + m + k).squaredNorm()};
}

double stability_bound(const TetShape& shape, double h) {
  if (!(shape.V > 0)) return std::numeric_limits<double>::infinity();
  return h * h / 6 * shape.S / (shape.V * shape.V);
}

double stability_bound(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner,
                       double h) {
  return stability_bound(tet_shape(X, corner), h);
}

// Two tetrahedra at a time, each with the bits that it has alone.
using TwoDoubles = double __attribute__((vector_size(16)));
using PairVec = std::array<TwoDoubles, 3>;

static PairVec difference(const PairVec& a, const PairVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
static TwoDoubles dot(const PairVec& a, const PairVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static PairVec cross(const PairVec& a, const PairVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

namespace {

struct PairTerms {
  TwoDoubles value;
  PairVec gradient;
  std::array<PairVec, 3> hessian;
};

}  // namespace

// For an edge d of the facet across and u from its end to p: S grows by |d x u|^2.
static void add_edge(const PairVec& d, const PairVec& u, PairVec& half_dS,
                     std::array<PairVec, 3>& half_ddS) {
  const TwoDoubles dd = dot(d, d), du = dot(d, u);
  for (std::size_t i = 0; i < 3; ++i) {
    half_dS[i] += dd * u[i] - du * d[i];
    half_ddS[i][i] += dd - d[i] * d[i];
    for (std::size_t j = 0; j < i; ++j) half_ddS[i][j] -= d[i] * d[j];
  }
}

static PairTerms squared_bounds(const PairVec& p, const std::array<PairVec, 3>& q, TwoDoubles V,
                                TwoDoubles S, double h) {
  PairVec dS{};
  std::array<PairVec, 3> half_ddS{};
  for (std::size_t k = 0; k < 3; ++k)
    add_edge(difference(q[k], q[(k + 1) % 3]), difference(p, q[(k + 1) % 3]), dS, half_ddS);
  const PairVec minus_dV = cross(difference(q[1], q[0]), difference(q[2], q[0]));
  const TwoDoubles c = h * h / 6 * S / (V * V), g = c * c;
  PairTerms terms{.value = g, .gradient = {}, .hessian = {}};
  PairVec log_gradient;
  for (std::size_t i = 0; i < 3; ++i) {
    dS[i] = 2 * dS[i];
    log_gradient[i] = 2 / S * dS[i] + 4 / V * minus_dV[i];
    terms.gradient[i] = g * log_gradient[i];
  }
  const TwoDoubles by_S = 2 / S, by_S2 = 2 / (S * S), by_V2 = 4 / (V * V);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      terms.hessian[i][j] = g * (log_gradient[i] * log_gradient[j] +
                                 by_S * (2 * half_ddS[std::max(i, j)][std::min(i, j)]) -
                                 by_S2 * dS[i] * dS[j] + by_V2 * minus_dV[i] * minus_dV[j]);
  return terms;
}

static void add_lane(const PairTerms& terms, int lane, NodeEnergy& energy) {
  energy.value += terms.value[lane];
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    energy.gradient[i] += terms.gradient[row][lane];
    for (int j = 0; j < 3; ++j)
      energy.hessian(i, j) += terms.hessian[row][static_cast<std::size_t>(j)][lane];
  }
}

void add_squared_bounds(const Vec3& p, std::span<const TetAtNode> tets, double h,
                        NodeEnergy& energy) {
  const PairVec at = {TwoDoubles{p[0], p[0]}, TwoDoubles{p[1], p[1]}, TwoDoubles{p[2], p[2]}};
  for (std::size_t k = 0; k < tets.size(); k += 2) {
    const TetAtNode &a = tets[k], &b = tets[std::min(k + 1, tets.size() - 1)];
    std::array<PairVec, 3> q;
    for (std::size_t n = 0; n < 3; ++n)
      for (int j = 0; j < 3; ++j)
        q[n][static_cast<std::size_t>(j)] = TwoDoubles{(*a.q[n])[j], (*b.q[n])[j]};
    const PairTerms terms = squared_bounds(at, q, TwoDoubles{a.shape.V, b.shape.V},
                                           TwoDoubles{a.shape.S, b.shape.S}, h);
    add_lane(terms, 0, energy);
    if (k + 1 < tets.size()) add_lane(terms, 1, energy);
  }
}

}  // namespace trocar
