// f^2 = (h^2/6)^2 S^2 / V^4 with S = sum of |2 area|^2 and V = 6 volumes.
#include "cutting/cut_energy.h"

#include <algorithm>
#include <limits>

#include "cutting/cut_patch.h"

namespace trocar {

namespace {

[[gnu::always_inline]] inline FourVectors product(const FourForms& M, const FourVectors& a) {
  return {M.xx * a.x + M.yx * a.y + M.zx * a.z, M.yx * a.x + M.yy * a.y + M.zy * a.z,
          M.zx * a.x + M.zy * a.y + M.zz * a.z};
}

// Sum of dd I - d d^T over three edges: |d x u|^2 = u.(dd I - d d^T) u.
[[gnu::always_inline]] inline FourForms edge_form(const FourVectors& a, const FourVectors& b,
                                                  const FourVectors& c) {
  const Four xx = a.x * a.x + b.x * b.x + c.x * c.x, yy = a.y * a.y + b.y * b.y + c.y * c.y,
             zz = a.z * a.z + b.z * b.z + c.z * c.z;
  return {yy + zz,
          xx + zz,
          xx + yy,
          -(a.y * a.x + b.y * b.x + c.y * c.x),
          -(a.z * a.x + b.z * b.x + c.z * c.x),
          -(a.z * a.y + b.z * b.y + c.z * c.y)};
}

// Of nodes at p with the facets q across: the edges of these, d, make S = |n|^2 + sum of |d x u|^2
// with u from the edge to p; of the one opposite q0, u = (p - q0) + (q0 - q1).
[[gnu::always_inline]] inline void set_shape(const FourVectors& p, const FourVectors (&q)[3],
                                             FourTets& t) {
  const FourVectors d0 = q[0] - q[1], d1 = q[1] - q[2], d2 = q[2] - q[0], u = p - q[0];
  const FourVectors n = cross(d0, d1), w = cross(d1, n);
  t.M = edge_form(d0, d1, d2);
  t.half_dS = product(t.M, u) + w;
  t.dV = {-n.x, -n.y, -n.z};
  t.V = dot(t.dV, u);
  t.S = dot(u, t.half_dS + w) + 2 * dot(n, n);
}

// Four elements of the star from the k-th on.
[[gnu::always_inline]] inline void load(const StarNodes& nodes, std::size_t k, FourTets& tets) {
  const std::size_t last = nodes.element.size() - 1;
  const std::int32_t* corner[4];
  const int* facet[4];
  for (std::size_t lane = 0; lane < 4; ++lane) {
    corner[lane] = nodes.corner[nodes.element[std::min(k + lane, last)]].data();
    const auto is_at = [&](int c) { return corner[lane][c] == nodes.node ? c : 0; };
    facet[lane] = tet_facets[is_at(1) + is_at(2) + is_at(3)].data();
  }
  const auto X = [&](std::size_t lane, int c) -> const Four& {
    return nodes.X[corner[lane][facet[lane][c]]].x;
  };
  FourVectors q[3];
  for (int c = 0; c < 3; ++c) {
    const FourColumns of(X(0, c), X(1, c), X(2, c), X(3, c));
    q[c] = {of.column[0], of.column[1], of.column[2]};
  }
  const Four& p = nodes.X[nodes.node].x;
  set_shape({Four{} + p[0], Four{} + p[1], Four{} + p[2]}, q, tets);
}

// Lanes that hold one of `left` elements.
struct Lanes {
  [[gnu::always_inline]] explicit Lanes(int left)
      : mask(FourMask{0, 1, 2, 3} < FourMask{} + left) {}
  [[gnu::always_inline]] void keep(Four& a) const { a = mask ? a : Four{}; }
  FourMask mask;
};

// f^2 = g and, with a = dS / S and b = dV / V, its derivatives g (2 a - 4 b) and
// g (2 a a^T - 8 (a b^T + b a^T) + 20 b b^T + 4 M / S).
struct Sums {
  [[gnu::always_inline]] void add(const FourTets& t, double h, int left) {
    const Four by_V = 1 / t.V, by_S = 1 / t.S, f = h * h / 6 * t.S * by_V * by_V;
    Four g = f * f;
    Lanes(left).keep(g);
    const FourVectors a = (2 * by_S) * t.half_dS, b = by_V * t.dV;
    const FourVectors ga = g * a, gb = g * b, ga2 = ga + ga, gb4 = (Four{} + 4) * gb;
    const FourVectors slope = ga2 - gb4, p = slope - gb4,
                      r = (Four{} + 20) * gb - (Four{} + 8) * ga;
    const Four m = 4 * g * by_S;
    value += g;
    gradient = gradient + slope;
    H.xx += a.x * p.x + b.x * r.x + m * t.M.xx;
    H.yy += a.y * p.y + b.y * r.y + m * t.M.yy;
    H.zz += a.z * p.z + b.z * r.z + m * t.M.zz;
    H.yx += a.y * p.x + b.y * r.x + m * t.M.yx;
    H.zx += a.z * p.x + b.z * r.x + m * t.M.zx;
    H.zy += a.z * p.y + b.z * r.y + m * t.M.zy;
  }
  [[gnu::always_inline]] void add_to(NodeEnergy& e) const {
    e.value += sum(value);
    e.gradient += Vec3(sum(gradient.x), sum(gradient.y), sum(gradient.z));
    const double yx = sum(H.yx), zx = sum(H.zx), zy = sum(H.zy);
    Mat3 matrix;
    matrix << sum(H.xx), yx, zx, yx, sum(H.yy), zy, zx, zy, sum(H.zz);
    e.hessian += matrix;
  }
  Four value{};
  FourVectors gradient{};
  FourForms H{};
};

[[gnu::always_inline]] inline void expand(const StarNodes& nodes, double h, TetStar& star,
                                          NodeEnergy& energy) {
  star.n = static_cast<int>(nodes.element.size());
  star.tets.resize((nodes.element.size() + 3) / 4);
  Sums sums;
  int left = star.n;
  for (std::size_t k = 0; k < star.tets.size(); ++k, left -= 4) {
    load(nodes, 4 * k, star.tets[k]);
    sums.add(star.tets[k], h, left);
  }
  sums.add_to(energy);
}

[[gnu::always_inline]] inline double value_after(const TetStar& star, const Vec3& way,
                                                 const TrialLimits& limits, double value) {
  const FourVectors s{Four{} + way.x(), Four{} + way.y(), Four{} + way.z()};
  Four added{};
  FourMask is_bad{};
  int left = star.n;
  for (const FourTets& t : star.tets) {
    const Four V = t.V + dot(t.dV, s);
    const Four S = t.S + dot(s, (t.half_dS + t.half_dS) + product(t.M, s));
    is_bad |= V > 0 ? V * V < limits.step * limits.step * S : ~FourMask{};
    const Four by_V = 1 / V, f = limits.h * limits.h / 6 * S * by_V * by_V;
    Four g = f * f;
    Lanes(left).keep(g);
    added += g;
    left -= 4;
  }
  value += sum(added);
  const bool is_broken = (is_bad[0] | is_bad[1] | is_bad[2] | is_bad[3]) != 0;
  return !is_broken && value < limits.least ? value : std::numeric_limits<double>::infinity();
}

}  // namespace

void expand_star_plain(const StarNodes& nodes, double h, TetStar& star, NodeEnergy& energy) {
  expand(nodes, h, star, energy);
}
[[gnu::target("avx2")]] void expand_star_avx2(const StarNodes& nodes, double h, TetStar& star,
                                              NodeEnergy& energy) {
  expand(nodes, h, star, energy);
}
double try_star_plain(const TetStar& star, const Vec3& s, const TrialLimits& limits, double value) {
  return value_after(star, s, limits, value);
}
[[gnu::target("avx2")]] double try_star_avx2(const TetStar& star, const Vec3& s,
                                             const TrialLimits& limits, double value) {
  return value_after(star, s, limits, value);
}

void expand_star(const StarNodes& nodes, double h, TetStar& star, NodeEnergy& energy) {
  static const auto chosen = has_avx2() ? expand_star_avx2 : expand_star_plain;
  chosen(nodes, h, star, energy);
}
double try_star(const TetStar& star, const Vec3& s, const TrialLimits& limits, double value) {
  static const auto chosen = has_avx2() ? try_star_avx2 : try_star_plain;
  return chosen(star, s, limits, value);
}

}  // namespace trocar
