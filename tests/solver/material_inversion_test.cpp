// Decoupled materials below the floor of isochoric.h, through J = 0 and beyond.
#include <gtest/gtest.h>

#include "solver_material.h"

using namespace trocar;

namespace {

// F with stretches between 0.5 and 1.5, one of them replaced so that det F = J.
Mat3 gradient_of_volume(Noise& noise, double J) {
  const auto rotation = [&] {
    const Vec3 axis(noise(), noise(), noise());
    return Mat3(Eigen::AngleAxisd(3 * noise(), axis.normalized()));
  };
  Vec3 s(1 + .5 * noise(), 1 + .5 * noise(), 0);
  s[2] = J / (s[0] * s[1]);
  return rotation() * s.asDiagonal() * rotation();
}

template <class Body>
void for_each_decoupled(const Body& body) {
  for_each_material(MaterialList{}, [&]<class M>() {
    if constexpr (M::is_decoupled) body.template operator()<M>();
  });
}

// d2W along dF = d, on the side where d points.
template <class M>
double tangent_along(const Mat3& F, const Mat3& d, double h) {
  return ((stress<M>(F + h * d) - stress<M>(F)).array() * d.array()).sum() / h;
}

constexpr double volumes[] = {.199, .15, .05, 1e-3, -1e-3, -.072, -.5, -2};

}  // namespace

TEST(Inversion, stress_is_the_derivative_of_the_energy_below_the_floor) {
  for_each_decoupled([]<class M>() {
    Noise noise(3);
    for (const double J : volumes)
      for (int k = 0; k < 10; ++k) {
        const Mat3 F = gradient_of_volume(noise, J);
        const Mat3 P = stress<M>(F);
        // Relative to W / J0: (h / J0)^2 times some for the third derivative, eps J0 / h for W.
        const double h = 1e-6, tolerance = 1e-7 * (K + P.norm() + energy<M>(F) / volume_floor);
        for (int i = 0; i < 9; ++i) {
          Mat3 above = F, below = F;
          above.data()[i] += h;
          below.data()[i] -= h;
          EXPECT_NEAR(P.data()[i], (energy<M>(above) - energy<M>(below)) / (2 * h), tolerance)
              << "material " << static_cast<int>(M::model) << ", J = " << J;
        }
      }
  });
}

TEST(Inversion, stress_and_tangent_are_continuous_at_the_floor) {
  for_each_decoupled([]<class M>() {
    Noise noise(4);
    for (int k = 0; k < 20; ++k) {
      const Mat3 F = gradient_of_volume(noise, volume_floor);
      const Mat3 d = F.inverse().transpose() * volume_floor;  // cof F: the way out of the floor
      const double h = 1e-5;
      const double up = tangent_along<M>(F, d, h), down = -tangent_along<M>(F, -d, -h);
      // One-sided differences: h d3W, of relative size h |cof F| / J0 ~ 1e-4, times some.
      EXPECT_NEAR(up, -down, 2e-3 * std::abs(up)) << static_cast<int>(M::model);
    }
  });
}

TEST(Inversion, stress_and_energy_are_finite_without_any_volume) {
  for_each_decoupled([]<class M>() {
    for (const Vec3& s : {Vec3(1.1, .9, 0), Vec3(1.1, 0, 0), Vec3(0, 0, 0)}) {
      EXPECT_TRUE(stress<M>(s.asDiagonal()).allFinite()) << static_cast<int>(M::model);
      EXPECT_TRUE(std::isfinite(energy<M>(s.asDiagonal())));
    }
  });
}

TEST(Inversion, a_flattened_or_inverted_cube_is_pushed_back_at_any_depth) {
  for_each_decoupled([]<class M>() {
    double before = 1e300;
    for (double s = -3; s < .95; s += .01) {
      const Mat3 F = Vec3(1, 1, s).asDiagonal();
      EXPECT_LT(stress<M>(F)(2, 2), 0) << static_cast<int>(M::model) << ", s = " << s;
      EXPECT_LT(energy<M>(F), before);
      before = energy<M>(F);
    }
  });
}

TEST(Inversion, a_rotation_turns_the_stress_with_it) {
  const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, 2, 2) / 3).toRotationMatrix();
  for_each_decoupled([&]<class M>() {
    Noise noise(5);
    for (const double J : volumes) {
      const Mat3 F = gradient_of_volume(noise, J), P = stress<M>(F);
      // Rounding of the eigenvalues, 1e-16 of a square that J^2 may be as small as 1e-6 of.
      EXPECT_LT((stress<M>(R * F) - R * P).norm(), 1e-9 * (K + P.norm())) << J;
    }
  });
}

TEST(Inversion, ogden_with_the_powers_2_and_minus_2_is_mooney_rivlin_below_the_floor) {
  Material ogden = material_of(MaterialModel::ogden, mu, K);
  ogden.ogden[0] = {.mu = .6 * mu, .alpha = 2};   // 2 c10
  ogden.ogden[1] = {.mu = .4 * mu, .alpha = -2};  // 2 c01
  const BlockOfOne<MaterialOgden> block(ogden);
  Noise noise(6);
  for (const double J : volumes) {
    const Mat3 F = gradient_of_volume(noise, J), H = F - Mat3::Identity();
    const Mat3 P = stress<MaterialMooneyRivlin>(F);
    // As above; the stress divides by the least stretch's square, at least 1e-6.
    EXPECT_LT((matrix(MaterialOgden::stress(tensor(H), block.values())) - P).norm(),
              1e-9 * P.norm())
        << J;
    const double W = energy<MaterialMooneyRivlin>(F);
    EXPECT_NEAR(MaterialOgden::energy(tensor(H), block.values()), W, 1e-9 * W);
  }
}
