// Selective mass scaling gives slivers the wanted step and leaves falling, resting and the sums of
// masses alone; its inverse in closed form against a dense matrix.
#include "solver/mass_scaling.h"

#include <gtest/gtest.h>

#include <numeric>

#include "solver/mass_clusters.h"
#include "solver/relax.h"
#include "solver_algebra.h"
#include "solver_stiffness.h"

using namespace trocar;

namespace {

constexpr double cell = .01;

// A block of tetrahedra in which two inner nodes were moved close to a neighbour, or one of
// hexahedra with a thin layer.
Mesh block_with_slivers(BoxElements elements) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(6, 3, 3) * cell, {6, 3, 3}, elements);
  for (Vec3& X : mesh.X) {
    const bool is_moved =
        elements == BoxElements::hex8
            ? std::abs(X.x() - cell) < 1e-6
            : (X - Vec3(1, 1, 1) * cell).norm() < 1e-6 || (X - Vec3(4, 2, 1) * cell).norm() < 1e-6;
    if (is_moved) X.x() += .97 * cell;
  }
  return mesh;
}

double median_step(const Body& body) {
  std::vector<double> steps = body.model.element_step;
  std::nth_element(steps.begin(), steps.begin() + std::ssize(steps) / 2, steps.end());
  return steps[steps.size() / 2];
}

MassScaling scaling_of(const Body& body, double wanted_step) {
  return find_mass_scaling(body.mesh, body.materials, body.model.options, wanted_step);
}

constexpr double wanted_share = .8;  // of the median element's step

Body scaled(const Body& body) {
  Body result = body;
  scale_mass(scaling_of(body, wanted_share * median_step(body)), body.part, result.model);
  return result;
}

// M column by column, as the head of mass_scaling.h writes it.
Eigen::MatrixXd dense_mass(const Model& model) {
  const auto n = static_cast<Eigen::Index>(model.mass.size());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) M(i, i) = model.mass[i];
  const MassClusters& clusters = model.clusters;
  for (std::size_t c = 0; c + 1 < clusters.offset.size(); ++c) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
    for (std::int32_t k = clusters.offset[c]; k < clusters.offset[c + 1]; ++k)
      d[clusters.node[k]] = clusters.added[k];
    M += Eigen::MatrixXd(d.asDiagonal()) - d * d.transpose() / d.sum();
  }
  return M;
}

std::vector<double> times_mass(const Model& model, const std::vector<double>& x) {
  std::vector<double> Mx(3 * model.mass.size());
  for (std::size_t k = 0; k < Mx.size(); ++k) Mx[k] = inertia_of(model)[k / 3] * x[k];
  subtract_cluster_means(model, x, Mx);
  return Mx;
}

// 2 / omega_max of K x = omega^2 M x.
double dense_limit(Body& body) {
  const Eigen::MatrixXd K = tangent_stiffness(body, 1e-7), m = dense_mass(body.model);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(K.rows(), K.cols());
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      for (int a = 0; a < 3; ++a) M(3 * i + a, 3 * j + a) = m(i, j);
  return 2 / std::sqrt(eigenvalues(K, M).maxCoeff());
}

constexpr BoxElements kinds[] = {BoxElements::tet4_kuhn, BoxElements::hex8};

}  // namespace

TEST(MassScaling, gives_a_body_with_slivers_the_wanted_step) {
  for (const BoxElements kind : kinds) {
    Body body = make_body(block_with_slivers(kind)), heavy = scaled(body);
    const double wanted = wanted_share * median_step(body);
    const double before = dense_limit(body), after = dense_limit(heavy);
    const MassScaling scaling = scaling_of(body, wanted);
    std::printf("step %.2f times as long, %.2f of wanted; %zu of %d elements, %.2f of the mass\n",
                after / before, after / wanted, scaling.element.size(), body.mesh.n_elements(),
                sum(scaling.added) / sum(body.mass));
    EXPECT_LT(before, wanted);
    EXPECT_GE(after, wanted * (1 - 1e-6));  // differences of forces
    EXPECT_GE(look(heavy).stable_step, wanted * (1 - 1e-15));
  }
}

TEST(MassScaling, adds_what_the_steps_of_the_elements_ask_for) {
  const Body body = make_body(block_with_slivers(BoxElements::tet4_kuhn));
  const double wanted = wanted_share * median_step(body);
  const MassScaling scaling = scaling_of(body, wanted);
  double expected = 0;
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
    const double beta = std::pow(wanted / body.model.element_step[e], 2) - 1;
    const double mass = body.materials[0].density * element_volume(body.mesh, e, body.mesh.X);
    expected += mass * std::max(0., beta);
  }
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(sum(scaling.added), expected, 1e-12 * expected);
  // In the model it is inertia on top of the mass; two slivers' surroundings, two clusters.
  const Model model = scaled(body).model;
  EXPECT_NEAR(sum(inertia_of(model)) - sum(model.mass), expected, 1e-12 * sum(inertia_of(model)));
  EXPECT_EQ(model.mass, body.model.mass);
  EXPECT_EQ(scaling.n_clusters(), 2);
}

