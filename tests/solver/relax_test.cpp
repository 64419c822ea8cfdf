// Dynamic relaxation finds the equilibria of known solutions, in the number of iterations that the
// theory gives, and says when it diverges.
#include "solver/relax.h"

#include <gtest/gtest.h>

#include <limits>

#include "dead_load.h"
#include "solver_algebra.h"
#include "solver_stiffness.h"

using namespace trocar;

// A block clamped at x = 0.
static Body clamped_block(BoxElements elements, const Material& material, int n = 2) {
  BodyOptions options{.materials = {material}};
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.04, .02, .02), {2 * n, n, n}, elements);
  jitter(mesh, .15, 3);
  for (const Vec3& X : mesh.X) options.fixed.push_back(X.x() < 1e-9 ? 7 : 0);
  return make_body(std::move(mesh), options);
}

static std::vector<double> random_load(const Body& body, double size) {
  std::vector<double> load(body.state.u.size(), 0.0);
  shake(load, size, 4);
  return load;
}

TEST(Relax, a_linear_body_comes_to_the_solution_of_its_stiffness_equations) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    Body body = clamped_block(elements, {MaterialModel::linear, 3000, .4, 1000});
    Eigen::MatrixXd K = tangent_stiffness(body, 1e-6);
    const std::vector<double> load = random_load(body, 1e-3);
    Eigen::VectorXd f = Eigen::Map<const Eigen::VectorXd>(load.data(), K.rows());
    for (Eigen::Index k = 0; k < K.rows(); ++k) {
      if (body.model.fixed[k / 3] == 0) continue;
      K.row(k).setZero();
      K.col(k).setZero();
      K(k, k) = 1;
      f[k] = 0;
    }
    const Eigen::VectorXd expected = solution(K, f);
    const Relaxation result = relax(body.model, {.add_load = dead_load(load), .tolerance = 1e-10},
                                    body.state, body.scratch);
    EXPECT_TRUE(result.is_converged);
    const Eigen::Map<const Eigen::VectorXd> u(body.state.u.data(), K.rows());
    // Rounding of forces (1e-16 of K u_max) and of the differences that made K.
    EXPECT_LT((u - expected).norm(), 1e-7 * expected.norm());
  }
}

TEST(Relax, a_sheared_and_stretched_boundary_leaves_an_affine_interior) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.04, .04, .04), {4, 4, 4}, BoxElements::hex8);
  jitter(mesh, .2, 5);
  Body body = make_body(mesh, {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}}});
  Mat3 A;
  A << .1, .2, -.1, .05, -.1, .1, .1, -.1, .05;
  std::vector<PrescribedNode> boundary;
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if ((mesh.X[i].array() < 1e-9).any() || (mesh.X[i].array() > .04 - 1e-9).any())
      boundary.push_back({.node = i, .u_next = A * mesh.X[i]});
  const Relaxation result =
      relax(body.model, {.prescribed = boundary, .tolerance = 1e-10}, body.state, body.scratch);
  EXPECT_TRUE(result.is_converged);
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    EXPECT_LT((Vec3::Map(&body.state.u[3 * i]) - A * mesh.X[i]).norm(), 1e-9 * .04) << i;
}

TEST(Relax, gravity_is_borne_by_the_supports_and_the_state_comes_to_rest) {
  BodyOptions options{.solver = {.gravity = Vec3(0, 0, -9.81)}};
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.04, .02, .02), {4, 2, 2}, BoxElements::tet4_kuhn);
  for (const Vec3& X : mesh.X) options.fixed.push_back(X.x() < 1e-9 ? 7 : 0);
  Body body = make_body(mesh, options);
  body.state.v[60] = 1;
  EXPECT_TRUE(relax(body.model, {.tolerance = 1e-8}, body.state, body.scratch).is_converged);
  double support = 0;
  for (std::size_t i = 0; i < mesh.X.size(); ++i)
    if (options.fixed[i] != 0) support -= body.scratch.force[3 * i + 2];
  // The clamped nodes' own weight is in their force too. Residuals of 1e-8 a node.
  EXPECT_NEAR(support, 9.81 * sum(body.mass), 1e-6 * 9.81 * sum(body.mass));
  EXPECT_EQ(largest(body.state.v), 0);
  EXPECT_EQ(body.state.time, 0);
  EXPECT_EQ(body.state.step, 0);
}

TEST(Relax, a_distorted_free_body_comes_to_rest_without_strain) {
  Body body = make_body(make_box(Vec3(0, 0, 0), Vec3(.03, .02, .02), {3, 2, 2}, BoxElements::hex8));
  shake(body.state.u, 1e-3, 6);
  const double before = stored_energy(body);
  EXPECT_TRUE(relax(body.model, {.ramp_iterations = 0}, body.state, body.scratch).is_converged);
  // The residual is 1e-9 of the greatest, so the energy 1e-18; softer modes hold more of it.
  EXPECT_LT(stored_energy(body), 1e-14 * before);
}

