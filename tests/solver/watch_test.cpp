// What the watch reports: stable steps of deformed bodies, inversion, broken values.
#include "solver/watch.h"

#include <gtest/gtest.h>

#include <limits>

#include "solver/isochoric.h"
#include "solver_stiffness.h"

using namespace trocar;

static Body cube(Formulation formulation, MaterialModel model, double nu) {
  const bool is_hex = shape_of(formulation) == ElementType::hex8;
  return make_body(shape_of(formulation) == ElementType::tri3
                       ? make_rectangle(.02, .02, 4, 4)
                       : make_box(Vec3(0, 0, 0), Vec3(.02, .02, .02), {2, 2, 2},
                                  is_hex ? BoxElements::hex8 : BoxElements::tet4_kuhn),
                   {.materials = {material_of(model, 1500 / (1 + nu), 1000 / (1 - 2 * nu))},
                    .solver = with(formulation)});
}

TEST(Watch, at_rest_reports_the_least_undeformed_step_and_J_of_one) {
  Body body =
      make_body(make_box(Vec3(0, 0, 0), Vec3(.03, .02, .02), {5, 4, 4}, BoxElements::tet4_kuhn));
  const Watch w = look(body);
  EXPECT_EQ(w.stable_step, least_element_step(body));
  EXPECT_EQ(w.least_J, 1);
  EXPECT_EQ(w.least_J_element, 0);  // all are equal: the lowest number
  EXPECT_TRUE(w.is_finite);
  EXPECT_EQ(w.bad_node, -1);
}

struct Loosest {
  double ratio = 1, ratio_below_floor = 1;
};

static void check_stretched(Formulation formulation, MaterialModel model, double nu,
                            Loosest& loosest) {
  for (const double l : {.2, .35, .5, .8, 1.3, 2., 3.}) {
    if (model == MaterialModel::st_venant_kirchhoff && l < .7) continue;  // collapses
    Body body = cube(formulation, model, nu);
    const double b = std::pow(l, -nu);
    displace(body, [&](const Vec3& X) {
      return Vec3((l - 1) * X.x() + .1 * X.y(), (b - 1) * X.y(), (b - 1) * X.z());
    });
    const double ratio = look(body).stable_step / true_limit(body, 1e-8);
    EXPECT_LT(ratio, 1 + 1e-6)  // differences of forces: 1e-7
        << name_of(formulation) << " material " << static_cast<int>(model) << " l " << l << " nu "
        << nu;
    EXPECT_GT(ratio, 0);
    double& least = look(body).least_J < volume_floor ? loosest.ratio_below_floor : loosest.ratio;
    least = std::min(least, ratio);
  }
}

TEST(Watch, step_of_a_deformed_body_lies_below_its_true_limit) {
  // How far below is a matter of cost and only told: far in plane stress, which has no volumetric
  // stiffness near the incompressible limit where its bound, that of a solid, has it all the same,
  // and below the floor of volume, where the bound adds norms.
  for (const Formulation formulation : all_formulations()) {
    Loosest loosest;
    for (const MaterialModel model : all_models())
      for (const double nu : {0., .3, .45, .49})
        if (is_possible(formulation, model)) check_stretched(formulation, model, nu, loosest);
    std::printf("%s: step / true limit at least %.3f, below the floor of volume %.3f\n",
                name_of(formulation), loosest.ratio, loosest.ratio_below_floor);
  }
}

TEST(Watch, step_of_an_unevenly_deformed_body_lies_below_its_true_limit) {
  // Here averaged and own volume changes differ, and so do the points of an element.
  for (const Formulation formulation : all_formulations())
    for (const double nu : {.3, .49})
      for (std::uint64_t seed = 1; seed < 8; ++seed) {
        Body body = cube(formulation, MaterialModel::neo_hookean, nu);
        shake(body.state.u, 1e-3, seed);  // edges are 1 cm and less
        if (body.mesh.dimension() == 2)
          for (std::size_t k = 2; k < body.state.u.size(); k += 3) body.state.u[k] = 0;
        const Watch w = look(body);
        if (!(w.least_J > 0)) continue;
        EXPECT_LT(w.stable_step / true_limit(body, 1e-8), 1) << name_of(formulation);
      }
}

