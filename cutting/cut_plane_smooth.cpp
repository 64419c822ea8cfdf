#include "cutting/cut_plane_smooth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar {

namespace {

constexpr double asleep_below = 1e-2;  // h: a smaller step does not wake the neighbours
constexpr double not_worth = 1e-3;     // h: a smaller step is not taken
constexpr double shape_weight = 0.1 / 6.928203230275509;  // 1 / quality = S / (4 sqrt(3) A)
constexpr double good_quality = 0.8;                      // elements as good are not flipped
constexpr double least_smooth_area = 1e-3;                // of the area before the cut
constexpr int max_star = 24;  // nodes of more elements stay where they are

// Elements around a node by their opposite edges, valid until the next flip.
struct Star {
  Star() {}   // leaves the arrays as they are: zeroing them took 4 % of a cut
  int n = 0;  // 0: not yet found
  std::array<int, max_star> b, c;
  std::array<double, max_star> per_A0;
};

Star find_star(const PlanePatch& patch, int node) {
  Star star;
  visit_star(patch, node, [&](int e, int a) {
    star.b[star.n] = patch.corner[e][(a + 1) % 3];
    star.c[star.n] = patch.corner[e][(a + 2) % 3];
    star.per_A0[star.n++] = 1 / patch.area[e];
    return star.n < max_star;
  });
  return star;
}

// sum_e (A/A0 - 1)^2 + w S/A with S the sum of squared edges; infinite if an element is inverted.
double energy(const PlanePatch& patch, const Star& star, const Vec2& x) {
  double E = 0;
  for (int k = 0; k < star.n; ++k) {
    const Vec2 b = patch.x[star.b[k]] - x, c = patch.x[star.c[k]] - x;
    const double A = 0.5 * cross(b, c);
    if (A * star.per_A0[k] <= least_smooth_area) return std::numeric_limits<double>::infinity();
    const double S = b.squaredNorm() + c.squaredNorm() + (c - b).squaredNorm();
    const double strain = A * star.per_A0[k] - 1;
    E += strain * strain + shape_weight * S / A;
  }
  return E;
}

struct Expansion {
  double E = 0;
  Vec2 g = Vec2::Zero();
  double Hxx = 0, Hxy = 0, Hyy = 0;
};

// dA/dx = gA is constant, dS/dx = gS, d2S/dx2 = 4 I:
// H = (2 / A0^2 + 2 w S / A^3) gA gA^T + 4 w / A I - w / A^2 (gS gA^T + gA gS^T).
Expansion expand(const PlanePatch& patch, const Star& star, const Vec2& x) {
  Expansion result;
  for (int k = 0; k < star.n; ++k) {
    const Vec2 b = patch.x[star.b[k]] - x, c = patch.x[star.c[k]] - x, bc = c - b;
    const Vec2 gA = 0.5 * Vec2(-bc.y(), bc.x()), gS = -2 * (b + c);
    const double A = 0.5 * cross(b, c), per_A = 1 / A, per_A0 = star.per_A0[k];
    const double S = b.squaredNorm() + c.squaredNorm() + bc.squaredNorm();
    const double strain = A * per_A0 - 1, shape = shape_weight * per_A, mixed = shape * per_A;
    if (A * per_A0 <= least_smooth_area) result.E = std::numeric_limits<double>::infinity();
    result.E += strain * strain + shape * S;
    result.g += (2 * strain * per_A0 - mixed * S) * gA + shape * gS;
    const double outer = 2 * per_A0 * per_A0 + 2 * mixed * S * per_A;
    result.Hxx += outer * gA.x() * gA.x() + 4 * shape - 2 * mixed * gS.x() * gA.x();
    result.Hxy += outer * gA.x() * gA.y() - mixed * (gS.x() * gA.y() + gA.x() * gS.y());
    result.Hyy += outer * gA.y() * gA.y() + 4 * shape - 2 * mixed * gS.y() * gA.y();
  }
  return result;
}

Vec2 newton_step(const Expansion& at, const Vec2& side) {
  if (side.squaredNorm() > 0) {
    const double curvature = at.Hxx * side.x() * side.x() + 2 * at.Hxy * side.x() * side.y() +
                             at.Hyy * side.y() * side.y();
    return -side.dot(at.g) / curvature * side;
  }
  const double per_determinant = 1 / (at.Hxx * at.Hyy - at.Hxy * at.Hxy);
  return per_determinant *
         Vec2(at.Hxy * at.g.y() - at.Hyy * at.g.x(), at.Hxy * at.g.x() - at.Hxx * at.g.y());
}

// Moves one node downhill by a damped Newton step; returns the distance.
double relax(PlanePatch& patch, const Movable& movable, const Star& star) {
  const Vec2 x = patch.x[movable.node], side = movable.side;
  const Expansion at_x = expand(patch, star, x);
  if (!std::isfinite(at_x.E) || star.n == max_star) return 0;
  const Vec2 step = newton_step(at_x, side);
  if (step.norm() < not_worth * patch.h) return 0;
  for (double fraction = 1; fraction > 0.05; fraction *= 0.4) {
    const Vec2 trial = x + fraction * step;
    if (!(energy(patch, star, trial) < at_x.E)) continue;
    patch.x[movable.node] = trial;
    return (trial - x).norm();
  }
  return 0;
}

// Qualities of elements, each computed when it is first asked for.
class Qualities {
 public:
  explicit Qualities(const PlanePatch& patch) : patch_(patch), known_(patch.element.size(), none) {}
  double of(int e) {
    if (known_[e] == none) known_[e] = quality(patch_, e);
    return known_[e];
  }
  void forget(int e) { known_[e] = none; }