TEST(Relax, needs_about_as_many_iterations_as_the_ratio_of_frequencies_says) {
  // Critically damped in the lowest mode, the error falls by exp(-omega_0 dt) a step with omega_max
  // dt = 2 (numerics 1.7); bounds of elements make dt smaller by up to 3, ramp and the estimate of
  // omega_0 cost the rest.
  Body body = clamped_block(BoxElements::hex8, {MaterialModel::linear, 3000, .3, 1000}, 3);
  const std::vector<double> load = [&] {
    std::vector<double> f(body.state.u.size(), 0.0);
    for (std::size_t k = 2; k < f.size(); k += 3) f[k] = -1e-5 * body.mesh.X[k / 3].x();
    return f;
  }();
  const Relaxation result = relax(body.model, {.add_load = dead_load(load), .ramp_iterations = 0},
                                  body.state, body.scratch);
  EXPECT_TRUE(result.is_converged);
  // First bending mode of a cantilever of length / height 2: about .13 c_E h / L^2 * 2 pi = 1 / L
  // times .41 c_E; the step covers .6 of a cell, L / 6, at c_d.
  const double ideal = std::log(1e6) / (.41 * .6 / 6);
  std::printf("%lld iterations, ideal %.0f\n", static_cast<long long>(result.iterations), ideal);
  EXPECT_LT(static_cast<double>(result.iterations), 4 * ideal);
}

// Their stiffness is part of each element's own bound already.
TEST(Relax, takes_stiff_fibres_into_account_once) {
  Material skin = material_of(MaterialModel::holzapfel_gasser_ogden, 2e5, 2e6);
  skin.k1 = 24.5e6;
  skin.kappa = 0.15;
  Body body = clamped_block(BoxElements::tet4_kuhn, skin);
  Relaxer relaxer = make_relaxer(body.model, {});
  Communicator alone;
  force(body);
  relax_step(body.model, body.scratch, alone, relaxer, body.state);
  EXPECT_NEAR(relaxer.step, 0.95, 1e-9);  // of the limit at rest
}

TEST(Relax, finds_the_long_term_state_of_a_viscoelastic_body_and_leaves_it_at_rest) {
  // The isochoric stress falls to 1 - .3 - .2 of the elastic one: a body with half the mu, same K.
  const double mu = 1000, K = 5000;
  const auto relaxed = [](const Material& material) {
    Body body = clamped_block(BoxElements::tet4_kuhn, material);
    const std::vector<double> load = random_load(body, 1e-4);
    const RelaxTask task{.add_load = dead_load(load), .tolerance = 1e-10};
    EXPECT_TRUE(relax(body.model, task, body.state, body.scratch).is_converged);
    return body;
  };
  Material viscous = material_of(MaterialModel::neo_hookean, mu, K);
  viscous.prony = {{.share = .3, .time = .01}, {.share = .2, .time = 10}};
  Body body = relaxed(viscous);
  const std::vector<double> elastic =
      relaxed(material_of(MaterialModel::neo_hookean, .5 * mu, K)).state.u;
  // Residuals of 1e-10.
  EXPECT_LE(largest_difference(body.state.u, elastic), 1e-7 * largest(elastic));
  // Without overstress a second of waiting changes no force.
  const std::vector<double> now = force(body);
  body.state.time += 1;
  EXPECT_EQ(force(body), now);
}

TEST(Relax, gives_the_same_bits_with_any_number_of_threads) {
  const auto run = [](int n_threads) {
    set_thread_count(n_threads);
    Body body = clamped_block(BoxElements::hex8, Material{}, 6);
    const std::vector<double> load = random_load(body, 1e-4);
    relax(body.model, {.add_load = dead_load(load), .max_iterations = 300}, body.state,
          body.scratch);
    set_thread_count(1);
    return body.state.u;
  };
  const std::vector<double> alone = run(1);
  EXPECT_GT(largest(alone), 1e-6);
  EXPECT_EQ(run(2), alone);
  EXPECT_EQ(run(3), alone);
}

TEST(Relax, says_so_when_values_are_not_finite) {
  Body body = clamped_block(BoxElements::tet4_kuhn, Material{});
  std::vector<double> load = random_load(body, 1e-4);
  load.back() = std::numeric_limits<double>::infinity();
  for (const std::int64_t n_ramp : {std::int64_t{0}, RelaxTask{}.ramp_iterations}) {
    const RelaxTask task{.add_load = dead_load(load), .ramp_iterations = n_ramp};
    const Relaxation result = relax(body.model, task, body.state, body.scratch);
    EXPECT_FALSE(result.is_finite) << n_ramp;
    EXPECT_FALSE(result.is_converged) << n_ramp;
    body.state = make_state(body.model);
  }
}
