// Each material against the figures of numerics V4, and in single precision against double.
#include <gtest/gtest.h>

#include <functional>

#include "larger_or_nan.h"
#include "solver/in_double.h"
#include "solver/material_list.h"
#include "solver/material_setup.h"
#include "solver_algebra.h"
#include "solver_material.h"

using namespace trocar;

template <class M, class Pack = double>
static Mat3 stress_of_gradient(const Mat3& H) {
  const BlockOfOne<M, Pack> block;
  Tensor<Pack> T;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) T(i, j) = Pack{} + static_cast<RealOf<Pack>>(H(i, j));
  const Tensor<Pack> P = M::stress(T, block.values());
  Mat3 A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) store_in_double(&A(i, j), P(i, j));
  return A;
}

// Newton for the stretches of the free directions, whose stress vanishes.
template <class M>
static Vec3 free_stretches(Vec3 s, const std::vector<int>& free) {
  const auto n = static_cast<Eigen::Index>(free.size());
  const auto residual = [&](const Vec3& t) {
    const Mat3 P = stress<M>(t.asDiagonal());
    Eigen::VectorXd r(n);
    for (Eigen::Index k = 0; k < n; ++k) r[k] = P(free[k], free[k]);
    return r;
  };
  for (int iteration = 0; iteration < 40; ++iteration) {
    Eigen::MatrixXd J(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      Vec3 above = s, below = s;
      above[free[k]] += 1e-6;
      below[free[k]] -= 1e-6;
      J.col(k) = (residual(above) - residual(below)) / 2e-6;
    }
    const Eigen::VectorXd step = solution(J, residual(s));
    for (Eigen::Index k = 0; k < n; ++k) s[free[k]] -= step[k];
  }
  return s;
}

template <class M>
static void expect_bar(const std::vector<std::pair<double, double>>& rows) {
  for (const auto& [l, P11] : rows) {
    const Vec3 s = free_stretches<M>(Vec3(l, 1 / std::sqrt(l), 1 / std::sqrt(l)), {1, 2});
    // At least nine digits are printed, of two figures above 10 kPa eight.
    const double digits = std::abs(P11) > 1e4 ? 4e-8 : 2e-9;
    EXPECT_NEAR(stress<M>(s.asDiagonal())(0, 0) / P11, 1, digits) << static_cast<int>(M::model);
  }
}

TEST(MaterialGolden, laterally_free_bars_have_the_known_stress) {
  expect_bar<MaterialNeoHookean>(
      {{.6, -2165.899144}, {.8, -758.121946}, {1.2, 501.363401}, {1.5, 1043.554101}});
  expect_bar<MaterialMooneyRivlin>(
      {{.6, -2734.013150}, {.8, -832.879905}, {1.2, 468.406744}, {1.5, 906.605831}});
  expect_bar<MaterialYeoh>(
      {{.6, -3052.529852}, {.8, -804.096269}, {1.2, 523.873281}, {1.5, 1377.391356}});
  expect_bar<MaterialOgden>(
      {{.6, -19413.410}, {.8, -1687.362060}, {1.2, 381.365099}, {1.5, 827.768384}});
  expect_bar<MaterialTransverselyIsotropic>(
      {{.6, -3700.155826}, {.8, -1897.046706}, {1.2, 2481.005195}, {1.5, 7554.791958}});
  expect_bar<MaterialHolzapfelGasserOgden>({{1.2, 1620.690258}, {1.5, 14359.564}});
}

TEST(MaterialGolden, slack_fibres_leave_the_base_material) {
  const Vec3 s = free_stretches<MaterialNeoHookean>(Vec3(.8, 1.1, 1.1), {1, 2});
  // E = .1 (I1bar - 3) - .7 (1 - I4bar) < 0 here.
  EXPECT_EQ(energy<MaterialHolzapfelGasserOgden>(s.asDiagonal()),
            energy<MaterialNeoHookean>(s.asDiagonal()));
}

template <class M>
static void expect_equibiaxial(double P11) {
  const Vec3 s = free_stretches<M>(Vec3(1.2, 1.2, .7), {2});
  EXPECT_NEAR(stress<M>(s.asDiagonal())(0, 0) / P11, 1, 2e-9);  // printed digits
}

TEST(MaterialGolden, equibiaxial_stretch_has_the_known_stress) {
  expect_equibiaxial<MaterialNeoHookean>(781.383324);
  expect_equibiaxial<MaterialMooneyRivlin>(911.367089);
  expect_equibiaxial<MaterialYeoh>(913.323172);
  expect_equibiaxial<MaterialOgden>(2970.303315);
}

template <class M>
static double shear_stress() {
  Mat3 F = Mat3::Identity();
  F(0, 1) = .5;
  return (stress<M>(F) * F.transpose())(0, 1);  // J = 1
}

