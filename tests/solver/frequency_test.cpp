// The highest frequency from forces alone, against the eigenvalues of the assembled stiffness, the
// measured limits of numerics 1.5 and the step at which a body really becomes unstable.
#include "solver/frequency.h"

#include <gtest/gtest.h>

#include "solver_algebra.h"
#include "solver_stiffness.h"

using namespace trocar;

namespace {

HighestFrequency search(Body& body, double tolerance = .01, int most = 100) {
  return search_frequency(body, {.tolerance = tolerance, .most_iterations = most});
}

Mesh cube_mesh(BoxElements elements, int n, double irregularity) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.1, .1, .1), {n, n, n}, elements);
  jitter(mesh, irregularity, 5);
  return mesh;
}

TEST(HighestFrequency, agrees_with_the_eigenvalues_of_the_assembled_stiffness) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn})
    for (const double irregularity : {0., .2})
      for (const double strain : {0., 3e-3}) {
        Body body = make_body(cube_mesh(elements, 4, irregularity));
        shake(body.state.u, strain, 3);
        const double omega = 2 / true_limit(body, 1e-7);
        EXPECT_NEAR(search(body, 1e-6, 300).omega / omega, 1, 1e-6);  // differences of 1e-9 m
        // Stopped early it lies below, by less than the margin that callers leave.
        const HighestFrequency early = search(body);
        std::printf("stopped after %d iterations at %.4f of it, residual %.3f\n",
                    early.n_iterations, early.omega / omega, early.residual);
        EXPECT_TRUE(early.is_converged);
        EXPECT_LT(early.omega / omega, 1 + 1e-6);
        EXPECT_GT(early.omega / omega, 1 / frequency_margin);
      }
}

// Of distorted bodies, every other one with a sliver, whose mode is far above the others.
TEST(HighestFrequency, that_is_below_what_is_of_interest_ends_the_search_early) {
  double n_early = 0, n_full = 0;
  for (int k = 0; k < 40; ++k) {
    Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.1, .1, .1), {4, 4, 4}, BoxElements::tet4_kuhn);
    jitter(mesh, .05 * (k % 5), static_cast<unsigned>(k));
    if (k % 2 == 1) {
      const auto c = mesh.corners(37 * k % mesh.n_elements());
      Vec3& X = mesh.X[c[0]];
      X += .3 * (mesh.X[c[1]] - X);
    }
    Body body = make_body(mesh);
    shake(body.state.u, 1e-3 * (k % 3), static_cast<unsigned>(k));
    const double omega = search(body, 1e-4, 1000).omega;
    // What is above it is found as if nothing else were of interest.
    for (const double part : {.9, .95, .97, .98})
      EXPECT_GT(search_frequency(body, {.of_interest = part * omega}).omega, part * omega);
    const HighestFrequency early = search_frequency(body, {.of_interest = 1.2 * omega});
    EXPECT_TRUE(early.is_converged);
    EXPECT_LT(early.omega, 1.2 * omega);
    n_early += early.n_iterations;
    n_full += search(body).n_iterations;
  }
  std::printf("%.1f iterations, %.1f where all is of interest\n", n_early / 40, n_full / 40);
  EXPECT_LT(n_early, n_full / 2);
}

TEST(HighestFrequency, of_a_block_of_cubes_is_the_known_one) {
  // dt in units of h / c_d (numerics 1.5: 8 cells and more along an edge).
  const std::vector<std::pair<double, double>> known = {
      {0, 1}, {.3, .981}, {.45, .894}, {.49, .860}, {.499, .853}};
  for (const auto& [nu, steps] : known) {
    const Material material{MaterialModel::neo_hookean, 3000, nu, 1000};
    Body body = make_body(cube_mesh(BoxElements::hex8, 10, 0), {.materials = {material}});
    const double c_d = std::sqrt((bulk_modulus(material) + 4. / 3 * lame_mu(material)) / 1000);
    const HighestFrequency found = search(body, 1e-3, 200);
    EXPECT_TRUE(found.is_converged);
    const double courant = 2 / found.omega * c_d / .01;
    std::printf("nu %.3f: limit %.4f h/c_d (known %.3f), bound %.4f, %d iterations\n", nu, courant,
                steps, least_element_step(body) * c_d / .01, found.n_iterations);
    EXPECT_NEAR(courant, steps, .008);  // the known ones are of other block sizes
  }
}

TEST(HighestFrequency, is_not_found_of_forces_that_are_not_finite) {
  Body body = make_body(cube_mesh(BoxElements::hex8, 2, 0), {});
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e300}) {
    const auto forces = [&](const std::vector<double>&, std::vector<double>& force) {
      force.assign(body.scratch.force.size(), bad);
      force[3] = -bad;
    };
    std::vector<double> at_rest(body.scratch.force.size(), 0.0);
    const HighestFrequency found = find_highest_frequency(body.model, body.part, body.state, forces,
                                                          {.force = at_rest}, Communicator());
    EXPECT_FALSE(found.is_converged) << bad;
  }
}

TEST(HighestFrequency, leaves_supported_components_out) {
  const Mesh mesh = cube_mesh(BoxElements::tet4_kuhn, 2, .2);
  Body body = make_body(mesh, {.fixed = std::vector<FixedMask>(mesh.X.size(), 5)});  // x and z
  Eigen::MatrixXd K = tangent_stiffness(body, 1e-7);
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    for (Eigen::Index j = 0; j < K.cols(); ++j)
      K(i, j) = i % 3 == 1 && j % 3 == 1
                    ? K(i, j) / std::sqrt(body.model.mass[i / 3] * body.model.mass[j / 3])
                    : 0;
  const double omega = std::sqrt(eigenvalues(K).maxCoeff());
  EXPECT_NEAR(search(body, 1e-6, 300).omega / omega, 1, 1e-6);
}

TEST(HighestFrequency, of_single_precision_elements_is_within_a_percent) {
  Body body = make_body(cube_mesh(BoxElements::hex8, 4, .2),
                        {.solver = {.precision = Precision::in_single}});
  const double omega = 2 / true_limit(body, 1e-4);
  EXPECT_NEAR(search_frequency(body, {.amplitude = 1e-4, .tolerance = .02}).omega / omega, 1, .01);
}

}  // namespace
