// Triangles in plane stress: closed forms, and how well the thickness is free of stress.
#include <gtest/gtest.h>

#include "solver/law_plane_stress.h"
#include "solver/material_law.h"
#include "solver/material_list.h"
#include "solver/material_setup.h"
#include "solver_body.h"

using namespace trocar;

constexpr double edge = .01;

// A right-angled triangle with F = diag(a, b) in its plane.
static Body triangle(const Material& material, double a, double b) {
  Body body = make_body(one_element(ElementType::tri3, {{0, 0, 0}, {edge, 0, 0}, {0, edge, 0}}),
                        {.materials = {material}, .solver = with(Formulation::tri3_plane_stress)});
  displace(body, [&](const Vec3& X) { return Vec3((a - 1) * X.x(), (b - 1) * X.y(), 0); });
  return body;
}

// P11 and P22 from the forces V P B_a with B_1 = (1/edge, 0), B_2 = (0, 1/edge). [Pa]
static std::array<double, 2> stress(Body& body) {
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
    const std::array<double, 2> P = stress(body);
    // 5e-9 of rounding in b times a stiffness of at most 10 mu.
    EXPECT_NEAR(P[0], P11, 5e-5);
    EXPECT_NEAR(P[1], 0, 5e-5);
  }
}

TEST(PlaneStress, the_linear_material_has_the_textbook_stiffness) {
  const double E = 3000, nu = .3, strain = .02;
  Body body = triangle({MaterialModel::linear, E, nu, 1000}, 1 + strain, 1);
  const std::array<double, 2> P = stress(body);
  EXPECT_NEAR(P[0], E / (1 - nu * nu) * strain, 1e-12 * E);
  EXPECT_NEAR(P[1], nu * E / (1 - nu * nu) * strain, 1e-12 * E);
}

TEST(PlaneStress, a_nearly_incompressible_sheet_keeps_its_volume) {
  const double nu = .4999, a = 1.4, b = 1.2;
  Body body = triangle({MaterialModel::neo_hookean, 3000, nu, 1000}, a, b);
  // Incompressible: P11 = mu (a - 1/(a^3 b^2)), and the error is of the order mu/K.
  const double mu = lame_mu(body.materials[0]);
  EXPECT_NEAR(stress(body)[0], mu * (a - 1 / (a * a * a * b * b)), 2e-3 * mu);
}

// |P33| / (lambda + 2 mu) that is left at the in-plane gradient H.
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
  const Pack P33 = law.stress(in_plane)(2, 2);
  Real plain;
  __builtin_memcpy(&plain, &P33, sizeof plain);
  return std::abs(static_cast<double>(plain)) / (lame_lambda(material) + 2 * lame_mu(material));
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
  double worst = 0;
  for (int k = 0; k < 2000; ++k) {
    double H[2][2];
    for (auto& row : H)
      for (double& x : row) x = amount * noise();
    if ((1 + H[0][0]) * (1 + H[1][1]) - H[0][1] * H[1][0] < .3) continue;
    if (M::model == MaterialModel::st_venant_kirchhoff && svk_thickness(H, nu) < .3) continue;
    worst = std::max(worst, residual<M, Real>({M::model, 3000, nu, 1000}, H));
  }
  return worst;
}

template <class... Ms, class Body>
static void for_each_material(TypeList<Ms...>, const Body& body) {
  (body.template operator()<Ms>(), ...);
}

TEST(PlaneStress, the_thickness_is_free_of_stress_to_rounding) {
  for_each_material(MaterialList{}, []<class M>() {
    for (const double nu : {0., .3, .45, .49, .499}) {
      const double in_double = worst_residual<M, double>(nu, .5);
      const double in_single = worst_residual<M, float>(nu, .5);
      std::printf("material %d, nu %.3f: P33 / (lambda + 2 mu) at most %.1g, single %.1g\n",
                  static_cast<int>(M::model), nu, in_double, in_single);
      EXPECT_LT(in_double, 2e-15);  // some roundings of stretches up to 3
      EXPECT_LT(in_single, 1e-6);
    }
  });
}
