// Local time steps: what they replace, that they are stable up to the limit they state, and what
// error they bring.
#include "solver/multirate.h"

#include <gtest/gtest.h>

#include "solver_algebra.h"
#include "solver_multirate.h"
#include "solver_stiffness.h"

using namespace trocar;

namespace {

std::vector<Mesh> meshes() {
  return {with_thin_layer(BoxElements::hex8), with_thin_layer(BoxElements::tet4_kuhn),
          with_thin_layer(BoxElements::tet4_five), with_sliver(BoxElements::tet4_kuhn)};
}

// M^-1/2 K M^-1/2 of the forces F(u) (dt = 0) or F~(u), by differences.
Eigen::MatrixXd operator_of(Refined& refined, double dt) {
  Body& body = refined.body;
  const auto n = static_cast<Eigen::Index>(body.state.u.size());
  const auto mass = [&](Eigen::Index k) { return inertia_of(body.model)[k / 3]; };
  const double h = 1e-7;
  Eigen::MatrixXd A(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    std::vector<double> f[2];
    for (const int side : {0, 1}) {
      body.state.u[k] += side == 0 ? h : -h;
      f[side] = dt > 0 ? refined_force(refined, dt) : force(body);
      body.state.u[k] -= side == 0 ? h : -h;
    }
    for (Eigen::Index i = 0; i < n; ++i)
      A(i, k) = (f[1][i] - f[0][i]) / (2 * h * std::sqrt(mass(i) * mass(k)));
  }
  return A;
}

// From dense eigenvalues.
double exact_limit(Refined& refined) {
  const Eigen::MatrixXd A = operator_of(refined, 0);
  return stated_limit(refined, [&](const Body& body) {
    Eigen::MatrixXd free = A;
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      if (body.model.fixed[i / 3] != 0) {
        free.row(i).setZero();
        free.col(i).setZero();
      }
    return 2 / std::sqrt(eigenvalues(free).maxCoeff());
  });
}

TEST(LocalSteps, of_one_are_a_step_of_central_differences) {
  const LocalSteps one = local_steps(1);
  ASSERT_EQ(one.gain.size(), 1u);
  EXPECT_DOUBLE_EQ(one.gain[0], .5);  // z_1 = dt^2 a / 2, F~ = 2 M z_1 / dt^2 = F
}

// All elements fine: cos(omega~ dt) = 1 + z_p = T_p(d - x / w) / T_p(d) with x = dt^2 omega^2.
TEST(LocalSteps, of_one_oscillator_stay_out_of_the_third_order_resonance) {
  for (const int p : {2, 4, 8, 16, 32, 64}) {
    const LocalSteps steps = local_steps(p);
    const auto cosine = [&](double x) {  // a = -omega^2 (1 + z), dt = 1, u = 1
      double z = 0, before = 0;
      for (std::size_t k = 0; k < steps.back.size(); ++k) {
        const double next =
            (1 + steps.back[k]) * z - steps.back[k] * before - steps.gain[k] * x * (1 + z);
        before = z;
        z = next;
      }
      return 1 + z;
    };
    const double x_most = steps.limit * steps.limit;
    for (int k = 1; k <= 1000; ++k) {
      EXPECT_GE(cosine(x_most * k / 1000), -4. / 9 - 1e-9) << p << " " << k;
      EXPECT_LT(cosine(x_most * k / 1000), 1) << p << " " << k;
    }
    EXPECT_NEAR(std::abs(cosine(x_most)), 4. / 9, 1e-9);  // |T_p(-1)| / T_p(d)
    EXPECT_GT(std::abs(cosine(1.2 * x_most)), 1) << "the limit is not idle";
    EXPECT_NEAR((cosine(1e-4) - 1) / 1e-4, -.5, 1e-5);  // second order: F~ = F at small steps
    EXPECT_GT(steps.limit, 1.55 * p);                   // of 2 p
  }
}

TEST(MultiRate, plan_takes_the_small_elements_and_what_touches_them) {
  for (const Mesh& mesh : meshes()) {
    const Refined refined(mesh);
    EXPECT_GT(refined.plan.n_substeps, 1);
    EXPECT_LT(refined.plan.element.size(), mesh.element_type.size());
    EXPECT_GE(refined.plan.gain, 1.2);
  }
  const Mesh even = make_box(Vec3(0, 0, 0), Vec3(.04, .03, .03), {4, 3, 3}, BoxElements::hex8);
  EXPECT_EQ(Refined(even).plan.n_substeps, 1);  // nothing to gain
}

TEST(MultiRate, force_far_from_small_elements_is_left_alone_and_all_forces_sum_to_zero) {
  for (const Mesh& mesh : meshes()) {
    Refined refined(mesh);
    shake(refined.body.state.u, 1e-4, 3);
    const std::vector<double> plain = force(refined.body);
    const std::vector<double> with = refined_force(refined, 1e-4);
    bool is_changed = false;
    double sum = 0, size = 0;
    for (std::size_t k = 0; k < plain.size(); ++k) {
      if (refined.multirate->of_whole[k / 3] < 0)
        EXPECT_EQ(with[k], plain[k]);
      else
        is_changed |= with[k] != plain[k];
      if (k % 3 == 0) sum += with[k], size += std::abs(with[k]);
    }
    EXPECT_TRUE(is_changed);
    EXPECT_LT(std::abs(sum), 1e-12 * size);  // rounding of a thousand terms
  }
}

// A held node is not moved by substeps, and its holder feels what the others do meanwhile.
TEST(MultiRate, forces_sum_to_zero_with_held_and_supported_nodes) {
  const Mesh mesh = with_thin_layer(BoxElements::tet4_kuhn);
  std::vector<FixedMask> fixed(mesh.X.size(), 0);
  PrescribedNode held;
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    if (mesh.X[i].x() > .001 && mesh.X[i].x() < .012) held.node = i;  // in the layer
    if (mesh.X[i].x() < .001) fixed[i] = 7;
  }
  Refined refined(mesh, {.fixed = fixed});
  ASSERT_EQ(refined.plan.is_fine[held.node], 1);
  shake(refined.body.state.u, 1e-4, 3);
  const std::vector<double> free = refined_force(refined, 2e-3);
  const std::vector<double> with = refined_force(refined, 2e-3, {&held, 1});
  EXPECT_NE(with, free);
  for (const std::vector<double>& f : {free, with}) {
    double sum = 0, size = 0;
    for (std::size_t k = 0; k < f.size(); k += 3) sum += f[k], size += std::abs(f[k]);
    EXPECT_LT(std::abs(sum), 1e-12 * size);
  }
}