TEST(MaterialGolden, simple_shear_has_the_known_stress) {
  const double g = .5, x = g * g;  // I1bar - 3 = I2bar - 3 = g^2
  EXPECT_NEAR(shear_stress<MaterialNeoHookean>(), mu * g, 1e-9);
  EXPECT_NEAR(shear_stress<MaterialMooneyRivlin>(), mu * g, 1e-9);
  EXPECT_NEAR(shear_stress<MaterialYeoh>(), 2 * g * (500 + 200 * x + 150 * x * x),
              1e-9);  // 559.375
  EXPECT_NEAR(shear_stress<MaterialOgden>(), 861.328125, 1e-8);
  EXPECT_NEAR(shear_stress<MaterialHolzapfelGasserOgden>(), 1808.460232, 2e-6);
}

TEST(MaterialGolden, a_general_deformation_has_the_known_energy) {
  Mat3 F;
  F << 1.1, .3, -.1, .05, .9, .2, .15, -.1, 1.05;
  EXPECT_NEAR(energy<MaterialNeoHookean>(F), 193.06356744, 6e-9);  // printed digits
  EXPECT_NEAR(energy<MaterialMooneyRivlin>(F), 195.64006413, 6e-9);
  EXPECT_NEAR(energy<MaterialYeoh>(F), 195.63587195, 6e-9);
  EXPECT_NEAR(energy<MaterialOgden>(F), 229.28344568, 6e-9);
  EXPECT_NEAR(energy<MaterialTransverselyIsotropic>(F), 225.98851811, 6e-9);
  EXPECT_NEAR(energy<MaterialHolzapfelGasserOgden>(F), 303.77847941, 6e-9);
}

TEST(MaterialGolden, two_ogden_terms_of_2_and_minus_2_are_mooney_rivlin) {
  Material material = material_of(MaterialModel::ogden, mu, K);
  // 2 mu_p / alpha_p^2 = mu_p / 2 = c10 and c01
  material.ogden = {OgdenTerm{600, 2}, OgdenTerm{400, -2}, OgdenTerm{}};
  std::array<double, std::size_t{max_material_values} * block_lanes<double>> number{};
  std::array<double, max_material_values> value{};
  fill_material(material, 1, Vec3(1, 0, 0), value);
  for (std::size_t k = 0; k < value.size(); ++k) number[k * block_lanes<double>] = value[k];
  Tensor<double> H{{{.2, .1, 0}, {-.3, .1, .2}, {.1, 0, -.2}}};
  Mat3 F = Mat3::Identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) F(i, j) += H(i, j);
  const Tensor<double> P = MaterialOgden::stress(H, BlockValues<double>{number.data()});
  const Mat3 expected = stress<MaterialMooneyRivlin>(F);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(P(i, j), expected(i, j), 1e-12 * K);
}

TEST(MaterialGolden, beyond_the_clipped_exponent_stress_goes_on_continuously) {
  // E passes sqrt(16 / 5) on the way.
  double before = 0;
  for (double l = 1.3; l < 3; l += 1e-4) {
    const double b = 1 / std::sqrt(l);
    const double P = stress<MaterialHolzapfelGasserOgden>(Vec3(l, b, b).asDiagonal())(0, 0);
    EXPECT_TRUE(std::isfinite(P));
    if (before > 0) {
      EXPECT_LT(std::abs(P / before - 1), .02) << l;  // slope d log P / dl <= 200
    }
    before = P;
  }
}

// Relative error of the stress in single precision, H being a float exactly.
template <class M>
static double single_error(double strain, std::uint64_t seed) {
  Noise noise(seed);
  double worst = 0;
  for (int k = 0; k < 200; ++k) {
    Mat3 H;
    for (int i = 0; i < 9; ++i) H.data()[i] = static_cast<float>(strain * noise());
    const Mat3 exact = stress_of_gradient<M>(H);
    const Mat3 rounded = stress_of_gradient<M, PackOf<float, 1>>(H);
    worst = larger_or_nan(worst, (rounded - exact).norm() / exact.norm());
  }
  return worst;
}

template <class... Ms>
static void expect_single(TypeList<Ms...>) {
  for (const double strain : {1e-4, 1e-3, 1e-2, .1, .3}) {
    std::printf("single precision, strain %g:", strain);
    const auto check = [&](double error) {
      std::printf(" %.1e", error);
      EXPECT_LT(error, 1e-5);  // numerics V4
    };
    (check(single_error<Ms>(strain, 3)), ...);
    std::printf("\n");
  }
}

TEST(MaterialGolden, single_precision_keeps_five_digits_of_the_stress_at_any_strain) {
  expect_single(MaterialList{});
}
