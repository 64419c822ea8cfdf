// Local time steps: what they replace, that they are stable up to the limit they state, and what
// error they bring.
#include "solver/multirate.h"

#include <gtest/gtest.h>

#include "solver/frequency.h"
#include "solver_stiffness.h"

using namespace trocar;

namespace {

// A block of 10 mm cells with one layer an eighth as thick, or with one node close to a facet.
Mesh with_thin_layer(BoxElements elements) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.10, .03, .03), {10, 3, 3}, elements);
  for (Vec3& X : mesh.X)
    if (X.x() > .015) X.x() -= .00875;  // all behind the second plane of nodes
  return mesh;
}

Mesh with_sliver(BoxElements elements) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.05, .04, .04), {5, 4, 4}, elements);
  jitter(mesh, .1, 5);
  const auto near = [](const Vec3& X) { return (X - Vec3(.03, .02, .02)).norm(); };
  auto node = std::min_element(mesh.X.begin(), mesh.X.end(),
                               [&](const Vec3& a, const Vec3& b) { return near(a) < near(b); });
  node->x() += .008;
  return mesh;
}

std::vector<Mesh> meshes() {
  return {with_thin_layer(BoxElements::hex8), with_thin_layer(BoxElements::tet4_kuhn),
          with_sliver(BoxElements::tet4_kuhn), with_sliver(BoxElements::tet4_five)};
}

struct Refined {
  Body body;
  Communicator alone;
  MultiRatePlan plan;
  std::unique_ptr<MultiRate> multirate;

  explicit Refined(const Mesh& mesh) : body(make_body(mesh)) {
    plan =
        plan_multirate(body.mesh, resting_elements(body.mesh, body.materials, body.model.options));
    multirate = make_multirate(plan,
                               {.mesh = body.mesh,
                                .materials = body.materials,
                                .node_owner = std::vector<std::int32_t>(body.mesh.X.size(), 0),
                                .part = body.part,
                                .model = body.model},
                               alone);
  }
  const std::vector<double>& refined_force(double dt) {
    force(body);
    refine_force({.model = body.model, .state = body.state, .dt = dt}, *multirate, body.scratch);
    return body.scratch.force;
  }
  // M^-1/2 K M^-1/2 of the forces F(u) (dt = 0) or F~(u).
  Eigen::MatrixXd operator_of(double dt) {
    const auto n = static_cast<Eigen::Index>(body.state.u.size());
    const double h = 1e-7;
    Eigen::MatrixXd A(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      std::vector<double> f[2];
      for (const int side : {0, 1}) {
        body.state.u[static_cast<std::size_t>(k)] += side == 0 ? h : -h;
        f[side] = dt > 0 ? refined_force(dt) : force(body);
        body.state.u[static_cast<std::size_t>(k)] -= side == 0 ? h : -h;
      }
      for (Eigen::Index i = 0; i < n; ++i)
        A(i, k) = (f[1][static_cast<std::size_t>(i)] - f[0][static_cast<std::size_t>(i)]) /
                  (2 * h * std::sqrt(mass(i) * mass(k)));
    }
    return A;
  }
  double mass(Eigen::Index k) const { return body.model.inertia[static_cast<std::size_t>(k / 3)]; }
};

double highest(const Eigen::MatrixXd& A) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues().maxCoeff());
}

// The step that a multi-rate body is said to bear, from dense eigenvalues.
double stated_limit(Refined& refined) {
  Eigen::MatrixXd A = refined.operator_of(0);
  const double all = highest(A);
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < A.rows(); ++j)
      if (refined.plan.is_fine[static_cast<std::size_t>(i / 3)] != 0 ||
          refined.plan.is_fine[static_cast<std::size_t>(j / 3)] != 0)
        A(i, j) = 0;
  std::printf("p %d: %zu of %d elements, single-rate limit %.4g ms, coarse %.4g ms, fine %.4g ms\n",
              refined.plan.n_substeps, refined.plan.element.size(), refined.body.mesh.n_elements(),
              2e3 / all, 2e3 / highest(A), 1e3 * refined.multirate->steps.limit / all);
  return std::min(2 / highest(A), refined.multirate->steps.limit / all);
}

TEST(LocalSteps, of_one_are_a_step_of_central_differences) {
  const LocalSteps one = local_steps(1);
  ASSERT_EQ(one.gain.size(), 1u);
  EXPECT_DOUBLE_EQ(one.gain[0], .5);  // z_1 = dt^2 a / 2, F~ = 2 M z_1 / dt^2 = F
}

