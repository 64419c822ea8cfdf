// One node's part of the area step against the energy written out element by element.
#include "cutting/cut_plane_star.h"

#include <set>

#include "cutting_plane.h"

namespace trocar {
namespace {

// The patch around the cut of configuration 2, with random flips, so that nodes have 3 to 9
// elements, and nodes moved by at most `share` of h at random.
PlanePatch disturbed_patch(double share) {
  const Mesh mesh = paper_mesh(2);
  const std::vector<Vec2> path = {Vec2(-1 * mm, 35 * mm), Vec2(42 * mm, 18 * mm)};
  PlanePatch patch = make_patch(mesh, path, {none_held(mesh)}, 4);
  std::mt19937 random(7);
  const auto uniform = [&] { return random() / 2147483648.0 - 1; };
  for (int e = 0; e < patch.n_elements(); ++e) {
    const PatchFacet facet{e, static_cast<int>(random() % 3)};
    if (is_flippable(patch, facet) && flipped_area(patch, facet) > 0.5) flip(patch, facet);
  }
  for (int i = 0; i < patch.n_nodes(); ++i)
    if (patch.is_held[i] == 0 && patch.is_boundary[i] == 0)
      patch.x[i] += share * patch.h * Vec2(uniform(), uniform());
  return patch;
}

// Infinite where an element is inverted.
double energy(const PlanePatch& patch, int node) {
  double E = 0;
  visit_star(patch, node, [&](int e, int) {
    const double strain = area(patch, e) / patch.area[e] - 1;
    E = area(patch, e) > 0 ? E + strain * strain + 0.1 / quality(patch, e) : 1e300;
    return E < 1e300;
  });
  return E;
}

double energy_at(PlanePatch& patch, int node, const Vec2& x) {
  const Vec2 before = std::exchange(patch.x[node], x);
  const double E = energy(patch, node);
  patch.x[node] = before;
  return E;
}

template <typename Visit>
void visit_movable(const PlanePatch& patch, Visit visit) {
  for (int i = 0; i < patch.n_nodes(); ++i) {
    if (patch.is_held[i] != 0 || (patch.is_boundary[i] != 0 && patch.side[i].isZero())) continue;
    PlaneStar star;
    find_star(patch, i, star);
    visit(i, star);
  }
}

TEST(CutPlaneStar, disturbed_patch_has_stars_of_every_remainder_by_four) {
  std::set<int> remainders;
  visit_movable(disturbed_patch(0), [&](int, const PlaneStar& star) {
    remainders.insert(star.n % 4);
    EXPECT_LT(star.n, max_star);
  });
  EXPECT_EQ(remainders.size(), 4U);
}

TEST(CutPlaneStar, moves_a_node_downhill_by_the_distance_that_it_returns) {
  for (const double share : {0.05, 0.2, 0.35}) {
    PlanePatch patch = disturbed_patch(share);
    int n_moved = 0;
    visit_movable(disturbed_patch(share), [&](int i, const PlaneStar& star) {
      const Vec2 before = patch.x[i];
      const double E = energy(patch, i);
      const double distance = relax(patch, i, patch.side[i], star);
      EXPECT_NEAR((patch.x[i] - before).norm(), distance, 1e-12 * patch.h);
      if (distance == 0) return;
      EXPECT_LT(energy(patch, i), E);
      ++n_moved;
    });
    EXPECT_GT(n_moved, patch.n_nodes() / 4);
  }
}

// Steps below 1e-3 h are not taken, and the energy is convex: a hundredth of h away it is higher.
TEST(CutPlaneStar, ends_at_the_least_energy) {
  PlanePatch patch = disturbed_patch(0.2);
  visit_movable(disturbed_patch(0.2), [&](int i, const PlaneStar& star) {
    if (energy(patch, i) >= 1e300) return;
    for (int k = 0; k < 50; ++k) relax(patch, i, patch.side[i], star);
    const double E = energy(patch, i);
    const Vec2 x = patch.x[i], along = patch.side[i];
    for (const Vec2& d : {Vec2(1, 0), Vec2(0, 1), Vec2(0.6, 0.8), Vec2(0.8, -0.6)})
      for (const double sign : {-0.01, 0.01}) {
        const Vec2 step = along.isZero() ? d : Vec2(along.dot(d) * along);
        if (step.norm() < 0.5) continue;
        EXPECT_GT(energy_at(patch, i, x + sign * patch.h * step), E);
      }
  });
}

TEST(CutPlaneStar, node_on_a_side_stays_on_it) {
  PlanePatch patch = disturbed_patch(0.2);
  int n_on_sides = 0;
  visit_movable(disturbed_patch(0.2), [&](int i, const PlaneStar& star) {
    if (patch.side[i].isZero()) return;
    relax(patch, i, patch.side[i], star);
    const double off = cross(patch.side[i], patch.x[i] - patch.X[i]);
    EXPECT_NEAR(off, 0, 1e-15);  // one rounding of some 40 mm
    ++n_on_sides;
  });
  EXPECT_GT(n_on_sides, 3);
}

TEST(CutPlaneStar, has_the_same_bits_with_and_without_avx2) {
  if (!has_avx2()) GTEST_SKIP() << "this machine has no AVX2";
  PlanePatch plain = disturbed_patch(0.3), fast = plain;
  for (int sweep = 0; sweep < 3; ++sweep)
    visit_movable(disturbed_patch(0.3), [&](int i, const PlaneStar& star) {
      EXPECT_EQ(relax_plain(plain, i, plain.side[i], star),
                relax_avx2(fast, i, fast.side[i], star));
    });
  for (int i = 0; i < plain.n_nodes(); ++i) EXPECT_EQ(plain.x[i], fast.x[i]);
}

}  // namespace
}  // namespace trocar
