#include "cutting/cut_plane_star.h"

#include <limits>

namespace trocar {

namespace {

constexpr double shape_weight = 0.1 / 6.928203230275509;  // 1 / quality = S / (4 sqrt(3) A)
constexpr double least_smooth_area = 1e-3;                // of the area before the cut

using Pair = Eigen::Array2d;  // a number of each of two elements
using Row = std::array<double, max_star + 2>;

// From the node to both ends of the opposite edges. One element more than there are, so that all
// come in pairs: the first one again.
struct Spokes {
  Spokes(const PlanePatch& patch, const PlaneStar& star, const Vec2& x);
  Row bx, by, own_cx, own_cy;
  const double *cx, *cy;

  static Pair pair(const double* row, int k) { return Eigen::Map<const Pair>(row + k); }
};

Spokes::Spokes(const PlanePatch& patch, const PlaneStar& star, const Vec2& x) {
  const auto n = static_cast<std::size_t>(star.n);
  const auto fill = [&](const std::array<int, max_star>& node, Row& to_x, Row& to_y) {
    for (std::size_t k = 0; k < n; ++k) {
      const Vec2 d = patch.x[node[k]] - x;
      to_x[k] = d.x();
      to_y[k] = d.y();
    }
    to_x[n] = to_x[0];
    to_y[n] = to_y[0];
  };
  fill(star.b, bx, by);
  if (star.is_ring) {
    bx[n + 1] = bx[1];
    by[n + 1] = by[1];
    cx = bx.data() + 1;
    cy = by.data() + 1;
    return;
  }
  fill(star.c, own_cx, own_cy);
  cx = own_cx.data();
  cy = own_cy.data();
}

// Two elements.
struct Shapes {
  Shapes(const Spokes& spokes, const PlaneStar& star, int k)
      : bx(Spokes::pair(spokes.bx.data(), k)),
        by(Spokes::pair(spokes.by.data(), k)),
        cx(Spokes::pair(spokes.cx, k)),
        cy(Spokes::pair(spokes.cy, k)),
        dx(cx - bx),
        dy(cy - by),
        A(0.5 * (bx * cy - by * cx)),
        S((bx * bx + by * by) + (cx * cx + cy * cy) + (dx * dx + dy * dy)),
        per_A0(Spokes::pair(star.per_A0.data(), k)),
        strain(A * per_A0 - 1) {}
  Pair bx, by, cx, cy, dx, dy, A, S, per_A0, strain;
};

struct Sums {
  Pair gradient = Pair::Zero(), Hxx_Hxy = Pair::Zero(), Hyy_E = Pair::Zero();
};

// dA/dx = gA is constant, dS/dx = gS, d2S/dx2 = 4 I:
// H = (2 / A0^2 + 2 w S / A^3) gA gA^T + 4 w / A I - w / A^2 (gS gA^T + gA gS^T).
struct Terms {
  explicit Terms(const Shapes& e) {
    const Pair gAx = 0.5 * -e.dy, gAy = 0.5 * e.dx;
    const Pair gSx = -2 * (e.bx + e.cx), gSy = -2 * (e.by + e.cy);
    const Pair per_A = 1 / e.A, shape = shape_weight * per_A, mixed = shape * per_A;
    const Pair along_A = 2 * e.strain * e.per_A0 - mixed * e.S;
    const Pair outer = 2 * e.per_A0 * e.per_A0 + 2 * mixed * e.S * per_A;
    E = e.strain * e.strain + shape * e.S;
    gx = along_A * gAx + shape * gSx;
    gy = along_A * gAy + shape * gSy;
    Hxx = outer * gAx * gAx + 4 * shape - 2 * mixed * gSx * gAx;
    Hxy = outer * gAx * gAy - mixed * (gSx * gAy + gAx * gSy);
    Hyy = outer * gAy * gAy + 4 * shape - 2 * mixed * gSy * gAy;
  }
  Pair E, gx, gy, Hxx, Hxy, Hyy;

  template <int k>
  void add_to(Sums& sums) const {
    sums.gradient += Pair(gx[k], gy[k]);
    sums.Hxx_Hxy += Pair(Hxx[k], Hxy[k]);
    sums.Hyy_E += Pair(Hyy[k], E[k]);
  }
};

}  // namespace

void find_star(const PlanePatch& patch, int node, PlaneStar& star) {
  star.n = 0;
  visit_star(patch, node, [&](int e, int a) {
    star.b[star.n] = patch.corner[e][(a + 1) % 3];
    star.c[star.n] = patch.corner[e][(a + 2) % 3];
    star.per_A0[star.n++] = 1 / patch.area[e];
    return star.n < max_star;
  });
  star.per_A0[star.n] = star.per_A0[0];
  star.is_ring = patch.is_boundary[node] == 0 && star.n < max_star && star.n > 1;
  for (int k = 0; k < star.n && star.is_ring; ++k)
    star.is_ring = star.c[k] == star.b[k + 1 < star.n ? k + 1 : 0];
}

double star_energy(const PlanePatch& patch, const PlaneStar& star, const Vec2& x) {
  const Spokes spokes(patch, star, x);
  double E = 0;
  for (int k = 0; k < star.n; k += 2) {
    const Shapes e(spokes, star, k);
    if ((e.A * e.per_A0).minCoeff() <= least_smooth_area)
      return std::numeric_limits<double>::infinity();
    const Pair term = e.strain * e.strain + shape_weight * e.S / e.A;
    E += term[0];
    if (k + 1 < star.n) E += term[1];
  }
  return E;
}

StarExpansion expand_energy(const PlanePatch& patch, const PlaneStar& star, const Vec2& x) {
  const Spokes spokes(patch, star, x);
  Sums sums;
  Pair least = Pair::Ones();
  for (int k = 0; k < star.n; k += 2) {
    const Shapes e(spokes, star, k);
    const Terms terms(e);
    least = least.min(e.A * e.per_A0);
    terms.add_to<0>(sums);
    if (k + 1 < star.n) terms.add_to<1>(sums);
  }
  const bool is_valid = least.minCoeff() > least_smooth_area;
  return {is_valid ? sums.Hyy_E[1] : std::numeric_limits<double>::infinity(),
          sums.gradient.matrix(), sums.Hxx_Hxy[0], sums.Hxx_Hxy[1], sums.Hyy_E[0]};
}

}  // namespace trocar
