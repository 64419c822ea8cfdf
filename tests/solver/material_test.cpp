// Materials on their own: stress against energy, closed forms, small strain.
#include <gtest/gtest.h>

#include "larger_or_nan.h"
#include "solver_algebra.h"
#include "solver_material.h"

using namespace trocar;

static Mat3 random_gradient(Noise& noise, double amount) {
  Mat3 F = Mat3::Identity();
  for (int i = 0; i < 9; ++i) F.data()[i] += amount * noise();
  return F;
}

TEST(Material, stress_is_the_derivative_of_the_energy) {
  for_each_material(MaterialList{}, []<class M>() {
    Noise noise(7);
    for (int k = 0; k < 50; ++k) {
      const Mat3 F = random_gradient(noise, 0.25);
      const Mat3 P = stress<M>(F);
      const double h = 1e-5;  // error h^2 d3W ~ 1e-10 K and eps W / h ~ 1e-11 W
      for (int i = 0; i < 9; ++i) {
        Mat3 above = F, below = F;
        above.data()[i] += h;
        below.data()[i] -= h;
        EXPECT_NEAR(P.data()[i], (energy<M>(above) - energy<M>(below)) / (2 * h), 3e-8 * K);
      }
    }
  });
}

TEST(Material, agrees_with_linear_elasticity_at_small_strain) {
  for_each_material(MaterialList{}, []<class M>() {
    Noise noise(8);
    const Mat3 F = random_gradient(noise, 1e-7);
    if (has_fibres(M::model)) return;  // fibre.h adds to it
    const Mat3 expected = stress<MaterialLinear>(F);
    // Second-order terms: strain 1e-7 times moduli of order K.
    EXPECT_LT((stress<M>(F) - expected).norm(), 1e-5 * expected.norm());
  });
}

TEST(Material, stress_and_energy_vanish_without_deformation) {
  for_each_material(MaterialList{}, []<class M>() {
    // Fibres make up to 10 mu out of the error of q, 4e-26 (isochoric_test.cpp).
    EXPECT_LT(stress<M>(Mat3::Identity()).norm(), 4e-25 * mu);
    EXPECT_NEAR(energy<M>(Mat3::Identity()), 0, 4e-26 * 1.5 * mu);  // of q, isochoric_test.cpp
  });
}

TEST(Material, a_rotation_turns_the_stress_with_it_except_for_the_linear_one) {
  const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, 2, 2) / 3).toRotationMatrix();
  Noise noise(9);
  const Mat3 F = random_gradient(noise, 0.2);
  const double tolerance = 1e-13 * K * 100;  // some hundred roundings of moduli
  for_each_material(MaterialList{}, [&]<class M>() {
    const double change = (stress<M>(R * F) - R * stress<M>(F)).norm();
    if (M::model == MaterialModel::linear)
      EXPECT_GT(change, 0.1 * K);
    else
      EXPECT_LT(change, tolerance);
  });
}

// The lateral stretch b of a laterally free bar solves P22(l, b) = 0.
static double lateral_stretch(double l) {
  double b = 1 / std::sqrt(l);
  for (int k = 0; k < 50; ++k) {
    const double h = 1e-6;
    const auto P22 = [&](double s) {
      return stress<MaterialNeoHookean>(Vec3(l, s, s).asDiagonal())(1, 1);
    };
    b -= P22(b) * 2 * h / (P22(b + h) - P22(b - h));
  }
  return b;
}

TEST(NeoHookean, has_the_known_stress_of_a_laterally_free_bar) {
  // numerics V4: P11 [Pa] and the lateral stretch, where given.
  struct Row {
    double l, P11, b;
  };
  for (const Row& row : {Row{.6, -2165.899144, 1.28522374}, Row{.8, -758.121946, 1.11571558},
                         Row{1.2, 501.363401, .91472954}, Row{1.5, 1043.554101, .82078721}}) {
    const double b = lateral_stretch(row.l);
    EXPECT_NEAR(b, row.b, 6e-9);  // printed digits
    EXPECT_NEAR(stress<MaterialNeoHookean>(Vec3(row.l, b, b).asDiagonal())(0, 0), row.P11, 1e-6);
  }
}

TEST(NeoHookean, has_the_known_stress_of_simple_shear) {
  Mat3 F = Mat3::Identity();
  F(0, 1) = 0.5;
  const Mat3 cauchy = stress<MaterialNeoHookean>(F) * F.transpose();  // J = 1
  const double g = 0.5;  // mu dev(F F^T): mu g, 2/3 mu g^2, -1/3 mu g^2
  EXPECT_NEAR(cauchy(0, 1), mu * g, 1e-10);
  EXPECT_NEAR(cauchy(0, 0), 2.0 / 3 * mu * g * g, 1e-10);
  EXPECT_NEAR(cauchy(1, 1), -1.0 / 3 * mu * g * g, 1e-10);
  EXPECT_NEAR(cauchy(2, 2), -1.0 / 3 * mu * g * g, 1e-10);
}

