// The same bits for any number of ranks and threads. Ranks are bodies of their own in this process,
// and the halo is copied from the owners.
#include <gtest/gtest.h>

#include "solver_ranks.h"

using namespace trocar;

static void expect_same_result(const RanksResult& a, const RanksResult& b) {
  EXPECT_EQ(a.u, b.u);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.stable_step, b.stable_step);
  EXPECT_EQ(a.stable_element, b.stable_element);
  EXPECT_EQ(a.least_J, b.least_J);
  EXPECT_EQ(a.strain, b.strain);  // each element once, whoever counts it
  EXPECT_EQ(a.volumetric, b.volumetric);
}

static void check_ranks_and_threads(const Mesh& mesh, const SolverOptions& solver) {
  const RanksResult alone = run_on_ranks(mesh, solver, 200, 1, 1);
  EXPECT_GT(largest(alone.u), 5e-4);  // it has really moved
  EXPECT_LT(largest(alone.u), 1e-1);  // and has not blown up
  EXPECT_EQ(alone.strain.size(), mesh.element_type.size());
  for (const int n_ranks : {2, 3, 5})
    expect_same_result(run_on_ranks(mesh, solver, 200, n_ranks, 1), alone);
  for (const int n_threads : {2, 3})
    expect_same_result(run_on_ranks(mesh, solver, 200, 1, n_threads), alone);
  expect_same_result(run_on_ranks(mesh, solver, 200, 2, 2), alone);
  for (const auto& [n_ranks, n_threads] : {std::pair{1, 1}, {1, 3}, {3, 1}, {2, 2}})
    expect_same_result(run_on_ranks(mesh, solver, 200, n_ranks, n_threads, Motion::at_once), alone);
}

TEST(Invariance, any_number_of_ranks_and_threads_gives_the_same_bits_after_200_steps) {
  check_ranks_and_threads(mixed_mesh(), {});
  check_ranks_and_threads(mixed_mesh(), {.precision = Precision::in_single});
}

TEST(Invariance, averaged_pressures_and_the_other_hexahedra_give_the_same_bits_too) {
  for (const Precision precision : precisions)
    for (const Formulation hex8 : {Formulation::hex8_enhanced, Formulation::hex8_full})
      check_ranks_and_threads(
          mixed_mesh(),
          {.precision = precision, .tet4 = Formulation::tet4_nodal_pressure, .hex8 = hex8});
}

// Rows of 21: some of eight lanes, some across two rows; parted between rows and within.
TEST(Invariance, rows_of_hexahedra_give_the_same_bits_too) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.07, .02, .02), {21, 6, 6}, BoxElements::hex8);
  mesh.region_name = {"a", "b", "c"};
  jitter(mesh, .2, 3);
  for (const Precision precision : precisions)
    check_ranks_and_threads(mesh, {.precision = precision});
}

TEST(Invariance, triangles_in_plane_stress_give_the_same_bits_too) {
  Mesh mesh = make_rectangle(.06, .03, 9, 6);
  mesh.region_name = {"a", "b", "c"};
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) mesh.element_region[e] = e % 3;
  for (const Precision precision : precisions)
    check_ranks_and_threads(mesh, {.precision = precision, .tri3 = Formulation::tri3_plane_stress});
}
