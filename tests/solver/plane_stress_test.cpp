// Triangles in plane stress: closed forms, how well the thickness is free of stress, and the law in
// three dimensions driven along the same path.
#include <gtest/gtest.h>

#include "larger_or_nan.h"
#include "solver/law_plane_stress.h"
#include "solver/material_law.h"
#include "solver/material_list.h"
#include "solver/material_setup.h"
#include "solver_body.h"
#include "solver_material.h"

using namespace trocar;

constexpr double edge = .01;
constexpr double largest_exponent = MaterialHolzapfelGasserOgden::largest_exponent;

// A right-angled triangle with F = diag(a, b) in its plane.
static Body triangle(const Material& material, double a, double b) {
  Body body = make_body(single_element(ElementType::tri3, {{0, 0, 0}, {edge, 0, 0}, {0, edge, 0}}),
                        {.materials = {material}, .solver = with(Formulation::tri3_plane_stress)});
  displace(body, [&](const Vec3& X) { return Vec3((a - 1) * X.x(), (b - 1) * X.y(), 0); });
  return body;
}

// P11 and P22 from the forces V P B_a with B_1 = (1/edge, 0), B_2 = (0, 1/edge). [Pa]
static std::array<double, 2> stress_in_plane(Body& body) {
  const std::vector<double>& f = force(body);
  const double scale = .5 * edge * body.model.options.thickness;
  return {-f[3] / scale, -f[7] / scale};
}

TEST(PlaneStress, a_bar_has_the_known_neo_hookean_stress_and_none_across) {
  // numerics V4, K/mu = 49: P11 [Pa] and the lateral stretch, which is that of the thickness too.
  const double row[4][3] = {{.6, -2165.899144, 1.28522374},
                            {.8, -758.121946, 1.11571558},
                            {1.2, 501.363401, .91472954},
                            {1.5, 1043.554101, .82078721}};
  for (const auto& [l, P11, b] : row) {
    Body body = triangle(material_of(MaterialModel::neo_hookean, 1000, 49000), l, b);
    const std::array<double, 2> P = stress_in_plane(body);
    // 5e-9 of rounding in b times a stiffness of at most 10 mu.
    EXPECT_NEAR(P[0], P11, 5e-5);
    EXPECT_NEAR(P[1], 0, 5e-5);
  }
}

// The in-plane stretch b at which nothing pulls across, and P11 there.
static std::array<double, 2> uniaxial(const Material& material, double a) {
  double low = .3, high = 2;
  for (int k = 0; k < 60; ++k) {
    const double b = (low + high) / 2;
    Body body = triangle(material, a, b);
    (stress_in_plane(body)[1] < 0 ? low : high) = b;
  }
  Body body = triangle(material, a, low);
  return {low, stress_in_plane(body)[0]};
}

TEST(PlaneStress, a_bar_with_fibres_has_the_known_stress) {
  // numerics V4, in digits printed: transversely isotropic along the bar.
  const Material fibres = material_of(MaterialModel::transversely_isotropic, 1000, 49000);
  const double row[4][2] = {
      {.6, -3700.155826}, {.8, -1897.046706}, {1.2, 2481.005195}, {1.5, 7554.791958}};
  // 1e-13 of a search that stops, times a stiffness of some 1e5 Pa.
  for (const auto& [l, P11] : row) EXPECT_NEAR(uniaxial(fibres, l)[1], P11, 6e-7) << l;
}

TEST(PlaneStress, a_bar_with_two_dispersed_families_of_fibres_has_the_known_stress) {
  // numerics V4: families at 30 degrees in the sheet, which narrows by more than it thins.
  const Material fibres = material_of(MaterialModel::holzapfel_gasser_ogden, 1000, 49000);
  const auto [b, P11] = uniaxial(fibres, 1.2);
  EXPECT_NEAR(b, .86538181, 6e-9);
  EXPECT_NEAR(P11, 1620.690258, 6e-7);
  EXPECT_NEAR(uniaxial(fibres, 1.5)[1], 14359.564, 6e-4);
  // Slack fibres: what is left is neo-Hookean.
  const Material none = material_of(MaterialModel::neo_hookean, 1000, 49000);
  EXPECT_NEAR(uniaxial(fibres, .8)[1], uniaxial(none, .8)[1], 1e-9);
}

TEST(PlaneStress, the_linear_material_has_the_textbook_stiffness) {
  const double E = 3000, nu = .3, strain = .02;
  Body body = triangle({MaterialModel::linear, E, nu, 1000}, 1 + strain, 1);
  const std::array<double, 2> P = stress_in_plane(body);
  EXPECT_NEAR(P[0], E / (1 - nu * nu) * strain, 1e-12 * E);
  EXPECT_NEAR(P[1], nu * E / (1 - nu * nu) * strain, 1e-12 * E);
}