TEST(MassScaling, of_a_step_that_all_elements_have_changes_nothing) {
  const Body body = make_body(block_with_slivers(BoxElements::hex8));
  const MassScaling none = scaling_of(body, .99 * least_element_step(body));
  EXPECT_EQ(none.n_clusters(), 0);
  EXPECT_EQ(largest(none.added), 0);
  EXPECT_TRUE(none.element.empty());
}

TEST(MassScaling, leaves_free_fall_as_it_is) {
  const Body body = make_body(block_with_slivers(BoxElements::tet4_kuhn),
                              {.solver = {.mass_damping = 3, .gravity = Vec3(1, -2, -9.81)}});
  Body light = body, heavy = scaled(body);
  const double dt = .5 * least_element_step(body);
  for (int k = 0; k < 200; ++k) {
    step(light, dt);
    step(heavy, dt);
  }
  // Rounding of 200 steps.
  EXPECT_LE(largest_difference(heavy.state.u, light.state.u), 1e-13 * largest(light.state.u));
}

TEST(MassScaling, leaves_the_equilibrium_as_it_is) {
  BodyOptions options{.solver = {.gravity = Vec3(0, 0, -9.81)}};
  const Mesh mesh = block_with_slivers(BoxElements::tet4_kuhn);
  for (const Vec3& X : mesh.X) options.fixed.push_back(X.x() < 1e-9 ? 7 : 0);
  Body light = make_body(mesh, options), heavy = scaled(light);
  EXPECT_TRUE(relax(light.model, {.tolerance = 1e-11}, light.state, light.scratch).is_converged);
  EXPECT_TRUE(relax(heavy.model, {.tolerance = 1e-11}, heavy.state, heavy.scratch).is_converged);
  const double deflection = largest(light.state.u);
  // Two residuals of 1e-11.
  EXPECT_LE(largest_difference(heavy.state.u, light.state.u), 1e-8 * deflection);
  // And it stays there: forces out of balance of 1e-11 of the weight do nothing in 100 steps.
  const std::vector<double> u = heavy.state.u;
  for (int k = 0; k < 100; ++k) step(heavy, .5 * least_element_step(heavy));
  EXPECT_LE(largest_difference(heavy.state.u, u), 1e-8 * deflection);
}

TEST(MassScaling, keeps_energy_and_momentum_at_the_wanted_step) {
  Body body = scaled(make_body(block_with_slivers(BoxElements::tet4_kuhn),
                               {.materials = {{MaterialModel::linear, 3000, .4, 1000}}}));
  shake(body.state.v, .1, 7);
  const double dt = .85 * least_element_step(body);
  const auto momentum = [&] {
    Vec3 p = Vec3::Zero();
    for (std::size_t i = 0; i < body.mass.size(); ++i)
      p += body.mass[i] * Vec3::Map(&body.state.v[3 * i]);
    return p;
  };
  // 1/2 v- M v+ + W is constant for linear bodies (numerics 1.1).
  const auto energy_around_step = [&] {
    const double stored = stored_energy(body);
    const std::vector<double> Mv = times_mass(body.model, body.state.v);
    step(body, dt);
    return stored + .5 * std::inner_product(Mv.begin(), Mv.end(), body.state.v.begin(), 0.);
  };
  step(body, dt);
  const Vec3 p = momentum();
  const double energy = energy_around_step();
  for (int k = 0; k < 3000; ++k) step(body, dt);
  EXPECT_NEAR(energy_around_step(), energy, 1e-10 * energy);
  EXPECT_LT((momentum() - p).norm(), 1e-12 * sum(body.mass) * .1);  // 3000 roundings
}

TEST(MassScaling, has_kinetic_energy_in_the_sense_of_its_matrix) {
  Body body = scaled(make_body(block_with_slivers(BoxElements::hex8)));
  shake(body.state.v, .1, 8);
  const std::vector<double> Mv = times_mass(body.model, body.state.v);
  std::vector<double> kinetic(body.mass.size());
  for (std::size_t k = 0; k < Mv.size(); ++k)
    kinetic[k / 3] += .5 * body.model.mass[k / 3] * body.state.v[k] * body.state.v[k];
  add_cluster_squares(body.model, body.state.v, 0.5, kinetic);
  const double expected = .5 * std::inner_product(Mv.begin(), Mv.end(), body.state.v.begin(), 0.);
  EXPECT_NEAR(sum(kinetic), expected, 1e-13 * expected);
}