TEST(Watch, the_deformation_costs_at_most_a_few_per_cent_more_than_the_area_stretch) {
  // numerics 1.5: near incompressibility dt / dt0 follows 1 / sigma_max(cof F).
  for (const double l : {.35, .5, .8, 1.3, 2.}) {
    Body body = cube(Formulation::hex8_one_point, MaterialModel::neo_hookean, .49);
    const double b = 1 / std::sqrt(l);
    displace(body, [&](const Vec3& X) {
      return Vec3((l - 1) * X.x(), (b - 1) * X.y(), (b - 1) * X.z());
    });
    const double sigma = std::max(b * b, l * b);
    const double ratio = look(body).stable_step / least_element_step(body) * sigma;
    std::printf("stretch %.2f: step / (undeformed step / sigma_max(cof F)) = %.3f\n", l, ratio);
    EXPECT_LT(ratio, 1.0);
    EXPECT_GT(ratio, .9);
  }
}

TEST(Watch, the_step_never_exceeds_that_of_the_undeformed_body) {
  Body body = cube(Formulation::hex8_one_point, MaterialModel::neo_hookean, .3);
  displace(body, [](const Vec3& X) { return Vec3(-.05 * X); });
  EXPECT_LE(look(body).stable_step, least_element_step(body));
}

TEST(Watch, the_linear_material_keeps_its_step) {
  Body body = cube(Formulation::tet4, MaterialModel::linear, .3);
  displace(body, [](const Vec3& X) { return Vec3(-.6 * X.x(), 0, 0); });
  EXPECT_EQ(look(body).stable_step, least_element_step(body));
}

TEST(Watch, reports_the_least_J_and_its_element) {
  Body body =
      make_body(make_box(Vec3(0, 0, 0), Vec3(.03, .02, .02), {3, 2, 2}, BoxElements::tet4_kuhn));
  shake(body.state.u, 1e-3, 5);
  double least = 1e300;
  std::int32_t element = -1;
  std::vector<Vec3> x = body.mesh.X;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += Vec3::Map(&body.state.u[3 * i]);
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
    const double J = element_volume(body.mesh, e, x) / element_volume(body.mesh, e, body.mesh.X);
    if (J < least) element = e;
    least = std::min(least, J);
  }
  EXPECT_NEAR(look(body).least_J, least, 1e-13);
  EXPECT_EQ(look(body).least_J_element, element);
}

TEST(Watch, an_inverted_element_has_a_negative_J_and_its_forces_are_finite) {
  Body body = make_body(irregular_elements()[1]);
  body.state.u[11] = -.02;  // apex through the base
  EXPECT_LT(look(body).least_J, 0);
  EXPECT_TRUE(look(body).is_finite);
  for (const double f : force(body)) EXPECT_TRUE(std::isfinite(f));
}

TEST(Watch, names_the_first_node_that_is_not_finite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (const bool is_velocity : {false, true}) {
      Body body = cube(Formulation::tet4, MaterialModel::neo_hookean, .3);
      (is_velocity ? body.state.v : body.state.u)[3 * 14 + 1] = bad;
      (is_velocity ? body.state.u : body.state.v)[3 * 20] = bad;
      EXPECT_FALSE(look(body).is_finite);
      EXPECT_EQ(look(body).bad_node, 14);
    }
}

TEST(Watch, an_element_of_broken_nodes_has_no_stable_step) {
  Body body = cube(Formulation::tet4, MaterialModel::neo_hookean, .3);
  body.state.u[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(look(body).stable_step, 0);
  EXPECT_LT(look(body).least_J, 0);
}

// The least bound is that of the element whose step over the root of its growth is least.
TEST(Watch, tells_how_much_each_element_has_stiffened) {
  for (const Formulation formulation : all_formulations()) {
    Body body = cube(formulation, MaterialModel::neo_hookean, .3);
    shake(body.state.u, 3e-4, 5);
    std::vector<double> stiffening(body.part.element_global.size());
    const Watch w = watch(body.model, body.part, body.state, stiffening);
    double least = 1;
    for (std::size_t k = 0; k < stiffening.size(); ++k) {
      EXPECT_GE(stiffening[k], 1);
      least = std::min(least, body.model.element_step[k] / std::sqrt(stiffening[k]));
    }
    EXPECT_EQ(w.stable_step, least) << name_of(formulation);
    EXPECT_GT(std::ranges::max(stiffening), 1);
  }
}

TEST(EnergyTerms, an_affine_deformation_has_no_hourglass_energy) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.03, .03, .03), {3, 3, 3}, BoxElements::hex8);
  jitter(mesh, .25, 3);
  Body body = make_body(mesh);
  Mat3 A;
  A << .1, .3, -.1, .05, -.1, .2, .15, -.1, .05;
  displace(body, [&](const Vec3& X) { return Vec3(A * X); });
  EnergyTerms terms;
  energy_terms(body.model, body.part, body.state, terms);
  EXPECT_LT(sum(terms.hourglass), 1e-28 * sum(terms.strain));  // squares of rounding
}