TEST(PlaneStress, a_nearly_incompressible_sheet_keeps_its_volume) {
  const double nu = .4999, a = 1.4, b = 1.2;
  Body body = triangle({MaterialModel::neo_hookean, 3000, nu, 1000}, a, b);
  // Incompressible: P11 = mu (a - 1/(a^3 b^2)), and the error is of the order mu/K.
  const double mu = lame_mu(body.materials[0]);
  EXPECT_NEAR(stress_in_plane(body)[0], mu * (a - 1 / (a * a * a * b * b)), 2e-3 * mu);
}

// |P33| that is left at the in-plane gradient H, over lambda + 2 mu or the greatest stress.
template <class M, class Real>
static double residual(const Material& material, const double (&H)[2][2]) {
  using Pack = PackOf<Real, 1>;
  constexpr int lanes = lanes_of_block<Real>;
  std::array<double, max_values> value{};
  const std::array<Vec3, 3> X = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const ElementConstants c = constants_tri3_plane_stress({.X = X,
                                                          .lambda = lame_lambda(material),
                                                          .mu = lame_mu(material),
                                                          .density = 1,
                                                          .thickness = 2});
  fill_material(material, c.volume, Vec3::UnitX(), value);
  std::copy_n(c.value.begin(), ElementTri3PlaneStress::n_values, value.begin() + M::n_values);
  std::array<Real, static_cast<std::size_t>(max_values) * lanes> number{};
  for (std::size_t k = 0; k < value.size(); ++k) number[k * lanes] = static_cast<Real>(value[k]);
  const LawPlaneStress<Law<M, Pack>, Pack> law{{{number.data()}},
                                               {number.data() + M::n_values * lanes}};
  Tensor<Pack> in_plane{};
  for (int a = 0; a < 2; ++a)
    for (int i = 0; i < 2; ++i) in_plane(i, a) = Pack{} + static_cast<Real>(H[i][a]);
  const Tensor<Pack> P = law.stress(in_plane);
  Real plain[9];
  __builtin_memcpy(plain, &P, sizeof plain);
  const double stiffness = lame_lambda(material) + 2 * lame_mu(material);
  return std::abs(static_cast<double>(plain[8])) / larger_or_nan(stiffness, largest(plain));
}

// F33^2 = 1 - nu / (1 - nu) (tr C - 2) of the St. Venant-Kirchhoff material; there is no free
// thickness where this is negative.
static double svk_thickness(const double (&H)[2][2], double nu) {
  double twice_E = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double F = H[i][j] + (i == j ? 1 : 0);
      twice_E += F * F;
    }
  return 1 - nu / (1 - nu) * (twice_E - 2);
}

// The worst over random deformations with principal stretches up to about `amount` from 1.
template <class M, class Real>
static double worst_residual(double nu, double amount) {
  Noise noise(4);
  const Material material = material_of(M::model, 1500 / (1 + nu), 1000 / (1 - 2 * nu));
  double worst = 0;
  for (int k = 0; k < 2000; ++k) {
    double H[2][2];
    for (auto& row : H)
      for (double& x : row) x = amount * noise();
    if ((1 + H[0][0]) * (1 + H[1][1]) - H[0][1] * H[1][0] < .3) continue;
    if (M::model == MaterialModel::st_venant_kirchhoff && svk_thickness(H, nu) < .3) continue;
    worst = larger_or_nan(worst, residual<M, Real>(material, H));
  }
  return worst;
}

TEST(PlaneStress, the_thickness_is_free_of_stress_to_rounding) {
  for_each_material(MaterialList{}, []<class M>() {
    for (const double nu : {0., .3, .45, .49, .499}) {
      const double in_double = worst_residual<M, double>(nu, .5);
      const double in_single = worst_residual<M, float>(nu, .5);
      std::printf("material %d, nu %.3f: P33 over a stiffness at most %.1g, single %.1g\n",
                  static_cast<int>(M::model), nu, in_double, in_single);
      // Some roundings of stretches up to 3. Ogden's eigenvalues are off by one of the greatest,
      // (ratio of stretches)^2 ~ 4 of the least, and to the power alpha = -8. Fibres have a
      // rounding of exponents k2 E^2 up to 16.
      const double factor = M::model == MaterialModel::ogden                    ? 32
                            : M::model == MaterialModel::holzapfel_gasser_ogden ? largest_exponent
                                                                                : 1;
      EXPECT_LT(in_double, factor * 2e-15);
      // In single precision a step of 2e-6 ends the search: as much strain may be left.
      EXPECT_LT(in_single, factor * 2e-6);
    }
  });
}

// Gradient in the plane along a path in time: stretched, sheared and partly let go.
static Mat3 path(double t) {
  Mat3 H = Mat3::Zero();
  H.topLeftCorner<2, 2>() << .3 * t, .2 * t * (1 - t), -.1 * t * t, .1 * t - .15 * t * t;
  return H;
}

static void displace_by(Body& body, const Mat3& H) {
  displace(body, [&](const Vec3& X) { return Vec3(H * X); });
}

// P of a right-angled tetrahedron of edge L from f_a = V P B_a, B_1 = (1/L, 0, 0) … [Pa]
static Mat3 solid_stress(Body& solid) {
  const std::vector<double>& f = force(solid);
  Mat3 P;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) P(i, j) = -f[3 * (j + 1) + i] * 6 / (edge * edge);
  return P;
}

