#include "cutting/cut_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "cutting/cut_patch.h"

namespace trocar {
namespace {

constexpr double h = 0.8;

std::vector<Vec3> regular_tetrahedron() {
  return {{0, 0, 0},
          {1, 0, 0},
          {0.5, std::sqrt(3.0) / 2, 0},
          {0.5, std::sqrt(3.0) / 6, std::sqrt(2.0 / 3)}};
}

// Tetrahedra around node 0, which is each corner of some of them.
struct Star {
  std::vector<Vec3> X;
  std::vector<std::array<std::int32_t, 4>> corner;
  std::vector<std::int32_t> element;

  StarNodes nodes(const std::vector<WidePoint>& wide) const { return {wide, corner, element, 0}; }
  std::vector<WidePoint> wide() const { return {X.begin(), X.end()}; }
};

// Regular tetrahedra with nodes moved by up to 0.15 edges at random.
Star random_star(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-0.15, 0.15);
  Star star{{Vec3(shift(random), shift(random), shift(random))}, {}, {}};
  for (int e = 0; e < n; ++e) {
    const int a = e % 4;  // the corner that is the node
    const std::vector<Vec3> X = regular_tetrahedron();
    std::array<std::int32_t, 4> corner{};
    for (int c = 0; c < 4; ++c) {
      if (c == a) continue;
      corner[std::size_t(c)] = std::int32_t(star.X.size());
      star.X.push_back(X[std::size_t(c)] - X[std::size_t(a)] +
                       Vec3(shift(random), shift(random), shift(random)));
    }
    star.corner.push_back(corner);
    star.element.push_back(e);
  }
  return star;
}

// h^2 / 6 times the sum of 1 / altitude^2, of each element.
double squared_bounds(const Star& star) {
  double sum = 0;
  for (const std::int32_t e : star.element) {
    const std::array<std::int32_t, 4>& corner = star.corner[std::size_t(e)];
    double f = 0;
    for (const std::array<int, 3>& facet : tet_facets) {
      const Vec3& o = star.X[std::size_t(corner[std::size_t(facet[0])])];
      const Vec3 n = (star.X[std::size_t(corner[std::size_t(facet[1])])] - o)
                         .cross(star.X[std::size_t(corner[std::size_t(facet[2])])] - o);
      const double altitude = six_volumes(star.X, corner) / n.norm();
      f += h * h / 6 / (altitude * altitude);
    }
    sum += f * f;
  }
  return sum;
}

NodeEnergy expanded(const Star& star, TetStar& tets) {
  NodeEnergy energy;
  expand_star(star.nodes(star.wide()), h, tets, energy);
  return energy;
}
NodeEnergy expanded(const Star& star) {
  TetStar tets;
  return expanded(star, tets);
}

constexpr double no_limit = std::numeric_limits<double>::infinity();

TEST(SquaredBounds, of_the_regular_tetrahedron_are_one) {
  const Star star{regular_tetrahedron(), {{0, 1, 2, 3}}, {0}};
  EXPECT_NEAR(expanded(star).value, std::pow(h, 4), 1e-14);  // rounding
}

TEST(SquaredBounds, are_those_of_the_altitudes) {
  for (int n = 1; n <= 9; ++n) {
    const Star star = random_star(n, 1);
    const double expected = squared_bounds(star);
    EXPECT_NEAR(expanded(star).value, expected, 1e-13 * expected);  // rounding
  }
}

TEST(SquaredBounds, of_several_tetrahedra_are_the_sum_of_those_of_each) {
  for (int n = 1; n <= 9; ++n) {
    const Star star = random_star(n, 2);
    const NodeEnergy together = expanded(star);
    NodeEnergy one_by_one;
    TetStar tets;
    for (int e = 0; e < n; ++e) {
      Star one = star;
      one.element = {e};
      expand_star(one.nodes(one.wide()), h, tets, one_by_one);
    }
    const double size = one_by_one.hessian.norm();  // the largest; rounding
    EXPECT_NEAR(together.value, one_by_one.value, 1e-13 * one_by_one.value);
    EXPECT_LT((together.gradient - one_by_one.gradient).norm(), 1e-13 * size);
    EXPECT_LT((together.hessian - one_by_one.hessian).norm(), 1e-13 * size);
  }
}

TEST(SquaredBounds, are_the_same_bits_with_avx2_and_without) {
  if (!has_avx2()) GTEST_SKIP() << "this machine has no AVX2";
  for (int n = 1; n <= 9; ++n) {
    const Star star = random_star(n, 3);
    const std::vector<WidePoint> wide = star.wide();
    NodeEnergy plain, fast;
    TetStar tets;
    expand_star_plain(star.nodes(wide), h, tets, plain);
    expand_star_avx2(star.nodes(wide), h, tets, fast);
    EXPECT_EQ(plain.value, fast.value);
    EXPECT_EQ(plain.gradient, fast.gradient);
    EXPECT_EQ(plain.hessian, fast.hessian);
    const Vec3 s(0.01, 0.02, -0.03);
    const TrialLimits limits{h, 0, no_limit};
    EXPECT_EQ(try_star_plain(tets, s, limits, 0.1), try_star_avx2(tets, s, limits, 0.1));
  }
}

TEST(SquaredBounds, have_the_gradient_and_hessian_of_finite_differences) {
  constexpr double d = 1e-5;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Star star = random_star(4, seed);
    const NodeEnergy energy = expanded(star);
    for (int k = 0; k < 3; ++k) {
      Star plus = star, minus = star;
      plus.X[0][k] += d;
      minus.X[0][k] -= d;
      const NodeEnergy high = expanded(plus), low = expanded(minus);
      const double slope = (high.value - low.value) / (2 * d);
      const Vec3 curvature = (high.gradient - low.gradient) / (2 * d);
      // Central differences err by d^2 times the third derivative, of the order of 1e3 here.
      EXPECT_NEAR(energy.gradient[k], slope, 1e-6 * (1 + std::abs(slope)));
      EXPECT_LT((energy.hessian.col(k) - curvature).norm(), 1e-6 * (1 + curvature.norm()));
    }
  }
}

