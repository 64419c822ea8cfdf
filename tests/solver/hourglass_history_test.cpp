// Hourglass forces of viscoelastic one-point hexahedra: closed forms of relaxation, the elastic
// twin with the moduli that are left, objectivity and moments, and what a history must survive.
#include "solver/hourglass_history.h"

#include <gtest/gtest.h>

#include <cmath>

#include "larger_or_nan.h"
#include "solver/history.h"
#include "solver_body.h"
#include "solver_viscous.h"

using namespace trocar;

namespace {

constexpr double tau = .1;
constexpr Formulation with_hourglass[] = {Formulation::hex8_one_point, Formulation::hex8_enhanced};

Body body_of(Mesh mesh, Formulation formulation, std::vector<PronyBranch> prony,
             MaterialModel model = MaterialModel::neo_hookean,
             Precision precision = Precision::in_double) {
  return make_body(std::move(mesh), {.materials = {viscous_material(std::move(prony), model)},
                                     .solver = with(formulation, {.precision = precision})});
}

Mesh one_hexahedron() {
  return make_box(Vec3(0, 0, 0), Vec3(.01, .01, .01), {1, 1, 1}, BoxElements::hex8);
}

Mesh irregular_hexahedron() {
  return irregular_elements()[static_cast<std::size_t>(ElementType::hex8)];
}

// A mode of a cube that has no mean gradient: all its force is that against hourglass modes.
void bend(Body& body, double amount) {
  displace(body, [&](const Vec3& X) {
    const Vec3 x = X - Vec3(.005, .005, .005);
    return Vec3(amount * x.y() * x.z(), amount * x.x() * x.y(), 0);
  });
}

// Largest difference of the forces and `share` of others, over the largest of these.
double difference(const std::vector<double>& forces, double share,
                  const std::vector<double>& others) {
  double most = 0;
  for (std::size_t k = 0; k < forces.size(); ++k)
    most = larger_or_nan(most, std::abs(forces[k] - share * others[k]));
  return most / largest(others);
}

TEST(HourglassHistory, forces_relax_after_a_step_of_strain_by_the_shares) {
  const std::vector<PronyBranch> prony = {{.3, tau}, {.4, 5 * tau}};
  for (const Formulation formulation : with_hourglass)
    for (const Precision precision : precisions) {
      Body body =
          body_of(one_hexahedron(), formulation, prony, MaterialModel::neo_hookean, precision);
      Body elastic =
          body_of(one_hexahedron(), formulation, {}, MaterialModel::neo_hookean, precision);
      bend(body, 20);
      bend(elastic, 20);
      ASSERT_GT(largest(force(elastic)), 1e-4);
      const double rounding = precision == Precision::in_double ? 1e-13 : 1e-6;
      EXPECT_LT(difference(force(body), 1, force(elastic)), rounding);
      for (const double t : {.02, .1, .7}) {  // no error of time steps: the strain stands still
        body.state.time = t;
        const double share = .3 + .3 * std::exp(-t / tau) + .4 * std::exp(-t / (5 * tau));
        EXPECT_LT(difference(force(body), share, force(elastic)), rounding) << t;
      }
    }
}

TEST(HourglassHistory, forces_follow_a_ramp_of_strain_exactly) {
  const double g = .6, t = .15, exact = (1 - g) * t + g * tau * (1 - std::exp(-t / tau));
  for (const Formulation formulation : with_hourglass) {
    Body body = body_of(one_hexahedron(), formulation, {{g, tau}});
    Body elastic = body_of(one_hexahedron(), formulation, {});
    bend(elastic, 20);
    for (int k = 0; k <= 40; ++k) {
      bend(body, 20 * t * k / 40);
      body.state.time = t * k / 40;
      force(body);
    }
    EXPECT_LT(difference(force(body), exact, force(elastic)), 1e-13);
  }
}

// Of the neo-Hookean law what relaxes is proportional to mu, of every element.
TEST(HourglassHistory, a_relaxed_element_is_its_elastic_twin_in_any_deformation) {
  for (const Formulation formulation : all_formulations())
    for (const double share : {.5, .9}) {
      if (shape_of(formulation) == ElementType::tri3) continue;
      Body body = body_of(irregular_patch(formulation), formulation, {{share, tau}});
      Body twin = make_body(irregular_patch(formulation),
                            {.materials = {material_of(MaterialModel::neo_hookean,
                                                       (1 - share) * viscous_mu, viscous_K)},
                             .solver = with(formulation)});
      shake(body.state.u, 2e-3, 7);
      twin.state.u = body.state.u;
      force(body);
      body.state.time = 60 * tau;  // exp(-60) = 9e-27
      EXPECT_LT(difference(force(body), 1, force(twin)), 1e-12) << name_of(formulation) << share;
    }
}

TEST(HourglassHistory, a_rotation_turns_the_relaxing_force_with_it) {
  const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, 2, 2) / 3).toRotationMatrix();
  for (const Formulation formulation : with_hourglass)
    for (const MaterialModel model : all_models()) {
      if (model == MaterialModel::linear) continue;
      Body body = body_of(irregular_hexahedron(), formulation, {{.8, tau}}, model);
      shake(body.state.u, 1e-3, 8);
      force(body);
      Body turned = body;
      for (std::size_t a = 0; a < body.mesh.X.size(); ++a) {
        const Vec3 X = body.mesh.X[a], x = X + Vec3::Map(&body.state.u[3 * a]);
        Vec3::Map(&turned.state.u[3 * a]) = R * x - X;
      }
      body.state.time = turned.state.time = tau;
      const std::vector<double>&f = force(body), &r = force(turned);
      for (std::size_t a = 0; a < f.size(); a += 3)
        EXPECT_LT((R * Vec3::Map(&f[a]) - Vec3::Map(&r[a])).norm(), 1e-12 * largest(f));
    }
}

