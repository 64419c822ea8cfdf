// Elements on their own: what any element must do, for every formulation and material.
#include "solver/element_setup.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "larger_or_nan.h"
#include "solver_stiffness.h"

using namespace trocar;

// Runs `check` for each formulation with each material, displaced at random by a tenth of its size
// (z stays in plane problems).
template <class Check>
static void for_each_element_and_material(Precision precision, const Check& check) {
  for (const Formulation formulation : all_formulations())
    for (const MaterialModel model : all_models()) {
      if (!is_possible(formulation, model)) continue;
      SCOPED_TRACE(std::string(name_of(formulation)) + " material " +
                   std::to_string(static_cast<int>(model)));
      Body body =
          make_body(irregular_patch(formulation),
                    {.materials = {material_of(model, 1000, 9000)},
                     .solver = with(formulation, {.hourglass = 0.2, .precision = precision})});
      shake(body.state.u, 1e-3, 3);
      if (body.mesh.dimension() == 2)
        for (std::size_t k = 2; k < body.state.u.size(); k += 3) body.state.u[k] = 0;
      check(body);
    }
}

static void for_each_element_and_material(const std::function<void(Body&)>& check) {
  for_each_element_and_material(Precision::in_double, check);
}

TEST(Element, force_is_minus_the_derivative_of_the_stored_energy) {
  for_each_element_and_material([](Body& body) {
    const std::vector<double> f = force(body);
    const double h = 1e-7;  // (h / size)^2 ~ 1e-10 and eps W / h ~ 1e-13 N of 0.1 N
    for (std::size_t k = 0; k < f.size(); ++k) {
      if (body.mesh.dimension() == 2 && k % 3 == 2) continue;
      const double kept = body.state.u[k];
      body.state.u[k] = kept + h;
      const double above = stored_energy(body);
      body.state.u[k] = kept - h;
      const double below = stored_energy(body);
      body.state.u[k] = kept;
      EXPECT_NEAR(f[k], -(above - below) / (2 * h), 1e-7 * largest(f));
    }
  });
}

TEST(Element, a_translation_makes_no_force_and_forces_sum_to_zero) {
  for_each_element_and_material([](Body& body) {
    const std::vector<double> f = force(body);
    for (int i = 0; i < 3; ++i) {
      double total = 0;
      for (std::size_t k = i; k < f.size(); k += 3) total += f[k];
      EXPECT_NEAR(total, 0, 1e-14 * largest(f));  // eight roundings
    }
    displace(body, [](const Vec3&) { return Vec3(0.3, -0.7, 0); });
    // Only differences of displacements enter; fibres make 10 mu h^2 out of q's error, 4e-26.
    const double of_q = has_fibres(body.materials[0].model) ? 4e-26 : 0;
    EXPECT_LE(largest(force(body)), of_q);
  });
}

static void check_rotation(Precision precision, double tolerance) {
  for_each_element_and_material(precision, [=](Body& body) {
    const bool is_plane = body.mesh.dimension() == 2;
    const Vec3 axis = is_plane ? Vec3(0, 0, 1) : Vec3(Vec3(1, 2, 2) / 3);
    const Mat3 R = Eigen::AngleAxisd(1.1, axis).toRotationMatrix();
    displace(body, [&](const Vec3& X) { return Vec3(R * X - X); });
    const double depth = is_plane ? body.model.options.thickness : .01;
    const double scale = 9000 * .01 * depth;  // K h^2
    if (body.materials[0].model == MaterialModel::linear)
      EXPECT_GT(largest(force(body)), 0.1 * scale);
    else
      EXPECT_LT(largest(force(body)), tolerance * scale);
  });
}

TEST(Element, a_rigid_rotation_makes_no_force_except_with_the_linear_material) {
  // numerics V3: what one-point elements reach; eight points add up eight times.
  check_rotation(Precision::in_double, 3e-15);
  check_rotation(Precision::in_single, 6e-7);
}

TEST(Element, a_translation_by_ten_metres_makes_no_force_in_single_precision) {
  for_each_element_and_material(Precision::in_single, [](Body& body) {
    const std::vector<double> f = force(body);
    // Exactly none, but for fibres: q of isochoric.h is 4e-11 at rest in single precision.
    const bool has_fibres = body.materials[0].model == MaterialModel::transversely_isotropic ||
                            body.materials[0].model == MaterialModel::holzapfel_gasser_ogden;
    const double strained = largest(f);
    displace(body, [](const Vec3&) { return Vec3(10, -10, 0); });
    EXPECT_LE(largest(force(body)), has_fibres ? 1e-9 * strained : 0);
    shake(body.state.u, 1e-3, 3);
    if (body.mesh.dimension() == 2)
      for (std::size_t k = 2; k < body.state.u.size(); k += 3) body.state.u[k] = 0;
    // u is rounded to 1e-15 of 1e-3 m, then to single.
    EXPECT_LE(largest_difference(force(body), f), 3e-6 * largest(f));
  });
}