TEST(TriedStar, has_the_squared_bounds_that_it_has_where_it_is_tried) {
  for (int n = 1; n <= 9; ++n) {
    Star star = random_star(n, 4);
    TetStar tets;
    expanded(star, tets);
    const Vec3 s(0.02, -0.03, 0.01);
    star.X[0] += s;
    const double expected = squared_bounds(star);
    EXPECT_NEAR(try_star(tets, s, {h, 0, no_limit}, 0), expected, 1e-13 * expected);
    EXPECT_NEAR(try_star(tets, s, {h, 0, no_limit}, 7), 7 + expected, 1e-13 * (7 + expected));
  }
}

// The one that breaks a limit is each of the four in turn.
TEST(TriedStar, is_infinite_where_an_element_has_no_volume_or_too_small_a_step_bound) {
  for (int e = 0; e < 6; ++e) {
    Star star = random_star(6, 5);
    TetStar tets;
    expanded(star, tets);
    const Vec3 s = Vec3::Zero();
    const double value = try_star(tets, s, {h, 0, no_limit}, 0);
    EXPECT_TRUE(std::isinf(try_star(tets, s, {h, 0, 0.999 * value}, 0)));
    double least = no_limit;
    for (const auto& corner : star.corner) least = std::min(least, step_bound(star.X, corner));
    EXPECT_EQ(try_star(tets, s, {h, 0.999 * least, no_limit}, 0), value);
    EXPECT_TRUE(std::isinf(try_star(tets, s, {h, 1.001 * least, no_limit}, 0)));
    const auto& corner = star.corner[std::size_t(e)];
    std::swap(star.X[std::size_t(corner[(e + 1) % 4])], star.X[std::size_t(corner[(e + 2) % 4])]);
    expanded(star, tets);
    EXPECT_TRUE(std::isinf(try_star(tets, s, {h, 0, no_limit}, 0)));
  }
}

}  // namespace
}  // namespace trocar
