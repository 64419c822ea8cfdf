// Newton steps node by node in ascending order, each with a line search that only accepts valid
// stars.
#include "cutting/cut_move.h"

#include <algorithm>
#include <cmath>

#include "cutting/cut_energy.h"

namespace trocar {

static constexpr int max_sweeps = 10;
// Weight of (distance / h)^2 against f^2, inside and where the lips of the wound show.
static constexpr double inner_weight = 80, outer_weight = 300;
static constexpr double longest_relaxing_step = 0.3;  // of h
static constexpr double smallest_motion = 2e-3;       // of h: less counts as rest

namespace {

struct Descent {
  const CutSurroundings& around;
  const std::vector<NodeRole>& role;
  MoveLimits limits;
  std::vector<Vec3>& X;
  std::vector<WidePoint> at;  // the same as X
  TetStar star;               // of a node
};

struct SurfaceTerm {
  SurfacePlane plane;
  double weight = 0;  // 0: none
};

}  // namespace

double surface_distance(const CutSurroundings& around, std::int32_t i, const Vec3& X) {
  const std::span<const SurfacePoint> points = around.points.of(i);
  return points.empty() ? 0 : std::abs(fit_surface(points, X, around.h).distance(X));
}

static SurfaceTerm surface_term(const Descent& d, std::int32_t i) {
  const std::span<const SurfacePoint> points = d.around.points.of(i);
  if (d.role[i] != NodeRole::on_surface || points.empty()) return {};
  const bool is_inner = d.around.boundary[i].freedom == NodeFreedom::free;
  return {fit_surface(points, d.X[i], d.around.h), is_inner ? inner_weight : outer_weight};
}

static double term_value(const Descent& d, const SurfaceTerm& term, const Vec3& X) {
  const double phi = term.plane.distance(X) / d.around.h;
  return term.weight * phi * phi;
}

static NodeEnergy node_energy(Descent& d, std::int32_t i, const SurfaceTerm& term) {
  NodeEnergy energy;
  const double h = d.around.h, phi = term.plane.distance(d.X[i]) / h;
  energy.value = term.weight * phi * phi;
  energy.gradient = 2 * term.weight * phi / h * term.plane.N;
  energy.hessian = 2 * term.weight / (h * h) * term.plane.N * term.plane.N.transpose();
  expand_star({d.at, d.around.patch.corner, d.around.patch.star(i), i}, h, d.star, energy);
  return energy;
}

// x with K x = r, by K = L D L^T; false if K is not positive definite.
static bool solve(const Mat3& K, const Vec3& r, Vec3& x) {
  const double d0 = K(0, 0), l10 = K(1, 0) / d0, l20 = K(2, 0) / d0;
  const double d1 = K(1, 1) - l10 * K(1, 0), k21 = K(2, 1) - l20 * K(1, 0), l21 = k21 / d1;
  const double d2 = K(2, 2) - l20 * K(2, 0) - l21 * k21;
  if (!(d0 > 0 && d1 > 0 && d2 > 0)) return false;
  const double y1 = r[1] - l10 * r[0], y2 = r[2] - l20 * r[0] - l21 * y1;
  x[2] = y2 / d2;
  x[1] = y1 / d1 - l21 * x[2];
  x[0] = r[0] / d0 - l10 * x[1] - l20 * x[2];
  return true;
}

// Newton's step within what the boundary allows; downhill also where the Hessian is not definite.
static Vec3 newton_step(const NodeEnergy& energy, const NodeBoundary& boundary, double h) {
  const double size = energy.hessian.cwiseAbs().maxCoeff();
  Mat3 P = Mat3::Identity(), K = energy.hessian;
  if (boundary.freedom != NodeFreedom::free) {
    for (int k = 0; k < 3; ++k) P.col(k) = allowed_part(boundary, Vec3(Vec3::Unit(k)));
    K = P * energy.hessian * P + size * (Mat3::Identity() - P);
  }
  const Vec3 g = P * energy.gradient;
  Vec3 step = Vec3::Zero();
  for (double shift = 1e-6; shift < 10; shift *= 30) {
    if (!solve(K + shift * size * Mat3::Identity(), -g, step)) continue;
    step = P * step;
    break;
  }
  const double length = step.norm();
  return length > longest_relaxing_step * h ? Vec3(step * (longest_relaxing_step * h / length))
                                            : step;
}

// Puts node i to `to` if `is_better` says so there, else leaves it.
template <class IsBetter>
static bool try_position(Descent& d, std::int32_t i, const Vec3& to, const IsBetter& is_better) {
  const Vec3 from = d.X[i];
  d.X[i] = project_to_boundary(d.around.boundary[i], to);
  if (is_better()) return true;
  d.X[i] = from;
  return false;
}

// The lesser of the floor and the least step bound of the star: most lie far above the floor, which
// their shapes tell without roots.
static double least_step(const Descent& d, std::int32_t i) {
  constexpr double rounding = 1e-3;
  const double floor = d.limits.floor, clear = (1 + rounding) * floor * floor;
  for (const FourTets& t : d.star.tets)
    for (int lane = 0; lane < 4; ++lane)
      if (!(t.V[lane] > 0 && t.V[lane] * t.V[lane] > clear * t.S[lane]))
        return std::min(floor, star_step(d.around.patch, d.X, i));
  return floor;
}

// Returns how far the node has gone.
static double descend(Descent& d, std::int32_t i) {
  const SurfaceTerm term = surface_term(d, i);
  const NodeEnergy energy = node_energy(d, i, term);
  if (!std::isfinite(energy.value)) return 0;
  const TrialLimits limits{d.around.h, least_step(d, i), energy.value};
  const Vec3 from = d.X[i];
  Vec3 step = newton_step(energy, d.around.boundary[i], d.around.h);
  for (int trial = 0; trial < 5; ++trial, step *= 0.5) {
    const Vec3 to = project_to_boundary(d.around.boundary[i], from + step);
    if (!(try_star(d.star, to - from, limits, term_value(d, term, to)) < energy.value)) continue;
    d.X[i] = to;
    d.at[i] = WidePoint(to);
    return (to - from).norm();
  }
  return 0;
}

Vec3 foot_on_surface(const CutSurroundings& around, std::int32_t i, const Vec3& X) {
  if (around.points.of(i).empty()) return X;
  Vec3 foot = X;
  for (int k = 0; k < 4; ++k) {
    const SurfacePlane plane = fit_surface(around.points.of(i), foot, around.h);
    const Vec3 way = allowed_part(around.boundary[i], plane.N);
    const double slope = way.dot(plane.N);
    if (!(slope > 0.05)) return X;
    foot = project_to_boundary(around.boundary[i], foot - way * (plane.distance(foot) / slope));
  }
  return foot;
}

static void snap(Descent& d, std::int32_t i) {
  if (d.around.points.of(i).empty()) return;
  const double step = star_step(d.around.patch, d.X, i);
  if (!(step > 0)) return;
  const double least = std::min(d.limits.snap, step);
  const Vec3 from = d.X[i], to = foot_on_surface(d.around, i, d.X[i]);
  for (const double part : {1.0, 0.5, 0.25})
    if (try_position(d, i, from + part * (to - from),
                     [&] { return star_step(d.around.patch, d.X, i) >= least; }))
      return;
}

void move_nodes(const CutSurroundings& around, const std::vector<NodeRole>& role,
                const MoveLimits& limits, std::vector<Vec3>& X) {
  Descent d{around, role, limits, X, {X.begin(), X.end()}, {}};
  std::vector<std::int32_t> movable;
  for (std::int32_t i = 0; i < around.patch.n_nodes(); ++i)
    if (role[i] != NodeRole::stays && around.boundary[i].freedom != NodeFreedom::fixed)
      movable.push_back(i);
  // A node is looked at again while it or a neighbour moves.
  std::vector<std::uint8_t> is_active(role.size(), 1);
  bool is_moving = true;
  for (int sweep = 0; sweep < max_sweeps && is_moving; ++sweep) {
    is_moving = false;
    for (const std::int32_t i : movable) {
      if (is_active[i] == 0) continue;
      is_active[i] = 0;
      if (descend(d, i) <= smallest_motion * around.h) continue;
      is_moving = true;
      for (const std::int32_t e : around.patch.star(i))
        for (const std::int32_t j : around.patch.corner[e]) is_active[j] = 1;
    }
  }
  for (const std::int32_t i : movable)
    if (role[i] == NodeRole::on_surface) snap(d, i);
}

}  // namespace trocar
