#include "engine/apply_cut_momentum.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>

namespace trocar {
namespace {

// Twenty nodes of unlike masses that move at random, and which turn and travel together.
struct Swarm {
  std::vector<std::int32_t> nodes = std::vector<std::int32_t>(20);
  std::vector<double> mass;
  std::vector<FixedMask> fixed = std::vector<FixedMask>(nodes.size(), 0);
  std::vector<Hold> holds;
  GlobalState state;
  Swarm() {
    std::iota(nodes.begin(), nodes.end(), 0);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      mass.push_back(1e-3 * (0.5 + unit(random)));
      state.x.emplace_back(unit(random), unit(random), unit(random));
      const Vec3 v = Vec3(1, 2, 3) + Vec3(0, 0, 4).cross(state.x[i]) +
                     4 * Vec3(unit(random), unit(random), unit(random));
      state.v.insert(state.v.end(), v.begin(), v.end());
    }
  }
  EditedNodes edited() const { return {nodes, nodes, mass, fixed, holds}; }
  Motion motion(const Vec3& about) const { return motion_of(nodes, mass, state, about); }
  // Some nodes lose or win mass and speed, as those that a cut copies do.
  void disturb() {
    for (std::size_t i = 0; i < 10; ++i) {
      mass[i] *= 1.02;
      state.v[3 * i] -= 0.03;
      state.v[3 * i + 2] *= 0.99;
    }
  }
};

TEST(ApplyCutMomentum, restored_motion_has_the_momenta_and_the_energy_of_before) {
  Swarm swarm;
  const Motion before = motion_about_centre(swarm.nodes, swarm.mass, swarm.state);
  swarm.disturb();
  const Motion disturbed = swarm.motion(before.centre);
  ASSERT_GT((disturbed.momentum - before.momentum).norm(), 1e-3 * before.scale);
  ASSERT_GT((disturbed.angular - before.angular).norm(), 1e-3 * before.angular.norm());
  CutRecord record;
  restore_motion(swarm.edited(), before, swarm.state, record);
  const Motion after = swarm.motion(before.centre);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-14 * before.scale);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-13 * before.angular.norm());
  EXPECT_NEAR(after.kinetic, before.kinetic, 1e-12 * before.kinetic);
  EXPECT_LT(record.momentum_change, 1e-14);
  EXPECT_NEAR(record.kinetic_energy_change, 0, 1e-12 * before.kinetic);
}

// What supports and graspers hold would drop an increment in the next step.
TEST(ApplyCutMomentum, is_restored_by_nodes_that_are_free_to_move) {
  Swarm swarm;
  for (std::size_t i = 4; i < 16; ++i) swarm.fixed[i] = i < 10 ? all_components : 4;
  swarm.holds.push_back({.node = 17});
  const Motion before = motion_about_centre(swarm.nodes, swarm.mass, swarm.state);
  swarm.disturb();
  const std::vector<double> v = swarm.state.v;
  CutRecord record;
  EditedNodes nodes = swarm.edited();
  const std::array<std::int32_t, 4> free{0, 1, 2, 3};
  nodes.adjustable = free;
  restore_motion(nodes, before, swarm.state, record);
  const Motion after = swarm.motion(before.centre);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-14 * before.scale);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-13 * before.angular.norm());
  for (std::size_t i = 0; i < swarm.nodes.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_held = i == 17 || (swarm.fixed[i] >> k & 1) != 0;
      EXPECT_EQ(swarm.state.v[3 * i + k] == v[3 * i + k], is_held) << i << " " << k;
    }
}

TEST(ApplyCutMomentum, added_energy_leaves_momenta_and_is_bounded) {
  for (const double share : {-0.1, 0.1, 100.0}) {
    Swarm swarm;
    const Motion before = motion_about_centre(swarm.nodes, swarm.mass, swarm.state);
    CutRecord record;
    add_kinetic_energy(swarm.nodes, swarm.mass, share * 0.005, swarm.state, record);
    const Motion after = swarm.motion(before.centre);
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-14 * before.scale) << share;
    EXPECT_LT((after.angular - before.angular).norm(), 1e-13 * before.angular.norm()) << share;
    const double change = after.kinetic - before.kinetic;
    EXPECT_NEAR(record.kinetic_energy_change, change, 1e-12 * before.kinetic) << share;
    if (share < 1)
      EXPECT_NEAR(change, share * 0.005, 1e-12 * before.kinetic) << share;
    else  // what is not rigid motion may have 1.5 times its speed
      EXPECT_LT(change, 1.25 * before.kinetic) << share;
  }
}

// Of rigid motion nothing can be scaled.
TEST(ApplyCutMomentum, a_single_node_gets_no_energy) {
  Swarm swarm;
  const std::vector<double> before = swarm.state.v;
  CutRecord record;
  add_kinetic_energy(std::vector<std::int32_t>{3}, swarm.mass, 1, swarm.state, record);
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_NEAR(swarm.state.v[k], before[k], 1e-12) << k;
}

}  // namespace
}  // namespace trocar
