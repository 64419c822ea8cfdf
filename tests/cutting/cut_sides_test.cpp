#include "cutting/cut_sides.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"

namespace trocar {
namespace {

using CornerSides = std::array<int, 4>;  // of the corners

// Six edges, each with the side of its first corner; 0: not crossed.
using Crossed = std::array<int, 6>;

Crossed crossed_of(int pattern) {
  Crossed crossed;
  for (int& side : crossed) {
    side = pattern % 3 - 1;
    pattern /= 3;
  }
  return crossed;
}

bool is_on_surface(int neutral, int corner) {
  return (neutral >> corner & 1) != 0;
}

// Whether sides agree with all crossings: ends of crossed edges on different sides as crossed, of
// others on the same side. Edges from nodes on the surface say nothing.
bool do_agree(const CornerSides& sides, const Crossed& crossed, int neutral) {
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [a, b] = tet_edges[k];
    if (is_on_surface(neutral, a) || is_on_surface(neutral, b)) continue;
    const bool is_right = crossed[k] == 0 ? sides[std::size_t(a)] == sides[std::size_t(b)]
                                          : sides[std::size_t(a)] == crossed[k] &&
                                                sides[std::size_t(b)] == -crossed[k];
    if (!is_right) return false;
  }
  return true;
}

// All ways to give the corners sides that agree; 0 for those on the surface.
std::vector<CornerSides> all_sides(const Crossed& crossed, int neutral) {
  std::vector<CornerSides> all;
  for (int bits = 0; bits < 16; ++bits) {
    if ((bits & neutral) != 0) continue;  // once
    CornerSides sides;
    for (int a = 0; a < 4; ++a)
      sides[std::size_t(a)] = is_on_surface(neutral, a) ? 0 : (bits >> a & 1) != 0 ? 1 : -1;
    if (do_agree(sides, crossed, neutral)) all.push_back(sides);
  }
  return all;
}

CutStroke stroke_of(const Crossed& crossed, int neutral) {
  CutStroke stroke;
  for (std::int32_t k = 0; k < 6; ++k)
    if (const int side = crossed[std::size_t(k)]; side != 0)
      stroke.hit.push_back({0, k, side > 0, Vec3::Zero(), Vec3::UnitZ()});
  for (std::int32_t a = 0; a < 4; ++a)
    if (is_on_surface(neutral, a)) stroke.surface_node.push_back(a);
  return stroke;
}

// A tetrahedron alone, none of its nodes near enough to the surface to lie on it for that.
CutSurroundings one_tetrahedron() {
  CutSurroundings around;
  around.patch.element = {0};
  around.patch.node = {0, 1, 2, 3};
  around.patch.corner = {{0, 1, 2, 3}};
  around.points.offset.assign(5, 0);
  around.distance.assign(4, 0);
  around.h = 1;
  return around;
}

// All 3^6 ways to cross the edges with all sets of corners on the surface.
TEST(ElementSides, are_those_that_agree_with_all_crossings_if_there_are_any) {
  const CutSurroundings around = one_tetrahedron();
  int n_separated = 0, n_front = 0;
  for (int pattern = 0; pattern < 729; ++pattern)
    for (int neutral = 0; neutral < 16; ++neutral) {
      SCOPED_TRACE(std::to_string(pattern) + " " + std::to_string(neutral));
      const Crossed crossed = crossed_of(pattern);
      const ElementSides sides = element_sides(around, stroke_of(crossed, neutral))[0];
      bool is_crossed = false;
      for (std::size_t k = 0; k < 6; ++k)
        is_crossed = is_crossed || (crossed[k] != 0 && !is_on_surface(neutral, tet_edges[k][0]) &&
                                    !is_on_surface(neutral, tet_edges[k][1]));
      const std::vector<CornerSides> expected = all_sides(crossed, neutral);
      if (!is_crossed) {
        EXPECT_EQ(sides.kind, CutKind::uncut);
        continue;
      }
      EXPECT_EQ(sides.kind, expected.empty() ? CutKind::front : CutKind::separated);
      (expected.empty() ? n_front : n_separated) += 1;
      if (expected.empty()) continue;
      ASSERT_EQ(expected.size(), 1U);
      for (std::size_t a = 0; a < 4; ++a) EXPECT_EQ(sides.corner[a], expected[0][a]) << a;
    }
  // With no corner on the surface any of the 14 ways to part four corners, with one any of 6 for
  // each of the 27 ways to cross its edges, with two 2 for each of 243.
  EXPECT_EQ(n_separated, 14 + 4 * 6 * 27 + 6 * 2 * 243);
  EXPECT_GT(n_front, 0);
}

}  // namespace
}  // namespace trocar
