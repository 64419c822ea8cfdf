#include "cutting/cut_plane_star.h"

#include <limits>

namespace trocar {

namespace {

constexpr double shape_weight = 0.1 / 6.928203230275509;  // 1 / quality = S / (4 sqrt(3) A)
constexpr double least_smooth_area = 1e-3;                // of the area before the cut
constexpr double not_worth = 1e-3;                        // h: a smaller step is not taken
constexpr double no_energy = std::numeric_limits<double>::infinity();

// Half of each edge opposite the node, e, and its middle.
struct Edges {
  [[gnu::always_inline]] Edges(const PlanePatch& patch, const PlaneStar& star) {
    for (int k = 0; k < star.n; k += 4) {
      const auto b = [&](int a) { return patch.x[star.b[k + a]]; };
      const auto c = [&](int a) { return patch.x[star.c[k + a]]; };
      const FourPoints from(b(0), b(1), b(2), b(3)), to(c(0), c(1), c(2), c(3));
      mx[k / 4] = 0.5 * (from.x + to.x);
      my[k / 4] = 0.5 * (from.y + to.y);
      ex[k / 4] = to.x - mx[k / 4];
      ey[k / 4] = to.y - my[k / 4];
    }
  }
  Four ex[max_star / 4], ey[max_star / 4], mx[max_star / 4], my[max_star / 4];
};

// Four elements; m goes from the node to the middle: A = m x e, S = 4 T with T = (m^2 + 3 e^2) / 2.
struct Shapes {
  [[gnu::always_inline]] Shapes(const PlaneStar& star, const Edges& edges, const Vec2& x, int k)
      : ex(edges.ex[k / 4]),
        ey(edges.ey[k / 4]),
        mx(edges.mx[k / 4] - x.x()),
        my(edges.my[k / 4] - x.y()),
        A(mx * ey - my * ex),
        T(0.5 * (mx * mx + my * my) + 1.5 * (ex * ex + ey * ey)),
        per_A(1 / A),
        per_A0(star.per_A0[k / 4]),
        strain(A * per_A0 - 1),
        v(star.weight[k / 4]) {}
  Four ex, ey, mx, my, A, T, per_A, per_A0, strain, v;
};

[[gnu::always_inline]] inline void take_lesser(const Four& a, Four& least) {
  least = a < least ? a : least;
}

// Halves of the derivatives: dA = (-ey, ex) is constant, dT = -m, d2T = I:
// g = (strain / A0 - v T / A) dA + v dT, v = 2 w / A
// H = (1 / A0^2 + 2 v T / A^2) dA dA^T + v I - v / A (dT dA^T + dA dT^T).
struct Expansion {
  [[gnu::always_inline]] Expansion(const PlaneStar& star, const Edges& edges, const Vec2& x) {
    for (int k = 0; k < star.n; k += 4) {
      const Shapes e(star, edges, x, k);
      add(e);
      area[k / 4] = e.A;
      take_lesser(e.A - star.least_area[k / 4], room);
    }
  }
  [[gnu::always_inline]] void add(const Shapes& e) {
    const Four square = e.per_A * e.per_A, per_A2 = e.v * square, tension = e.v * e.T * square;
    const Four along_A = e.strain * e.per_A0 - tension;
    const Four outer = e.per_A0 * e.per_A0 + 2 * (tension * e.per_A);
    const Four kx = per_A2 * e.mx, ky = per_A2 * e.my, outer_y = outer * e.ey;
    const Four weight = e.v * e.per_A;
    gx -= along_A * e.ey + weight * e.mx;
    gy += along_A * e.ex - weight * e.my;
    round += weight;
    Hxx += (outer_y - 2 * kx) * e.ey;
    Hxy += (kx - outer_y) * e.ex - ky * e.ey;
    Hyy += (outer * e.ex + 2 * ky) * e.ex;
  }
  Four gx{}, gy{}, round{}, Hxx{}, Hxy{}, Hyy{}, room = Four{} + 1;
  Four area[max_star / 4];
};

// sum_e (A / A0 - 1)^2 + w S / A up to a constant; infinite if an element is invalid.
[[gnu::always_inline]] inline double star_energy(const PlaneStar& star, const Edges& edges,
                                                 const Vec2& x) {
  Four E{}, room = Four{} + 1;
  for (int k = 0; k < star.n; k += 4) {
    const Shapes e(star, edges, x, k);
    E += e.strain * e.strain + 2 * (e.v * e.per_A * e.T);
    take_lesser(e.A - star.least_area[k / 4], room);
  }
  return is_positive(room) ? sum(E) : no_energy;
}

[[gnu::always_inline]] inline Vec2 newton_step(const Expansion& at_x, const Vec2& side) {
  const double round = sum(at_x.round), gx = sum(at_x.gx), gy = sum(at_x.gy);
  const double Hxx = sum(at_x.Hxx) + round, Hxy = sum(at_x.Hxy), Hyy = sum(at_x.Hyy) + round;
  if (side.squaredNorm() > 0) {
    const double curvature =
        Hxx * side.x() * side.x() + 2 * Hxy * side.x() * side.y() + Hyy * side.y() * side.y();
    return -(side.x() * gx + side.y() * gy) / curvature * side;
  }
  const double per_determinant = 1 / (Hxx * Hyy - Hxy * Hxy);
  return per_determinant * Vec2(Hxy * gy - Hyy * gx, Hxy * gx - Hxx * gy);
}

// A full Newton step lowers the energy if no element loses a fifth of its area: along the step T =
// (affine function) A + constant, so that the second derivative of T / A grows as A^-3, and 0.8^3 >
// 1/2.
[[gnu::always_inline]] inline bool is_sure(const PlaneStar& star, const Edges& edges,
                                           const Expansion& at_x, const Vec2& step) {
  Four room = Four{} + 1;
  for (int k = 0; k < star.n; k += 4) {
    const Four& A = at_x.area[k / 4];
    const Four growth = edges.ex[k / 4] * step.y() - edges.ey[k / 4] * step.x();
    take_lesser(growth + 0.2 * A, room);
    take_lesser(growth + (A - star.least_area[k / 4]), room);
  }
  return is_positive(room);
}

// Of the step; 0 if there is none.
[[gnu::always_inline]] inline double lowering_fraction(const PlaneStar& star, const Edges& edges,
                                                       const Vec2& x, const Vec2& step) {
  const double E = star_energy(star, edges, x);
  for (double fraction = 1; fraction > 0.05; fraction *= 0.4)
    if (star_energy(star, edges, x + fraction * step) < E) return fraction;
  return 0;
}

[[gnu::always_inline]] inline double relax_node(PlanePatch& patch, int node, const Vec2& side,
                                                const PlaneStar& star) {
  if (star.n == max_star) return 0;
  const Vec2 x = patch.x[node];
  const Edges edges(patch, star);
  const Expansion at_x(star, edges, x);
  if (!is_positive(at_x.room)) return 0;
  const Vec2 step = newton_step(at_x, side);
  if (step.norm() < not_worth * patch.h) return 0;
  const double fraction =
      is_sure(star, edges, at_x, step) ? 1 : lowering_fraction(star, edges, x, step);
  patch.x[node] = x + fraction * step;
  return fraction * step.norm();
}

}  // namespace

double relax_plain(PlanePatch& patch, int node, const Vec2& side, const PlaneStar& star) {
  return relax_node(patch, node, side, star);
}
[[gnu::target("avx2")]] double relax_avx2(PlanePatch& patch, int node, const Vec2& side,
                                          const PlaneStar& star) {
  return relax_node(patch, node, side, star);
}

void find_star(const PlanePatch& patch, int node, PlaneStar& star) {
  int n = 0;
  const auto add = [&](int e, int a, double weight) {
    star.b[n] = patch.corner[e][(a + 1) % 3];
    star.c[n] = patch.corner[e][(a + 2) % 3];
    star.per_A0[n / 4][n % 4] = weight / patch.area[e];
    star.weight[n / 4][n % 4] = weight * 2 * shape_weight;
    star.least_area[n / 4][n % 4] = least_smooth_area * patch.area[e];
    ++n;
  };
  visit_star(patch, node, [&](int e, int a) {
    add(e, a, 1);
    return n < max_star;
  });
  star.n = n;
  const int first = patch.star[node];
  while (n % 4 != 0) add(first, corner_of(patch, first, node), 0);
}

double relax(PlanePatch& patch, int node, const Vec2& side, const PlaneStar& star) {
  static const auto chosen = has_avx2() ? relax_avx2 : relax_plain;
  return chosen(patch, node, side, star);
}

}  // namespace trocar