// Of the thickness without stress, by bisection from one and the same history.
static Mat3 sheet_stress(Body& solid, Mat3 H) {
  const State before = solid.state;
  const auto at = [&](double h) {
    H(2, 2) = h;
    solid.state = before;
    displace_by(solid, H);
    return solid_stress(solid);
  };
  double low = -.6, high = 1;
  for (int k = 0; k < 60; ++k) {
    const double h = (low + high) / 2;
    (at(h)(2, 2) < 0 ? low : high) = h;
  }
  return at(low);
}

TEST(PlaneStress, a_relaxing_sheet_follows_the_solid_law_without_stress_across_it) {
  for (const MaterialModel model : all_models()) {
    Material material = material_of(model, 1000, 9000);
    material.prony = {{.3, .05}, {.4, .5}};
    Body sheet = triangle(material, 1, 1);
    Body solid = make_body(
        single_element(ElementType::tet4, {{0, 0, 0}, {edge, 0, 0}, {0, edge, 0}, {0, 0, edge}}),
        {.materials = {material}});
    for (int k = 0; k <= 20; ++k) {
      sheet.state.time = solid.state.time = .02 * k;
      displace_by(sheet, path(k / 20.));
      const Mat3 P = sheet_stress(solid, path(k / 20.));
      const std::array<double, 2> P_sheet = stress_in_plane(sheet);
      // Thicknesses that are 1e-13 and 1e-16 off, times a stiffness of some 1e5 Pa.
      EXPECT_NEAR(P_sheet[0], P(0, 0), 1e-7) << static_cast<int>(model) << " at step " << k;
      EXPECT_NEAR(P_sheet[1], P(1, 1), 1e-7) << static_cast<int>(model) << " at step " << k;
      EXPECT_LT(std::abs(P(2, 2)), 1e-7);
    }
    EXPECT_GT(std::abs(stress_in_plane(sheet)[0]), 10);  // there is something to compare
  }
}

// Strain e along x held from the start on, none along y, linear material. With the relaxation
// s/(1 + s tau)-wise in Laplace's variable, sigma_33 = 0 gives e_33 one exponential of its own:
//   e_33 = e_inf + (e_0 - e_inf) exp(-t/tau'),  e_G = -(K - 2/3 mu G) / (K + 4/3 mu G) e,
//   tau' = tau (K + 4/3 mu) / (K + 4/3 mu G),  G = 1 - g at the end, 1 at the start;
// then tr sigma = 3 K (e + e_33) and sigma_11 - sigma_22 = 2 mu (1 - g (1 - exp(-t/tau))) e.
static double held_sheet(double e, double t, double g, double tau) {
  const double mu = 1000, K = 4000;
  const auto e33 = [&](double G) { return -(K - 2 * mu * G / 3) / (K + 4 * mu * G / 3) * e; };
  const double slow = tau * (K + 4 * mu / 3) / (K + 4 * mu * (1 - g) / 3);
  const double now = e33(1 - g) + (e33(1) - e33(1 - g)) * std::exp(-t / slow);
  const double relaxed = 1 - g * (1 - std::exp(-t / tau));
  return (3 * K * (e + now) + 2 * mu * relaxed * e) / 2;
}

static double held_sheet_error(int n_steps) {
  const double e = .01, g = .6, tau = .1, end = .2;
  Material material = material_of(MaterialModel::linear, 1000, 4000);
  material.prony = {{g, tau}};
  Body body = triangle(material, 1 + e, 1);
  double P11 = stress_in_plane(body)[0];
  EXPECT_NEAR(P11, held_sheet(e, 0, g, tau), 1e-9);
  for (int k = 1; k <= n_steps; ++k) {
    body.state.time = end * k / n_steps;
    P11 = stress_in_plane(body)[0];
  }
  return P11 - held_sheet(e, end, g, tau);
}

TEST(PlaneStress, a_held_sheet_relaxes_as_the_closed_form_to_second_order) {
  const double coarse = held_sheet_error(20), fine = held_sheet_error(40);
  // What the thickness strain takes is piecewise linear in a step: x^2/12 of what relaxes, 2 mu g e
  // (x = dt/tau = 1/20), and the thickness takes less than all of it.
  EXPECT_LT(std::abs(fine), 2 * 1000 * .6 * .01 / 12 / 400);
  EXPECT_NEAR(coarse / fine, 4, .2);  // the next order is x of it
}

TEST(PlaneStress, a_second_call_at_the_same_time_changes_no_more_than_rounding) {
  // The search starts from the strain in the plane, not from where it ended: 1e-13 of a thickness.
  for (const MaterialModel model : all_models()) {
    Material material = material_of(model, 1000, 9000);
    material.prony = {{.5, .1}};
    Body body = triangle(material, 1.2, .9);
    stress_in_plane(body);
    body.state.time = .07;
    displace_by(body, path(.8));
    const std::array<double, 2> first = stress_in_plane(body), again = stress_in_plane(body);
    EXPECT_LE(largest_difference(again, first), 1e-13 * 1e5);
  }
}