TEST(Element, an_affine_displacement_has_no_hourglass_energy) {
  for (const Precision precision : precisions)
    for_each_element_and_material(precision, [=](Body& body) {
      Mat3 A;
      A << .1, .3, 0, .05, -.1, 0, 0, 0, 0;
      displace(body, [&](const Vec3& X) { return Vec3(A * X); });
      const double W = stored_energy(body);
      EnergyTerms terms;
      energy_terms(body.model, body.part, body.state, terms);
      const bool is_double = precision == Precision::in_double;
      EXPECT_LE(sum(terms.hourglass), (is_double ? 1e-28 : 1e-12) * W);  // squares of roundings
    });
}

TEST(Element, the_moment_of_its_forces_about_the_deformed_positions_vanishes) {
  for_each_element_and_material([](Body& body) {
    if (body.materials[0].model == MaterialModel::linear) return;
    const std::vector<double> f = force(body);
    Vec3 moment = Vec3::Zero();
    for (std::size_t a = 0; a < body.mesh.X.size(); ++a) {
      const Vec3 x = body.mesh.X[a] + Vec3::Map(&body.state.u[3 * a]);
      moment += x.cross(Vec3::Map(&f[3 * a]));
    }
    EXPECT_LT(moment.norm(), 1e-14 * largest(f) * .02);  // lever arms of 2 cm, some roundings
  });
}

static Mesh distorted(Mesh mesh, Noise& noise) {
  const double z = mesh.dimension() == 2 ? 0 : 1;
  for (Vec3& X : mesh.X) X += 2e-3 * Vec3(noise(), noise(), z * noise());
  return mesh;
}

static bool is_sound(const Mesh& mesh, const BodyOptions& options) {
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    if (!(element_volume(mesh, e, mesh.X) > 0)) return false;
  try {
    make_body(mesh, options);
  } catch (const InputError&) {  // a Gauss point without volume
    return false;
  }
  return true;
}

static void check_bound(Formulation formulation, Precision precision, double tolerance) {
  Noise noise(5);
  double sharpest = 0, loosest = 1;
  const bool is_averaged = formulation == Formulation::tet4_nodal_pressure;
  for (int k = 0; k < 60; ++k) {
    const double nu = std::vector<double>{-0.3, 0, .3, .45, .499}[k % 5];
    const MaterialModel model = is_averaged ? MaterialModel::neo_hookean : MaterialModel::linear;
    const BodyOptions options{
        .materials = {{model, 3000, nu, 1000}},
        .solver = with(formulation, {.hourglass = k % 2 == 0 ? .15 : 1., .precision = precision})};
    const Mesh mesh = distorted(irregular_patch(formulation), noise);
    if (!is_sound(mesh, options)) continue;
    Body body = make_body(mesh, options);
    // Linear forces have no truncation error; the others are differenced close to zero.
    const double ratio = least_element_step(body) / true_limit(body, is_averaged ? 1e-7 : 1e-4);
    EXPECT_LT(ratio, 1 + tolerance);
    sharpest = larger_or_nan(sharpest, ratio);
    loosest = std::min(loosest, ratio);
  }
  std::printf("%s, %s: bound / true limit of the step %.4f to %.4f\n", name_of(formulation),
              name_of(precision), loosest, sharpest);
  EXPECT_GT(sharpest, 0.3);
}

TEST(Element, its_bound_lies_above_the_true_frequency_for_any_shape_and_material) {
  for (const Formulation formulation : all_formulations()) {
    check_bound(formulation, Precision::in_double, 1e-9);
    if (formulation != Formulation::tet4_nodal_pressure)  // no single digits left at 1e-7 m
      check_bound(formulation, Precision::in_single, 1e-5);
  }
}

TEST(Element, the_bound_of_a_cube_is_exact) {
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.01, .01, .01), {1, 1, 1}, BoxElements::hex8);
  for (const double nu : {0., .3, .49}) {
    Body one_point = make_body(mesh, {.materials = {{MaterialModel::linear, 3000, nu, 1000}}});
    EXPECT_NEAR(one_point.model.element_step[0] / true_limit(one_point, 1e-4), 1, 1e-9);
    Body full = make_body(mesh, {.materials = {{MaterialModel::linear, 3000, nu, 1000}},
                                 .solver = with(Formulation::hex8_full)});
    // The bound of the scalar eigenvalue (element_hex8_full_setup.cpp) costs 0.9 % of the step.
    const double ratio = full.model.element_step[0] / true_limit(full, 1e-4);
    EXPECT_LT(ratio, 1);
    EXPECT_GT(ratio, .99);
  }
}