// 1 - dt^2 A~ / 2 = T_p(d - x / w) / T_p(d) with x = dt^2 omega^2, all elements fine.
TEST(LocalSteps, of_one_oscillator_are_damped_chebyshev_polynomials) {
  for (const int p : {2, 4, 8}) {
    const LocalSteps steps = local_steps(p);
    const auto z_p = [&](double x) {  // a = -omega^2 (1 + z), dt = 1, u = 1
      double z = 0, before = 0;
      for (std::size_t k = 0; k < steps.back.size(); ++k) {
        const double next =
            (1 + steps.back[k]) * z - steps.back[k] * before - steps.gain[k] * x * (1 + z);
        before = z;
        z = next;
      }
      return z;
    };
    const double x_most = steps.limit * steps.limit;
    for (int k = 0; k <= 1000; ++k) {
      const double cosine = 1 + z_p(x_most * k / 1000);  // cos(omega~ dt): stable within [-1, 1]
      EXPECT_LE(std::abs(cosine), 1 + 1e-12) << p << " " << k;
      if (k > 20 && k < 980) {
        EXPECT_LT(std::abs(cosine), .99) << p << " " << k;  // nowhere marginal
      }
    }
    EXPECT_GT(std::abs(1 + z_p(1.02 * x_most)), 1) << "the limit is not idle";
    EXPECT_NEAR(z_p(1e-4) / 1e-4, -.5, 1e-5);  // second order: F~ = F at small steps
    EXPECT_GT(steps.limit, 1.9 * p);           // nearly p times the single step's 2
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

TEST(MultiRate, force_far_from_small_elements_is_left_alone_and_rigid_motion_makes_none) {
  for (const Mesh& mesh : meshes()) {
    Refined refined(mesh);
    shake(refined.body.state.u, 1e-4, 3);
    const std::vector<double> plain = force(refined.body);
    const std::vector<double> with = refined.refined_force(1e-4);
    bool is_changed = false;
    for (std::size_t k = 0; k < plain.size(); ++k)
      if (refined.multirate->of_whole[k / 3] < 0) {
        EXPECT_EQ(with[k], plain[k]);
      } else {
        is_changed |= with[k] != plain[k];
      }
    EXPECT_TRUE(is_changed);
    // Both sum to zero: there is no load.
    double sum = 0, size = 0;
    for (std::size_t k = 0; k < with.size(); k += 3) sum += with[k], size += std::abs(with[k]);
    EXPECT_LT(std::abs(sum), 1e-12 * size);
  }
}

// Stable in the linear sense: dt^2 A~ is symmetric and has its eigenvalues in [0, 4].
TEST(MultiRate, is_stable_at_any_step_up_to_the_stated_limit) {
  for (const Mesh& mesh : meshes()) {
    Refined refined(mesh);
    const double limit = stated_limit(refined);
    for (const double share : {.4, .8, .9, 1 / frequency_margin}) {
      const double dt = share * limit;
      const Eigen::MatrixXd A = dt * dt * refined.operator_of(dt);
      EXPECT_LT((A - A.transpose()).cwiseAbs().maxCoeff(), 1e-5);
      const auto eigen = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues();
      EXPECT_GT(eigen.minCoeff(), -1e-5) << share;  // differences of forces
      EXPECT_LT(eigen.maxCoeff(), 4) << share;
      std::printf("%.1f of the limit: eigenvalues %.2g to %.3f\n", share, eigen.minCoeff(),
                  eigen.maxCoeff());
    }
  }
}

double energy_of(Refined& refined) {
  double kinetic = 0;
  for (std::size_t k = 0; k < refined.body.state.v.size(); ++k)
    kinetic += .5 * refined.mass(static_cast<Eigen::Index>(k)) * refined.body.state.v[k] *
               refined.body.state.v[k];
  return kinetic + stored_energy(refined.body);
}

void run(Refined& refined, double dt, std::int64_t n) {
  for (std::int64_t k = 0; k < n; ++k) {
    refined.refined_force(dt);
    integrate(refined.body.model, refined.body.scratch, {}, dt, refined.body.state);
  }
}

TEST(MultiRate, long_run_of_a_shaken_body_at_nine_tenths_of_the_limit_gains_no_energy) {
  for (const Mesh& mesh : meshes()) {
    Refined refined(mesh);
    const double dt = .9 * stated_limit(refined);
    shake(refined.body.state.v, 1e-3, 11);
    double first = 0, last = 0;  // means over 100 steps: the sum swings by omega dt / 2
    for (int k = 0; k < 100; ++k, run(refined, dt, 1)) first += energy_of(refined) / 100;
    run(refined, dt, 10000);
    for (int k = 0; k < 100; ++k, run(refined, dt, 1)) last += energy_of(refined) / 100;
    std::printf("energy after 10,000 steps: %+.3f %%\n", 100 * (last / first - 1));
    EXPECT_LT(std::abs(last / first - 1), .1);
  }
}

// Against small single steps, at the same time.
TEST(MultiRate, error_falls_with_the_square_of_the_step) {
  for (const Mesh& mesh : meshes()) {
    Refined reference(mesh), coarse(mesh), fine(mesh);
    const double dt = .15 * stated_limit(coarse);
    const auto start = [](Body& body) {
      displace(body, [](const Vec3& X) { return Vec3(.02 * X.x(), 0, -.01 * X.z()); });
    };
    for (Refined* refined : {&reference, &coarse, &fine}) start(refined->body);
    const std::int64_t n = 100;
    for (std::int64_t k = 0; k < 20 * n; ++k) {
      force(reference.body);
      integrate(reference.body.model, reference.body.scratch, {}, dt / 20, reference.body.state);
    }
    run(coarse, dt, n);
    run(fine, dt / 2, 2 * n);
    double of_coarse = 0, of_fine = 0;
    for (std::size_t k = 0; k < coarse.body.state.u.size(); ++k) {
      const double exact = reference.body.state.u[k];
      of_coarse = std::max(of_coarse, std::abs(coarse.body.state.u[k] - exact));
      of_fine = std::max(of_fine, std::abs(fine.body.state.u[k] - exact));
    }
    std::printf("error %.3g mm, with half the step %.3g mm\n", 1e3 * of_coarse, 1e3 * of_fine);
    EXPECT_GT(of_coarse / of_fine, 3);
    EXPECT_LT(of_fine, .05 * .02 * .1);  // of the motion
  }
}

}  // namespace
