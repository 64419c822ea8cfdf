// The nodes' loops of a step for every instruction set that this machine has.
#include <gtest/gtest.h>

#include "solver_body.h"

using namespace trocar;

namespace {

constexpr int n_nodes = 37;  // no multiple of any register

struct Nodes {
  std::vector<double> inertia, force, v, u;
  std::vector<std::uint8_t> fixed;
};

Nodes random_nodes() {
  Nodes nodes;
  Noise noise(7);
  for (int i = 0; i < n_nodes; ++i) {
    nodes.inertia.push_back(2 + noise());
    nodes.fixed.push_back(static_cast<std::uint8_t>(i % 5 == 0 ? i % 8 : 0));
    for (int j = 0; j < 3; ++j) {
      nodes.force.push_back(noise());
      nodes.v.push_back(noise());
      nodes.u.push_back(noise());
    }
  }
  return nodes;
}

NodeMotion motion_of(Nodes& nodes) {
  return {.keep = .99,
          .gain = .013,
          .dt = .0071,
          .inertia = nodes.inertia.data(),
          .fixed = nodes.fixed.data(),
          .force = nodes.force.data(),
          .v = nodes.v.data(),
          .u = nodes.u.data()};
}

template <class Check>
void for_each_simd(const Check& check) {
  for (int i = 0; i < n_simd; ++i) {
    const auto simd = static_cast<Simd>(i);
    if (!is_supported(simd)) continue;
    SCOPED_TRACE(name_of(simd));
    check(kernels_of(simd).nodes);
  }
}

}  // namespace

// v+ = keep v + gain f / m, held components at rest, u+ = u + dt v+; numbers of order 1, of which
// three operations are off by a few units in the last place.
TEST(NodeKernels, free_nodes_accelerate_and_held_ones_stay) {
  for_each_simd([](const NodeKernels& kernels) {
    const Nodes before = random_nodes();
    Nodes after = before;
    kernels.motion(motion_of(after), 0, n_nodes);
    for (std::size_t k = 0; k < 3 * n_nodes; ++k) {
      const bool is_held = (before.fixed[k / 3] >> k % 3 & 1) != 0;
      const double v =
          is_held ? 0 : .99 * before.v[k] + .013 * before.force[k] / before.inertia[k / 3];
      EXPECT_NEAR(after.v[k], v, 4e-16);
      EXPECT_NEAR(after.u[k], before.u[k] + .0071 * v, 4e-16);
    }
  });
}

// Threads and ranks part the nodes anywhere.
TEST(NodeKernels, a_node_moves_by_the_same_bits_whatever_part_it_is_in) {
  for_each_simd([](const NodeKernels& kernels) {
    Nodes whole = random_nodes(), parts = whole;
    kernels.motion(motion_of(whole), 0, n_nodes);
    for (const auto& [begin, end] : {std::pair{0, 5}, {5, 18}, {18, 19}, {19, n_nodes}})
      kernels.motion(motion_of(parts), begin, end);
    EXPECT_EQ(whole.v, parts.v);
    EXPECT_EQ(whole.u, parts.u);
  });
}

// u stands for the velocity after the step; numbers of order 1.
TEST(NodeKernels, works_are_those_of_middle_velocities_by_the_same_bits_in_any_part) {
  for_each_simd([](const NodeKernels& kernels) {
    const Nodes nodes = random_nodes();
    struct Works {
      std::vector<double> v, swept, work;
    };
    const Works start{nodes.v, nodes.inertia, nodes.force};
    const auto add = [&](Works& w, std::size_t begin, std::size_t end) {
      kernels.works({.dt = .3,
                     .after = nodes.u.data() + begin,
                     .force = nodes.force.data() + begin,
                     .v = w.v.data() + begin,
                     .swept = w.swept.data() + begin,
                     .work = w.work.data() + begin},
                    static_cast<std::int64_t>(end - begin));
    };
    Works whole = start, parts = start;
    for (Works* w : {&whole, &parts}) w->swept.resize(3 * n_nodes, .5);
    for (std::size_t k = 0; k < 3 * n_nodes; k += 13)
      add(parts, k, std::min<std::size_t>(k + 13, 3 * n_nodes));
    const std::vector<double> before = whole.swept;
    add(whole, 0, 3 * n_nodes);
    EXPECT_EQ(whole.v, parts.v);
    EXPECT_EQ(whole.swept, parts.swept);
    EXPECT_EQ(whole.work, parts.work);
    for (std::size_t k = 0; k < 3 * n_nodes; ++k) {
      const double v = (nodes.v[k] + nodes.u[k]) / 2;
      EXPECT_EQ(whole.v[k], v);
      EXPECT_NEAR(whole.swept[k], before[k] + .3 * v * v, 1e-15);
      EXPECT_NEAR(whole.work[k], start.work[k] + .3 * nodes.force[k] * v, 1e-15);
    }
  });
}

// What is not asked for is left alone.
TEST(NodeKernels, works_without_a_place_for_them_make_middle_velocities_alone) {
  for_each_simd([](const NodeKernels& kernels) {
    Nodes nodes = random_nodes();
    const std::vector<double> before = nodes.v;
    kernels.works({.dt = .3, .after = nodes.u.data(), .v = nodes.v.data()}, 3 * n_nodes);
    for (std::size_t k = 0; k < 3 * n_nodes; ++k)
      EXPECT_EQ(nodes.v[k], (before[k] + nodes.u[k]) / 2);
  });
}