TEST(MassScaling, is_inverted_in_closed_form_with_fixed_and_given_nodes) {
  BodyOptions options;
  const Mesh mesh = block_with_slivers(BoxElements::tet4_kuhn);
  // Some nodes of the first cluster hold x, one holds all; cells of its sliver are .01 wide.
  for (const Vec3& X : mesh.X)
    options.fixed.push_back(X.x() < .5 * cell ? 1 : X.norm() < 2.1 * cell && X.z() < 1e-9 ? 7 : 0);
  const Body body = scaled(make_body(mesh, options));
  const Model& model = body.model;
  std::vector<double> a(body.state.u.size(), 0.0);
  shake(a, 1, 9);
  for (std::size_t k = 0; k < a.size(); ++k)
    if ((model.fixed[k / 3] >> k % 3 & 1) != 0) a[k] = 0;
  std::vector<double> f = times_mass(model, a), sums;
  // The dense matrix agrees.
  const Eigen::MatrixXd M = dense_mass(model);
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    double Ma = 0;
    for (Eigen::Index j = 0; j < M.cols(); ++j) Ma += M(i, j) * a[3 * j];
    EXPECT_NEAR(f[3 * i], Ma, 1e-13 * M.maxCoeff());
  }
  std::vector<GivenAcceleration> given;
  for (const std::int32_t node : {model.clusters.node[1], model.clusters.node.back()}) {
    given.push_back({.node = node, .a = Vec3::Map(&a[3 * node])});
    for (int j = 0; j < 3; ++j) f[3 * node + j] = 77;  // counts for nothing
  }
  for (std::size_t k = 0; k < f.size(); ++k)
    if ((model.fixed[k / 3] >> k % 3 & 1) != 0) f[k] = -33;  // nor does that
  add_cluster_force(model, given, f, sums);
  const auto is_given = [&](std::size_t i) {
    return std::any_of(given.begin(), given.end(), [&](const GivenAcceleration& g) {
      return static_cast<std::size_t>(g.node) == i;
    });
  };
  for (std::size_t k = 0; k < f.size(); ++k)
    if (!is_given(k / 3) && (model.fixed[k / 3] >> k % 3 & 1) == 0) {
      // The nodes with 77 N enter and leave the sums: their rounding over the masses of 1e-4 kg.
      EXPECT_NEAR(f[k] / inertia_of(model)[k / 3], a[k], 1e-9) << k;
    }
}

TEST(MassScaling, a_held_node_of_a_cluster_goes_where_it_is_led_and_its_holder_bears_the_rest) {
  const double alpha = 3;
  Body body = scaled(make_body(block_with_slivers(BoxElements::tet4_kuhn),
                               {.solver = {.mass_damping = alpha, .gravity = Vec3(1, -2, -9)}}));
  const Model& model = body.model;
  shake(body.state.v, .1, 11);
  const double dt = .5 * least_element_step(body);
  step(body, dt);  // velocities lie between the steps from now on
  std::vector<PrescribedNode> held;
  for (const std::int32_t node : {model.clusters.node[1], model.clusters.node.back()})
    held.push_back(
        {.node = node, .u_next = Vec3::Map(&body.state.u[3 * node]) + Vec3(1, 2, 3) * 1e-5});
  std::vector<double> expected = force(body), v = body.state.v;
  integrate(model, body.scratch, held, dt, body.state);
  for (const PrescribedNode& node : held)
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(body.state.u[3 * node.node + j], node.u_next[j], 1e-17);  // rounding of 1e-5
      expected[3 * node.node + j] += node.reaction[j];
    }
  // M (v+ - v) / dt + alpha M (v+ + v) / 2 = f + R at all nodes.
  std::vector<double> a(v.size());
  for (std::size_t k = 0; k < v.size(); ++k)
    a[k] = (body.state.v[k] - v[k]) / dt + alpha * (body.state.v[k] + v[k]) / 2;
  // v / dt over a: 1e3 roundings.
  EXPECT_LE(largest_difference(times_mass(model, a), expected), 1e-11 * largest(expected));
}

TEST(MassScaling, gives_each_cluster_one_owner_and_a_rank_the_same_bits) {
  const Mesh mesh = block_with_slivers(BoxElements::tet4_kuhn);
  const Body whole = scaled(make_body(mesh));
  const MassScaling scaling = scaling_of(whole, wanted_share * median_step(make_body(mesh)));
  std::vector<std::int32_t> owner(mesh.X.size());
  for (std::size_t i = 0; i < owner.size(); ++i) owner[i] = static_cast<std::int32_t>(i % 3);
  keep_clusters_whole(scaling, owner);
  for (int rank = 0; rank < 3; ++rank) {
    Body part = make_body(mesh, {}, owner, rank);
    scale_mass(scaling, part.part, part.model);
    for (std::int32_t i = 0; i < part.model.n_owned; ++i)
      EXPECT_EQ(inertia_of(part.model)[i], inertia_of(whole.model)[part.part.node_global[i]]);
    for (std::size_t k = 0; k < part.part.element_global.size(); ++k)
      EXPECT_EQ(part.model.element_step[k], whole.model.element_step[part.part.element_global[k]]);
  }
}