// dt^2 A~ is symmetric and has its eigenvalues in [0, 4]; below 3 at the default step, so that no
// mode is in the third-order resonance (docs/stability.md).
void expect_stable(const Mesh& mesh) {
  Refined refined(mesh);
  ASSERT_GT(refined.plan.n_substeps, 1);
  const double limit = exact_limit(refined);
  for (const double share : {.4, .7, .85, 1 / 1.02}) {
    const double dt = share * limit;
    const Eigen::MatrixXd A = dt * dt * operator_of(refined, dt);
    EXPECT_LT((A - A.transpose()).cwiseAbs().maxCoeff(), 1e-5);  // differences of forces
    const Eigen::VectorXd eigen = eigenvalues(A);
    EXPECT_GT(eigen.minCoeff(), -1e-5) << share;
    EXPECT_LT(eigen.maxCoeff(), share > .85 ? 4 : 3) << share;
    std::printf("p %d, %.2f of the limit: eigenvalues %.2g to %.3f\n", refined.plan.n_substeps,
                share, eigen.minCoeff(), eigen.maxCoeff());
  }
}

TEST(MultiRate, is_stable_at_any_step_up_to_the_stated_limit) {
  for (const Mesh& mesh : meshes()) expect_stable(mesh);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    expect_stable(with_sliver(BoxElements::tet4_kuhn, seed));
  }
}

// Shear strains of 0.05 and noise; bench/stability does it for 100,000 steps.
TEST(MultiRate, large_vibration_at_the_default_step_keeps_its_energy) {
  for (const Mesh& mesh : meshes()) {
    Refined refined(mesh);
    const double dt = .85 * exact_limit(refined);
    for (std::size_t i = 0; i < mesh.X.size(); ++i)
      refined.body.state.v[3 * i + 2] = .05 * std::cos(M_PI / .03 * mesh.X[i].y());
    shake(refined.body.state.v, .01, 11);
    double first = 0, last = 0;  // means: the stored energy is not quite that of F~
    for (int k = 0; k < 1000; ++k) first += refined_step_and_measure(refined, dt);
    for (int k = 0; k < 3000; ++k) refined_step(refined, dt);
    for (int k = 0; k < 1000; ++k) last += refined_step_and_measure(refined, dt);
    std::printf("energy after 5,000 steps: %+.3f %%\n", 100 * (last / first - 1));
    EXPECT_LT(std::abs(last / first - 1), .01);
  }
}

// Against small single steps, at the same time.
TEST(MultiRate, error_falls_with_the_square_of_the_step) {
  for (const Mesh& mesh : meshes()) {
    Refined reference(mesh), coarse(mesh), fine(mesh);
    const double dt = .15 * exact_limit(coarse);
    for (Refined* refined : {&reference, &coarse, &fine})
      displace(refined->body, [](const Vec3& X) { return Vec3(.02 * X.x(), 0, -.01 * X.z()); });
    const std::int64_t n = 100;
    for (std::int64_t k = 0; k < 20 * n; ++k) {
      force(reference.body);
      integrate(reference.body.model, reference.body.scratch, {}, dt / 20, reference.body.state);
    }
    for (std::int64_t k = 0; k < n; ++k) refined_step(coarse, dt);
    for (std::int64_t k = 0; k < 2 * n; ++k) refined_step(fine, dt / 2);
    const std::vector<double>& exact = reference.body.state.u;
    const double of_coarse = largest_difference(coarse.body.state.u, exact),
                 of_fine = largest_difference(fine.body.state.u, exact);
    std::printf("error %.3g mm, with half the step %.3g mm\n", 1e3 * of_coarse, 1e3 * of_fine);
    EXPECT_GT(of_coarse / of_fine, 3);   // 4 but for third-order terms
    EXPECT_LT(of_fine, .05 * .02 * .1);  // of the motion
  }
}

}  // namespace
