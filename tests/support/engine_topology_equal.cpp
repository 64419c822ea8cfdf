#include "engine_topology_equal.h"

#include <gtest/gtest.h>

#include "solver_model_equal.h"

namespace trocar {

void expect_equal(const Part& a, const Part& b) {
  EXPECT_EQ(a.rank, b.rank);
  EXPECT_EQ(a.n_owned, b.n_owned);
  EXPECT_EQ(a.node_global, b.node_global);
  EXPECT_EQ(a.element_global, b.element_global);
  EXPECT_EQ(a.node_local, b.node_local);
}

void expect_equal(const Surface& a, const Surface& b) {
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.element, b.element);
  EXPECT_EQ(a.is_cut, b.is_cut);
  EXPECT_EQ(a.is_quad_half, b.is_quad_half);
  EXPECT_EQ(a.node, b.node);
}

void expect_equal(const MassScaling& a, const MassScaling& b) {
  const auto numbers = [](const MassScaling& scaling) {
    std::vector<std::int32_t> number;
    for (const RestingElement& element : scaling.element) number.push_back(element.number);
    return number;
  };
  EXPECT_EQ(numbers(a), numbers(b));
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.node, b.node);
  EXPECT_EQ(a.added, b.added);
}

void expect_equal(const Sleep& a, const Sleep& b) {
  EXPECT_EQ(a.quiet, b.quiet);
  EXPECT_EQ(a.is_asleep, b.is_asleep);
  EXPECT_EQ(a.is_beside, b.is_beside);
  EXPECT_EQ(a.awake_fixed, b.awake_fixed);
  EXPECT_EQ(a.block_sleeps, b.block_sleeps);
  EXPECT_EQ(a.share, b.share);
  EXPECT_EQ(a.anchor, b.anchor);
  EXPECT_EQ(a.watched, b.watched);
}

void expect_equal(const LocalStepPlan& a, const LocalStepPlan& b) {
  ASSERT_EQ(a.resting.size(), b.resting.size());
  for (std::size_t e = 0; e < a.resting.size(); ++e) {
    EXPECT_EQ(a.resting[e].number, b.resting[e].number);
    EXPECT_EQ(a.resting[e].step, b.resting[e].step);
    EXPECT_EQ(a.resting[e].mass, b.resting[e].mass);
  }
  EXPECT_EQ(a.plan.n_substeps, b.plan.n_substeps);
  EXPECT_EQ(a.plan.element, b.plan.element);
  EXPECT_EQ(a.plan.is_fine, b.plan.is_fine);
}

void expect_equal(const MultiRate& a, const MultiRate& b) {
  expect_equal(a.part, b.part);
  expect_equal(a.model, b.model);
  EXPECT_EQ(a.steps.back, b.steps.back);
  EXPECT_EQ(a.share, b.share);
  EXPECT_EQ(a.whole, b.whole);
  EXPECT_EQ(a.of_whole, b.of_whole);
  EXPECT_EQ(a.is_fine, b.is_fine);
  EXPECT_EQ(a.coarse_fixed, b.coarse_fixed);
}

void expect_equal(const Halo& a, const Halo& b) {
  ASSERT_EQ(a.neighbours.size(), b.neighbours.size());
  for (std::size_t k = 0; k < a.neighbours.size(); ++k) {
    EXPECT_EQ(a.neighbours[k].rank, b.neighbours[k].rank);
    EXPECT_EQ(a.neighbours[k].send, b.neighbours[k].send);
    EXPECT_EQ(a.neighbours[k].receive, b.neighbours[k].receive);
  }
}

}  // namespace trocar