TEST(NeoHookean, has_the_known_energy_of_a_general_deformation) {
  Mat3 F;
  F << 1.1, .3, -.1, .05, .9, .2, .15, -.1, 1.05;
  EXPECT_NEAR(energy<MaterialNeoHookean>(F), 193.06356744, 6e-9);  // numerics V4, printed digits
  const double J = F.determinant(), I1 = (F.transpose() * F).trace();
  const double W = mu / 2 * (std::pow(J, -2.0 / 3) * I1 - 3) + K / 2 * (J - 1) * (J - 1);
  EXPECT_NEAR(energy<MaterialNeoHookean>(F), W, 1e-11 * K);
}

TEST(NeoHookean, keeps_its_digits_at_tiny_strain) {
  Mat3 H = Mat3::Zero();
  H(0, 1) = H(1, 0) = 1e-10;
  const Mat3 P =
      matrix(MaterialNeoHookean::stress(tensor(H), BlockOfOne<MaterialNeoHookean>().values()));
  EXPECT_NEAR(P(0, 1) / (2 * mu * 1e-10), 1, 1e-14);  // F - I of a stored F would have 6 digits
}

TEST(StVenantKirchhoff, has_the_closed_form_of_uniaxial_strain) {
  for (const double l : {0.7, 1.3}) {
    const Mat3 P = stress<MaterialStVenantKirchhoff>(Vec3(l, 1, 1).asDiagonal());
    EXPECT_NEAR(P(0, 0), l * (lambda + 2 * mu) * (l * l - 1) / 2, 1e-10 * K);
    EXPECT_NEAR(P(1, 1), lambda * (l * l - 1) / 2, 1e-10 * K);
  }
}

TEST(Material, stress_has_an_isochoric_part_and_a_pressure_that_depends_on_the_volume_alone) {
  for_each_material(MaterialList{}, []<class M>() {
    if constexpr (M::is_decoupled) {
      Noise noise(11);
      for (int k = 0; k < 20; ++k) {
        const Mat3 F = random_gradient(noise, 0.25);
        const Mat3 P =
            matrix(M::isochoric_stress(tensor(F - Mat3::Identity()), BlockOfOne<M>().values()));
        const double J = F.determinant();
        const Mat3 volumetric = K * (J - 1) * J * F.inverse().transpose();
        EXPECT_LT((stress<M>(F) - P - volumetric).norm(), 1e-12 * K);  // some roundings
        // No power along F: a change of volume alone does not change the isochoric energy.
        EXPECT_NEAR((P.transpose() * F).trace(), 0, 1e-12 * K);
        const double W =
            M::isochoric_energy(tensor(F - Mat3::Identity()), BlockOfOne<M>().values());
        EXPECT_NEAR(energy<M>(F), W + K / 2 * (J - 1) * (J - 1), 1e-12 * K);
      }
    }
  });
}

// Largest eigenvalue of d2W/dF2 over the symmetric bound at rest, by differences of the stress.
template <class M>
static double largest_tangent(const Mat3& F, const Mat3& G_root) {
  // omega^2 ~ max over dF = d G_root of d2W; columns of dF weighted by the element's gradients.
  Eigen::MatrixXd A(9, 9);
  const double h = 1e-6;
  for (int i = 0; i < 9; ++i) {
    Mat3 d = Mat3::Zero();
    d.data()[i] = h;
    const Mat3 dP = (stress<M>(F + d * G_root) - stress<M>(F - d * G_root)) / (2 * h);
    const Mat3 back = dP * G_root.transpose();
    A.col(i) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(back.data());
  }
  return eigenvalues(0.5 * (A + A.transpose())).maxCoeff();
}

TEST(Material, stiffening_bounds_the_tangent_of_any_deformation) {
  for_each_material(MaterialList{}, []<class M>() {
    Noise noise(10);
    double sharpest = 0, sum = 0;
    int n = 0;
    for (int k = 0; k < 3000; ++k) {
      const Mat3 F = random_gradient(noise, k % 3 == 0 ? 0.7 : 0.3);
      const Mat3 root = random_gradient(noise, 0.8);
      const Mat3 G = root * root.transpose();
      const double at_rest = lambda * G.trace() + 2 * mu * eigenvalues(G)[2];
      const double bound =
          at_rest * M::stiffening(tensor(F - Mat3::Identity()), BlockOfOne<M>().values());
      const double tangent = largest_tangent<M>(F, root);
      EXPECT_LT(tangent, bound * (1 + 1e-6)) << F;  // differences of the stress: 1e-6
      sharpest = larger_or_nan(sharpest, tangent / bound);
      sum += tangent / bound;
      ++n;
    }
    std::printf("material %d: true / bound at most %.3f, mean %.3f\n", static_cast<int>(M::model),
                sharpest, sum / n);
    EXPECT_GT(sharpest, 0.5);  // a bound that is far off would be useless
  });
}
