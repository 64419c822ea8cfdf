// A step in two parts, the first of which knows nothing of halo nodes. MPI's own part is tested
// through mpirun in tests/invariance.
#include "solver/neighbours.h"

#include <gtest/gtest.h>

#include <limits>

#include "allocation_count.h"
#include "solver_ranks.h"

using namespace trocar;

// Of a box whose nodes are shared out in the order of their numbers.
static Body first_of_two(BoxElements elements, const SolverOptions& solver) {
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.1, .1, .2), {16, 10, 20}, elements);
  std::vector<std::int32_t> owner;
  for (const Vec3& X : mesh.X) owner.push_back(X.z() < .105 ? 0 : 1);
  Body body = make_body(mesh, {.solver = solver}, owner, 0);
  const SumOrder& sums = body.model.sums;
  EXPECT_GT(sums.n_strides_before_halo, 0);
  EXPECT_LT(sums.n_strides_before_halo, sums.run_stride.back());
  shake(body.state.u, 1e-4, 7);
  return body;
}

static std::vector<double> without_halo(const Body& body, std::vector<double> field, int width) {
  std::fill(field.begin() + width * std::int64_t{body.model.n_owned}, field.end(),
            std::numeric_limits<double>::quiet_NaN());
  return field;
}

TEST(Neighbours, the_first_part_of_a_force_reads_no_halo_node) {
  for (const Precision precision : precisions)
    for (const Formulation formulation :
         {Formulation::tet4, Formulation::tet4_nodal_pressure, Formulation::hex8_one_point}) {
      const bool is_hex = shape_of(formulation) == ElementType::hex8;
      Body body = first_of_two(is_hex ? BoxElements::hex8 : BoxElements::tet4_kuhn,
                               with(formulation, {.precision = precision}));
      average_volume_change(body.model, body.state, body.scratch);
      shake(body.state.theta, 1e-3, 8);
      compute_force(body.model, body.state, body.scratch);
      const std::vector<double> expected = body.scratch.force;
      const State whole = body.state;
      body.state.u = without_halo(body, whole.u, 3);
      body.state.theta = without_halo(body, whole.theta, body.model.averages.n_fields);
      begin_force(body.model, body.state, body.scratch);
      body.state = whole;
      end_force(body.model, body.state, body.scratch);
      EXPECT_EQ(body.scratch.force, expected);
    }
}

TEST(Neighbours, the_first_part_of_volume_changes_reads_no_halo_node) {
  for (const Precision precision : precisions) {
    Body body = first_of_two(BoxElements::tet4_kuhn,
                             {.precision = precision, .tet4 = Formulation::tet4_nodal_pressure});
    const std::vector<double> u = body.state.u;
    average_volume_change(body.model, body.state, body.scratch);
    const std::vector<double> expected = body.state.theta;
    body.state.u = without_halo(body, u, 3);
    begin_volume_change(body.model, body.state, body.scratch);
    body.state.u = u;
    end_volume_change(body.model, body.state, body.scratch);
    EXPECT_EQ(body.state.theta, expected);
  }
}

// The left half of a block whose neighbour is itself: the halo plane gets what the plane of border
// nodes, which has as many, holds.
struct Mirrored {
  Body body;
  Halo halo;
};
static Mirrored make_mirrored(Formulation tet4) {
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.1, .1, .1), {8, 5, 5}, BoxElements::tet4_kuhn);
  std::vector<std::int32_t> owner;
  for (const Vec3& X : mesh.X) owner.push_back(X.x() < .06 ? 0 : 1);
  Mirrored m{.body = make_body(mesh, {.solver = {.tet4 = tet4}}, owner, 0)};
  m.halo = make_halo(mesh, owner, m.body.part);
  EXPECT_EQ(m.halo.neighbours.size(), 1U);
  m.halo.neighbours[0].rank = 0;
  EXPECT_EQ(m.halo.neighbours[0].send.size(), m.halo.neighbours[0].receive.size());
  return m;
}

TEST(Neighbours, halo_nodes_get_displacements_of_the_border_in_one_message) {
  Mirrored m = make_mirrored(Formulation::tet4);
  Communicator alone;
  Neighbours neighbours = make_neighbours(m.halo, m.body.model, alone);
  shake(m.body.state.u, 1e-3, 1);
  State& state = m.body.state;
  start_exchange(neighbours, state);
  finish_exchange(neighbours, state);
  const Halo::Neighbour& border = m.halo.neighbours[0];
  for (std::size_t k = 0; k < border.send.size(); ++k)
    for (int j = 0; j < 3; ++j) {
      EXPECT_EQ(state.u[3 * border.receive[k] + j], state.u[3 * border.send[k] + j]);
    }
  EXPECT_EQ(alone.traffic().n_messages, 1U);
  EXPECT_EQ(alone.traffic().n_bytes, 3 * sizeof(double) * border.send.size());
}

TEST(Neighbours, a_step_allocates_nothing_and_makes_no_collective) {
  for (const Formulation tet4 : {Formulation::tet4, Formulation::tet4_nodal_pressure}) {
    Mirrored m = make_mirrored(tet4);
    Body& body = m.body;
    Communicator alone;
    Neighbours neighbours = make_neighbours(m.halo, body.model, alone);
    shake(body.state.u, 1e-4, 1);
    const auto run_step = [&] {
      start_exchange(neighbours, body.state);
      find_force(body.model, neighbours, body.state, body.scratch);
      integrate(body.model, body.scratch, {}, 1e-5, body.state);
    };
    run_step();
    const std::int64_t before = n_allocations;
    for (int k = 0; k < 5; ++k) run_step();
    EXPECT_EQ(n_allocations, before);
    EXPECT_EQ(alone.traffic().n_collectives, 0U);
    const bool averages = body.model.averages.n_fields > 0;
    EXPECT_EQ(alone.traffic().n_exchanges, averages ? 12U : 6U);
  }
}

TEST(Neighbours, a_force_is_the_same_whether_the_exchange_is_under_way_or_finished) {
  for (const Formulation tet4 : {Formulation::tet4, Formulation::tet4_nodal_pressure}) {
    Mirrored m = make_mirrored(tet4);
    Body& body = m.body;
    Communicator alone;
    Neighbours neighbours = make_neighbours(m.halo, body.model, alone);
    shake(body.state.u, 1e-4, 1);
    start_exchange(neighbours, body.state);
    find_force(body.model, neighbours, body.state, body.scratch);
    const std::vector<double> expected = body.scratch.force;
    start_exchange(neighbours, body.state);
    update_volume_change(body.model, neighbours, body.state, body.scratch);
    compute_force(body.model, body.state, body.scratch);
    EXPECT_EQ(body.scratch.force, expected);
    EXPECT_GT(largest(expected), 0);
  }
}