 private:
  static constexpr double none = -2;
  const PlanePatch& patch_;
  std::vector<double> known_;
};

// The lesser quality of the two triangles that a flip would make.
double flipped_quality(const PlanePatch& patch, PatchFacet facet, PatchFacet other) {
  const std::array<int, 3>& e = patch.corner[facet.element];
  const Vec2 &w = patch.x[e[facet.facet]], &u = patch.x[e[(facet.facet + 1) % 3]],
             &v = patch.x[e[(facet.facet + 2) % 3]],
             &z = patch.x[patch.corner[other.element][other.facet]];
  return std::min(quality(w, u, z), quality(z, v, w));
}

bool flip_if_better(PlanePatch& patch, PatchFacet facet, Qualities& qualities,
                    const std::vector<std::uint8_t>& is_cut_node) {
  if (!is_flippable(patch, facet)) return false;
  const int g = patch.across[facet.element][facet.facet];
  const double now = std::min(qualities.of(facet.element), qualities.of(g));
  if (now >= good_quality || patch.region[facet.element] != patch.region[g]) return false;
  const PatchFacet other = opposite(patch, facet);
  const int w = patch.corner[facet.element][facet.facet];
  const int z = patch.corner[other.element][other.facet];
  if (is_cut_node[w] != 0 && is_cut_node[z] != 0) return false;
  if (flipped_quality(patch, facet, other) <= 1.02 * std::max(now, 0.0) + 1e-3) return false;
  flip(patch, facet);
  qualities.forget(facet.element);
  qualities.forget(g);
  return true;
}

}  // namespace

std::vector<Movable> movable_nodes(const PlanePatch& patch, std::span<const CutChain> chains,
                                   int rings, bool is_sliding) {
  std::vector<int> ring(patch.node.size(), -1), front;
  for (const CutChain& chain : chains)
    for (const int i : chain.node) {
      ring[i] = 0;
      front.push_back(i);
    }
  std::vector<Movable> result;
  for (std::size_t k = 0; k < front.size() && ring[front[k]] < rings; ++k)
    for (const int j : neighbours(patch, front[k])) {
      if (ring[j] >= 0) continue;
      ring[j] = ring[front[k]] + 1;
      front.push_back(j);
      if (patch.is_held[j] != 0 || patch.is_anchored[j] != 0) continue;
      if (patch.is_boundary[j] == 0 || (is_sliding && patch.side[j].squaredNorm() > 0))
        result.push_back({j, patch.side[j]});
    }
  std::sort(result.begin(), result.end(),
            [](const Movable& a, const Movable& b) { return a.node < b.node; });
  return result;
}

void area_step(PlanePatch& patch, std::span<const Movable> movable, int n_sweeps,
               std::vector<std::uint8_t>& is_awake) {
  std::vector<Star> stars(movable.size());
  for (int sweep = 0; sweep < n_sweeps; ++sweep)
    for (std::size_t slot = 0; slot < movable.size(); ++slot) {
      const Movable& m = movable[slot];
      if (is_awake[m.node] == 0) continue;
      Star& star = stars[slot];
      if (star.n == 0) star = find_star(patch, m.node);
      is_awake[m.node] = 0;
      if (relax(patch, m, star) < asleep_below * patch.h) continue;
      for (int k = 0; k < star.n; ++k) is_awake[star.b[k]] = is_awake[star.c[k]] = 1;
      is_awake[m.node] = 1;
    }
}

int quality_flips(PlanePatch& patch, std::span<const Movable> movable,
                  const std::vector<std::uint8_t>& is_cut_node,
                  std::vector<std::uint8_t>& is_awake) {
  std::vector<std::uint8_t> is_near(patch.element.size(), 0);
  for (const Movable& m : movable)
    visit_star(patch, m.node, [&](int e, int) {
      is_near[e] = 1;
      return true;
    });
  Qualities qualities(patch);
  int n_flips = 0;
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 3 && is_near[e] != 0; ++f) {
      if (!flip_if_better(patch, {e, f}, qualities, is_cut_node)) continue;
      ++n_flips;
      for (const int g : {e, patch.across[e][(f + 1) % 3]})  // the two elements of the flip
        for (const int i : patch.corner[g]) is_awake[i] = 1;
    }
  return n_flips;
}

StarShape star_shape(const PlanePatch& patch, int node, const Vec2& x) {
  StarShape shape{1e300, 1e300};
  visit_star(patch, node, [&](int e, int a) {
    const Vec2 &b = patch.x[patch.corner[e][(a + 1) % 3]],
               &c = patch.x[patch.corner[e][(a + 2) % 3]];
    shape.quality = std::min(shape.quality, quality(x, b, c));
    shape.area = std::min(shape.area, triangle_area(x, b, c) / patch.area[e]);
    return true;
  });
  return shape;
}

}  // namespace trocar
