// f^2 = (h^2/6)^2 S^2 / V^4 with S = sum of |2 area|^2 and V = 6 volumes. Each element has the bits
// that it has alone, and they are added in their order.
#include "cutting/cut_energy.h"

#include <algorithm>
#include <limits>

namespace trocar {

namespace {

[[gnu::always_inline]] inline void set_shape(const FourVectors& o, const FourVectors& p,
                                             const FourVectors& q, const FourVectors& r, Four& V,
                                             Four& S) {
  const FourVectors a = p - o, b = q - o, c = r - o;
  const FourVectors n = cross(a, b), m = cross(b, c), k = cross(c, a), sum = n + m + k;
  V = dot(n, c);
  S = dot(n, n) + dot(m, m) + dot(k, k) + dot(sum, sum);
}

// Four elements of the star from the k-th on.
[[gnu::always_inline]] inline void load(const StarNodes& nodes, std::size_t k, FourTets& tets) {
  const std::size_t last = nodes.element.size() - 1;
  const auto corners = [&](std::size_t lane) {
    return nodes.corner[nodes.element[std::min(k + lane, last)]].data();
  };
  const std::int32_t* corner[4] = {corners(0), corners(1), corners(2), corners(3)};
  for (std::size_t c = 0; c < 4; ++c) {
    const std::int32_t i[4] = {corner[0][c], corner[1][c], corner[2][c], corner[3][c]};
    const FourColumns X(nodes.X[i[0]].x, nodes.X[i[1]].x, nodes.X[i[2]].x, nodes.X[i[3]].x);
    tets.X[c] = {X.column[0], X.column[1], X.column[2]};
    tets.is_node[c] = FourMask{i[0], i[1], i[2], i[3]} == FourMask{} + nodes.node;
  }
  set_shape(tets.X[0], tets.X[1], tets.X[2], tets.X[3], tets.V, tets.S);
}

// Derivatives of S by the node at p, by halves: for an edge d of the facet across and u from its
// end to p, S grows by |d x u|^2.
struct HalfSlopes {
  [[gnu::always_inline]] void add_edge(const FourVectors& d, const FourVectors& u) {
    const Four dd = dot(d, d), du = dot(d, u);
    S = S + (dd * u - du * d);
    xx += dd - d.x * d.x;
    yy += dd - d.y * d.y;
    zz += dd - d.z * d.z;
    yx -= d.y * d.x;
    zx -= d.z * d.x;
    zy -= d.z * d.y;
  }
  FourVectors S{};
  Four xx{}, yy{}, zz{}, yx{}, zx{}, zy{};
};

// Sums of 13 numbers of elements, element by element.
struct Sums {
  [[gnu::always_inline]] explicit Sums(const NodeEnergy& e)
      : value{e.value, e.gradient[0], e.gradient[1], e.gradient[2]},
        row{{e.hessian(0, 0), e.hessian(0, 1), e.hessian(0, 2), 0},
            {e.hessian(1, 0), e.hessian(1, 1), e.hessian(1, 2), 0},
            {e.hessian(2, 0), e.hessian(2, 1), e.hessian(2, 2), 0}} {}
  [[gnu::always_inline]] void store(NodeEnergy& e) const {
    e.value = value[0];
    for (int i = 0; i < 3; ++i) {
      e.gradient[i] = value[i + 1];
      for (int j = 0; j < 3; ++j) e.hessian(i, j) = row[i][j];
    }
  }
  // The first n of the four.
  [[gnu::always_inline]] static void add(const FourColumns& of, int n, Four& sum) {
    sum += of.column[0];
    if (n > 1) sum += of.column[1];
    if (n > 2) sum += of.column[2];
    if (n > 3) sum += of.column[3];
  }
  Four value, row[3];
};

[[gnu::always_inline]] inline void add_squared_bounds(const FourTets& tets, int n, double h,
                                                      Sums& sums) {
  const FourMask is_1 = tets.is_node[1], is_2 = tets.is_node[2], is_3 = tets.is_node[3];
  const FourVectors *X = tets.X, p0 = choose(tets.is_node[0], X[1], X[0]);
  const FourVectors p1 = choose(is_1, X[3], choose(is_2, X[1], X[2]));
  const FourVectors p2 = choose(is_1, X[2], choose(is_3, X[1], X[3]));
  const FourVectors p = choose(is_1, X[1], choose(is_2, X[2], choose(is_3, X[3], X[0])));
  HalfSlopes half;
  half.add_edge(p0 - p1, p - p1);
  half.add_edge(p1 - p2, p - p2);
  half.add_edge(p2 - p0, p - p0);
  const FourVectors minus_dV = cross(p1 - p0, p2 - p0);
  const Four &V = tets.V, &S = tets.S;
  const Four c = h * h / 6 * S / (V * V), g = c * c;
  const Four two = Four{} + 2;
  const FourVectors dS = two * half.S;
  const Four by_S = 2 / S, by_S2 = 2 / (S * S), by_V2 = 4 / (V * V), by_V = 4 / V;
  const FourVectors l = by_S * dS + by_V * minus_dV, s = by_S2 * dS, v = by_V2 * minus_dV;
  // Row i of the second derivatives.
  const auto row = [&](const Four& l_i, const FourVectors& ddS, const Four& s_i, const Four& v_i)
      __attribute__((always_inline)) {
    return g * (l_i * l + by_S * (two * ddS) - s_i * dS + v_i * minus_dV);
  };
  const FourVectors rows[3] = {row(l.x, {half.xx, half.yx, half.zx}, s.x, v.x),
                               row(l.y, {half.yx, half.yy, half.zy}, s.y, v.y),
                               row(l.z, {half.zx, half.zy, half.zz}, s.z, v.z)};
  Sums::add(FourColumns(g, g * l.x, g * l.y, g * l.z), n, sums.value);
  for (int i = 0; i < 3; ++i)
    Sums::add(FourColumns(rows[i].x, rows[i].y, rows[i].z, Four{}), n, sums.row[i]);
}

[[gnu::always_inline]] inline void expand(const StarNodes& nodes, double h, TetStar& star,
                                          NodeEnergy& energy) {
  star.n = static_cast<int>(nodes.element.size());
  star.tets.resize((nodes.element.size() + 3) / 4);
  Sums sums(energy);
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    load(nodes, 4 * k, star.tets[k]);
    add_squared_bounds(star.tets[k], std::min(4, star.n - 4 * static_cast<int>(k)), h, sums);
  }
  sums.store(energy);
}

[[gnu::always_inline]] inline double value_at(const TetStar& star, const Vec3& p,
                                              const TrialLimits& limits, double value) {
  constexpr double broken = std::numeric_limits<double>::infinity();
  const FourVectors at{Four{} + p.x(), Four{} + p.y(), Four{} + p.z()};
  int left = star.n;
  for (const FourTets& t : star.tets) {
    const auto X = [&](int c) __attribute__((always_inline)) {
      return choose(t.is_node[c], at, t.X[c]);
    };
    Four V, S;
    set_shape(X(0), X(1), X(2), X(3), V, S);
    const FourMask is_bad = (V > 0 ? V * V < limits.step * limits.step * S : ~FourMask{});
    if ((is_bad[0] | is_bad[1] | is_bad[2] | is_bad[3]) != 0) return broken;
    const Four f = limits.h * limits.h / 6 * S / (V * V), f2 = f * f;
    value += f2[0];
    if (left > 1) value += f2[1];
    if (left > 2) value += f2[2];
    if (left > 3) value += f2[3];
    left -= 4;
    if (!(value < limits.least)) return broken;
  }
  return value;
}

}  // namespace

void expand_star_plain(const StarNodes& nodes, double h, TetStar& star, NodeEnergy& energy) {
  expand(nodes, h, star, energy);
}
[[gnu::target("avx2")]] void expand_star_avx2(const StarNodes& nodes, double h, TetStar& star,
                                              NodeEnergy& energy) {
  expand(nodes, h, star, energy);
}
double try_star_plain(const TetStar& star, const Vec3& p, const TrialLimits& limits, double value) {
  return value_at(star, p, limits, value);
}
[[gnu::target("avx2")]] double try_star_avx2(const TetStar& star, const Vec3& p,
                                             const TrialLimits& limits, double value) {
  return value_at(star, p, limits, value);
}

void expand_star(const StarNodes& nodes, double h, TetStar& star, NodeEnergy& energy) {
  static const auto chosen = has_avx2() ? expand_star_avx2 : expand_star_plain;
  chosen(nodes, h, star, energy);
}
double try_star(const TetStar& star, const Vec3& p, const TrialLimits& limits, double value) {
  static const auto chosen = has_avx2() ? try_star_avx2 : try_star_plain;
  return chosen(star, p, limits, value);
}

}  // namespace trocar