// Hourglass displacements that have changed their direction since: forces are not along them.
TEST(HourglassHistory, relaxing_forces_have_no_resultant_and_no_moment) {
  for (const Formulation formulation : with_hourglass)
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      Body body = body_of(irregular_hexahedron(), formulation, {{.8, tau}});
      shake(body.state.u, 2e-3, 2 * seed);
      force(body);
      body.state.time = tau;
      shake(body.state.u, 2e-3, 2 * seed + 1);
      const std::vector<double>& f = force(body);
      Vec3 resultant = Vec3::Zero(), moment = Vec3::Zero();
      for (std::size_t a = 0; a < f.size() / 3; ++a) {
        const Vec3 f_a = Vec3::Map(&f[3 * a]);
        resultant += f_a;
        moment += (body.mesh.X[a] + Vec3::Map(&body.state.u[3 * a])).cross(f_a);
      }
      EXPECT_LT(resultant.norm(), 1e-13 * largest(f));
      EXPECT_LT(moment.norm(), 1e-13 * .01 * largest(f));
    }
}

TEST(HourglassHistory, a_second_call_at_the_same_time_changes_nothing) {
  for (const Formulation formulation : with_hourglass)
    for (const MaterialModel model : all_models()) {
      SCOPED_TRACE(static_cast<int>(model));
      expect_second_call_changes_nothing(
          body_of(irregular_hexahedron(), formulation, {{.3, tau}, {.2, 2}}, model));
    }
}

TEST(HourglassHistory, all_instruction_sets_agree_to_rounding) {
  for (const Formulation formulation : with_hourglass)
    for (const Precision precision : precisions) {
      std::vector<double> first;
      for (int simd = 0; simd < n_simd; ++simd) {
        if (!is_supported(static_cast<Simd>(simd))) continue;
        select_simd(name_of(static_cast<Simd>(simd)));
        const Mesh mesh =
            make_box(Vec3(0, 0, 0), Vec3(.05, .03, .01), {5, 5, 1}, BoxElements::hex8);
        Body body = body_of(mesh, formulation, {{.7, tau}}, MaterialModel::neo_hookean, precision);
        shake(body.state.u, 1e-3, 4);
        force(body);
        body.state.time = tau;
        shake(body.state.u, 1e-4, 5);
        if (first.empty()) first = force(body);
        EXPECT_LT(difference(force(body), 1, first),
                  precision == Precision::in_double ? 1e-13 : 1e-5);
      }
      select_simd("auto");
    }
}

TEST(HourglassHistory, goes_over_to_another_distribution_of_elements) {
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.05, .03, .01), {5, 5, 1}, BoxElements::hex8);
  const Material material = viscous_material({{.4, tau}});
  const std::vector<std::int32_t> owner = partition_nodes(mesh, 2);
  Body alone = make_body(mesh, {.materials = {material}});
  const auto twist = [](Body& body) {
    displace(body, [](const Vec3& X) { return Vec3(X.y() * X.x() * 3, X.z() * X.x(), 0); });
    force(body);
  };
  twist(alone);
  std::vector<double> copies;
  for (const int rank : {0, 1}) {
    Body body = make_body(mesh, {.materials = {material}}, owner, rank);
    twist(body);
    const std::vector<double> copy = copy_history(body.model, body.part, body.state);
    copies.insert(copies.end(), copy.begin(), copy.end());
  }
  State state = make_state(alone.model);
  restore_history(alone.model, alone.part, copies, unedited_elements(mesh.n_elements()), state);
  const auto copy_of = [&](const State& of) { return copy_history(alone.model, alone.part, of); };
  EXPECT_GT(largest(state.history), 0);
  EXPECT_EQ(copy_of(state), copy_of(alone.state));
}

TEST(HourglassHistory, exists_of_one_point_hexahedra_with_viscosity_alone) {
  for (const Formulation formulation : all_formulations()) {
    Body body = body_of(irregular_patch(formulation), formulation, {{.3, tau}, {.2, 2}});
    const bool has_it =
        formulation == Formulation::hex8_one_point || formulation == Formulation::hex8_enhanced;
    const int n_points = formulation == Formulation::hex8_full ? 8 : 1;
    EXPECT_EQ(history_width(body.model.blocks[0]), (6 * n_points + (has_it ? 12 : 0)) * 3);
    EXPECT_EQ(history_width(body_of(irregular_patch(formulation), formulation, {}).model.blocks[0]),
              0);
  }
}

TEST(HourglassHistory, a_flattened_element_keeps_a_finite_history) {
  for (const Formulation formulation : with_hourglass) {
    Body body = body_of(one_hexahedron(), formulation, {{.5, tau}});
    for (const double s : {1., .15, 1e-9, 0., -1e-9, -.1, 1e-12, .15, 1.}) {
      displace(body, [&](const Vec3& X) { return Vec3(20 * X.y() * X.z(), 0, (s - 1) * X.z()); });
      body.state.time += 1e-3;
      ASSERT_TRUE(std::isfinite(largest(force(body)))) << s;
    }
    // q does not change, Q = F^-1 q by at most the 1.155 / J0 of isochoric.h: eight steps leave
    // less than eight times that of the force of q.
    Body elastic = body_of(one_hexahedron(), formulation, {});
    displace(elastic, [&](const Vec3& X) { return Vec3(20 * X.y() * X.z(), 0, 0); });
    EXPECT_LT(largest(force(body)), 8 * 1.155 / .2 * largest(force(elastic)));
  }
}

}  // namespace