// Whose sums are of this kind.
static NodeForceKernel<double> force_kernel(const NodeKernels& kernels, double) {
  return kernels.force;
}
static NodeForceKernel<float> force_kernel(const NodeKernels& kernels, float) {
  return kernels.force_of_singles;
}

static NodeStepKernel<double> step_kernel(const NodeKernels& kernels, double) {
  return kernels.step;
}
static NodeStepKernel<float> step_kernel(const NodeKernels& kernels, float) {
  return kernels.step_of_singles;
}

template <class Real>
static void check_weight_less_sum() {
  for_each_simd([](const NodeKernels& kernels) {
    const std::vector<double> mass = {1, 2, 3, 4};
    std::vector<Real> sum;
    std::vector<double> force(12, -1.0);
    for (int k = 0; k < 16; ++k) sum.push_back(static_cast<Real>(k % 4 == 3 ? 77 : k));
    const std::vector<std::int32_t> node = {1, 3};
    force_kernel(kernels, Real{})(
        {.mass = mass.data(), .gravity = {.5, 0, -8, 0}, .sum = sum.data(), .force = force.data()},
        node.data(), 2);
    // 4 (0.5, 0, -8) - (12, 13, 14) and 2 (0.5, 0, -8) - (4, 5, 6): exact.
    EXPECT_EQ(force, (std::vector<double>{-1, -1, -1, -3, -5, -22, -1, -1, -1, -10, -13, -46}));
    for (const int k : {4, 5, 6, 12, 13, 14}) EXPECT_EQ(sum[k], 0);
    EXPECT_EQ(sum[0], 0);
    EXPECT_EQ(sum[9], 9);
  });
}

TEST(NodeKernels, a_force_is_the_weight_less_the_sum_which_becomes_zero) {
  check_weight_less_sum<double>();
  check_weight_less_sum<float>();
}

template <class Real>
static void check_bits_beside_others() {
  // Two eights that follow each other, with others before, between and behind.
  std::vector<std::int32_t> node = {0, 2, 3};
  for (std::int32_t i = 5; i < n_nodes; ++i)
    if (i % 13 != 0) node.push_back(i);
  Noise noise(8);
  std::vector<double> mass(n_nodes, 2.0);
  AlignedVector<Real> sum(4 * n_nodes);
  for (double& m : mass) m += noise();
  for (Real& s : sum) s = static_cast<Real>(noise());
  for_each_simd([&](const NodeKernels& kernels) {
    AlignedVector<Real> sum_alone = sum, sum_together = sum;
    std::vector<double> alone(3 * n_nodes), together = alone;
    const NodeForceKernel<Real> find_force = force_kernel(kernels, Real{});
    NodeForces<Real> task{.mass = mass.data(), .gravity = {.3, .7, -9.81, 0}};
    task.sum = sum_together.data();
    task.force = together.data();
    find_force(task, node.data(), std::ssize(node));
    task.sum = sum_alone.data();
    task.force = alone.data();
    for (const std::int32_t& i : node) find_force(task, &i, 1);
    EXPECT_EQ(together, alone);
    EXPECT_TRUE(sum_together == sum_alone);
    for (const std::int32_t i : node)
      for (int j = 0; j < 3; ++j) {
        EXPECT_EQ(sum_alone[4 * i + j], 0);
        EXPECT_NEAR(together[3 * i + j], mass[i] * task.gravity[j] - sum[4 * i + j], 1e-14);
      }  // two roundings of numbers below 32
  });
}

TEST(NodeKernels, a_nodes_force_has_the_same_bits_whatever_stands_beside_it_in_the_list) {
  check_bits_beside_others<double>();
  check_bits_beside_others<float>();
}

// As NodeForces takes sums: of nodes, or component by component.
template <class Real>
static void check_steps_at_once(bool is_by_component) {
  std::vector<std::int32_t> node;
  for (std::int32_t i = 1; i < n_nodes; ++i)
    if (i % 11 != 0) node.push_back(i);
  Noise noise(9);
  AlignedVector<Real> sum(4 * component_stride(n_nodes));
  for (Real& s : sum) s = static_cast<Real>(noise());
  for_each_simd([&](const NodeKernels& kernels) {
    Nodes apart = random_nodes(), at_once = apart;
    NodeForces<Real> task{.mass = apart.inertia.data(), .gravity = {.3, .7, -9.81, 0}};
    if (is_by_component) task.sum_stride = component_stride(n_nodes);
    AlignedVector<Real> sum_apart = sum, sum_at_once = sum;
    task.sum = sum_apart.data();
    task.force = apart.force.data();
    force_kernel(kernels, Real{})(task, node.data(), std::ssize(node));
    for (const std::int32_t i : node) kernels.motion(motion_of(apart), i, i + 1);
    task.sum = sum_at_once.data();
    task.force = nullptr;
    NodeMotion motion = motion_of(at_once);
    motion.force = nullptr;
    step_kernel(kernels, Real{})(task, motion, node.data(), std::ssize(node));
    EXPECT_EQ(at_once.v, apart.v);
    EXPECT_EQ(at_once.u, apart.u);
    EXPECT_TRUE(sum_at_once == sum_apart);
    EXPECT_NE(at_once.u, random_nodes().u);
  });
}

TEST(NodeKernels, a_step_at_once_has_the_bits_of_force_and_motion) {
  for (const bool is_by_component : {false, true}) {
    check_steps_at_once<double>(is_by_component);
    check_steps_at_once<float>(is_by_component);
  }
}
