// Building a model: blocks, the order of corner forces, and input that can't be simulated.
#include "solver/model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "base/threads.h"
#include "error_of.h"
#include "solver/row_order.h"
#include "solver/sum_order.h"
#include "solver_body.h"

using namespace trocar;

// Two regions of different materials in one mesh of 27 cells, every second cell.
static Body two_material_body() {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.03, .03, .03), {3, 3, 3}, BoxElements::tet4_kuhn);
  mesh.region_name = {"a", "b"};
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) mesh.element_region[e] = e / 6 % 2;
  return make_body(mesh, {.materials = {material_of(MaterialModel::neo_hookean, 1000, 9000),
                                        material_of(MaterialModel::linear, 2000, 5000)}});
}

TEST(BuildModel, puts_each_element_into_one_list_of_its_type_and_material) {
  const Body body = two_material_body();
  ASSERT_EQ(body.model.blocks.size(), 2U);
  std::vector<int> n_found(body.mesh.element_type.size(), 0);
  for (const ElementBlocks& blocks : body.model.blocks)
    for (std::int32_t k = 0; k < blocks.n_elements; ++k) {
      const std::int32_t e = body.part.element_global[blocks.element_local[k]];
      ++n_found[e];
      EXPECT_EQ(body.materials[body.mesh.element_region[e]].model, blocks.material);
    }
  EXPECT_EQ(n_found, std::vector<int>(body.mesh.element_type.size(), 1));
}

// Places of the corner forces of a body whose model was built for so many threads.
static void check_places(int n_threads) {
  set_thread_count(n_threads);
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {7, 6, 5}, BoxElements::tet4_kuhn);
  const Body body = make_body(mesh);
  set_thread_count(1);
  const SumOrder& sums = body.model.sums;
  ASSERT_EQ(sums.n_runs, n_threads);
  // The node of each place, the run that it is a target of, and how often it is one.
  std::vector<std::int32_t> node(static_cast<std::size_t>(sums.n_places), -1);
  std::vector<std::int64_t> run(node.size(), -1);
  std::vector<int> n_targets(node.size(), 0);
  const ElementBlocks& blocks = body.model.blocks[0];
  const std::int64_t n = corners_of_block(blocks);
  for (std::int64_t k = 0; k < std::ssize(blocks.corner); ++k) {
    const std::int64_t block = k / n;
    const std::int32_t place = targets(blocks, block)[k % n];
    ++n_targets[place];
    const std::int64_t run_of_block =
        std::ranges::upper_bound(sums.run_block, block) - sums.run_block.begin() - 1;
    EXPECT_TRUE(run[place] < 0 || run[place] == run_of_block);  // or threads would meet there
    run[place] = run_of_block;
    EXPECT_TRUE(node[place] < 0 || node[place] == blocks.corner[k]);
    node[place] = blocks.corner[k];
  }
  std::vector<int> n_finished(mesh.X.size(), 0);
  for (const std::int32_t i : sums.node) ++n_finished[i];
  for (const std::int32_t i : sums.shared_node) {
    ++n_finished[i];
    EXPECT_GT(n_targets[i], 0);
  }
  EXPECT_EQ(sums.n_places, body.model.n_local + std::ssize(sums.place_node));
  for (std::size_t k = 0; k < sums.place_node.size(); ++k) {
    const std::size_t place = static_cast<std::size_t>(body.model.n_local) + k;
    EXPECT_EQ(node[place], sums.place_node[k]);
    EXPECT_EQ(n_targets[place], 1);
    EXPECT_GT(run[place], run[sums.place_node[k]]);
    EXPECT_TRUE(std::ranges::binary_search(sums.shared_node, sums.place_node[k]));
  }
  EXPECT_EQ(n_finished, std::vector<int>(mesh.X.size(), 1));
  EXPECT_EQ(sums.shared_node.empty(), n_threads == 1);
}

TEST(BuildModel, gives_corners_at_a_node_of_several_threads_places_but_for_the_first_thread) {
  for (const int n_threads : {1, 2, 3}) check_places(n_threads);
}

TEST(BuildModel, forces_have_the_same_bits_for_any_number_of_threads) {
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {7, 6, 5}, BoxElements::tet4_kuhn);
  std::vector<double> expected;
  for (const int n_threads : {1, 2, 3, 4}) {
    set_thread_count(n_threads);
    Body body = make_body(mesh);
    shake(body.state.u, 1e-2, 4);
    const std::vector<double> f = force(body);
    EXPECT_EQ(f, force(body));  // a second time, too: all sums are taken away
    if (expected.empty()) expected = f;
    EXPECT_EQ(f, expected);
  }
  set_thread_count(1);
}

// Rows of hexahedra are gathered and added by whole registers; the same body with its nodes
// numbered backwards has no rows.
TEST(BuildModel, rows_of_a_regular_numbering_have_the_same_bits_as_single_nodes) {
  for (const Precision precision : {Precision::in_double, Precision::in_single}) {
    Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {32, 3, 3}, BoxElements::hex8);
    const auto n = static_cast<std::size_t>(mesh.n_nodes());
    Noise noise(4);
    for (Vec3& X : mesh.X) X += .01 * Vec3(noise(), noise(), noise());
    Mesh backwards = mesh;
    for (std::size_t i = 0; i < n; ++i) backwards.X[i] = mesh.X[n - 1 - i];
    for (std::int32_t& i : backwards.corner_node) i = mesh.n_nodes() - 1 - i;
    Body rows = make_body(mesh, {.solver = {.precision = precision}});
    Body single = make_body(backwards, {.solver = {.precision = precision}});
    const auto n_rows = [](const Body& body) {
      const std::vector<std::uint32_t>& row = body.model.blocks[0].row;
      return std::count_if(row.begin(), row.end(), is_row);
    };
    EXPECT_EQ(n_rows(rows), std::ssize(rows.model.blocks[0].row));
    EXPECT_EQ(n_rows(single), 0);
    shake(rows.state.u, 1e-3, 4);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        single.state.u[3 * i + j] = rows.state.u[3 * (n - 1 - i) + j];
    const std::vector<double> f = force(rows), g = force(single);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(f[3 * i + j], g[3 * (n - 1 - i) + j]);
  }
}

// Whole rows of 16: border nodes have their numbers behind the others, and later corners places
// elsewhere, but all of them in the order of the rows.
TEST(BuildModel, rows_stay_rows_on_any_ranks_and_threads) {
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {16, 6, 6}, BoxElements::hex8);
  for (const int n_ranks : {1, 2, 3})
    for (const int n_threads : {1, 2}) {
      set_thread_count(n_threads);
      const std::vector<std::int32_t> owner = partition_nodes(mesh, n_ranks);
      for (int rank = 0; rank < n_ranks; ++rank) {
        const Body body = make_body(mesh, {}, owner, rank);
        EXPECT_EQ(body.model.blocks.size(), 1U);
        EXPECT_EQ(body.model.sums.halo_block.empty(), n_ranks == 1);
        EXPECT_TRUE(n_threads > 1 || body.model.sums.shared_node.empty());
        for (const ElementBlocks& blocks : body.model.blocks)
          EXPECT_TRUE(std::ranges::all_of(blocks.row, [](auto row) { return row == box_row; }));
      }
    }
  set_thread_count(1);
}

// Positions rounded where they stand would be off by 8e-6 m here, 2e-4 of a cell.
TEST(BuildModel, forces_in_single_precision_are_the_same_far_from_the_origin) {
  Mesh near = make_box(Vec3(0, 0, 0), Vec3(.1, .1, .1), {3, 3, 3}, BoxElements::hex8), far = near;
  Noise noise(5);
  for (std::size_t i = 0; i < near.X.size(); ++i) {
    near.X[i] += .002 * Vec3(noise(), noise(), noise());
    far.X[i] = near.X[i] + Vec3(200, -150, 130);
  }
  const BodyOptions options{.solver = {.precision = Precision::in_single}};
  Body a = make_body(near, options), b = make_body(far, options);
  shake(a.state.u, 1e-3, 4);
  b.state.u = a.state.u;
  const std::vector<double>&f = force(a), &g = force(b);
  // Rounding alone: some tens of terms of 6e-8 each.
  EXPECT_LE(largest_difference(f, g), 3e-6 * largest(f));
}

// Behind the last node's displacement nothing may be read.
TEST(BuildModel, lanes_outside_rows_that_meet_the_last_node_say_so) {
  for (const Precision precision : {Precision::in_double, Precision::in_single}) {
    const Body body =
        make_body(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {3, 3, 3}, BoxElements::hex8),
                  {.solver = {.precision = precision}});
    const ElementBlocks& blocks = body.model.blocks[0];
    for (std::size_t k = 0; k < blocks.row.size(); ++k) {
      bool meets_last = false;
      for (int a = 0; a < 8; ++a)
        for (std::size_t l = k * row_lanes; l < (k + 1) * row_lanes; ++l) {
          const std::size_t n = static_cast<std::size_t>(blocks.lanes), block = l / n;
          const std::size_t at = (block * 8 + static_cast<std::size_t>(a)) * n + l % n;
          meets_last = meets_last || blocks.corner[at] == body.model.n_local - 1;
        }
      EXPECT_EQ(blocks.row[k] == no_row_at_end, meets_last);
    }
  }
}

TEST(BuildModel, the_elements_of_a_mixed_body_add_up_to_the_forces_of_each_alone) {
  Body body = two_material_body();
  shake(body.state.u, 1e-3, 4);
  const std::vector<double> f = force(body);
  std::vector<double> expected(f.size(), 0.0);
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
    std::vector<Vec3> X;
    for (const std::int32_t i : body.mesh.corners(e)) X.push_back(body.mesh.X[i]);
    Body single = make_body(single_element(ElementType::tet4, X),
                            {.materials = {body.materials[body.mesh.element_region[e]]}});
    for (std::size_t k = 0; k < 12; ++k)
      single.state.u[k] = body.state.u[3 * body.mesh.corners(e)[k / 3] + k % 3];
    force(single);
    for (std::size_t k = 0; k < 12; ++k)
      expected[3 * body.mesh.corners(e)[k / 3] + k % 3] += single.scratch.force[k];
  }
  // The same terms in the same order.
  EXPECT_LE(largest_difference(f, expected), 1e-14 * largest(f));
}

TEST(BuildModel, a_heavier_element_has_a_longer_step) {
  Mesh mesh = irregular_elements()[1];
  const double step = make_body(mesh).model.element_step[0];
  mesh.density_factor[0] = 4;
  EXPECT_NEAR(make_body(mesh).model.element_step[0], 2 * step, 1e-14 * step);
}

TEST(BuildModel, plane_meshes_stay_in_their_plane) {
  const Body body = make_body(make_rectangle(.03, .02, 4, 3));
  for (const FixedMask mask : body.model.fixed) EXPECT_EQ(mask, 4);
}

TEST(BuildModel, refuses_an_element_without_positive_volume_by_its_number) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {2, 1, 1}, BoxElements::tet4_kuhn);
  std::swap(mesh.corner_node[4 * 7], mesh.corner_node[4 * 7 + 1]);
  const std::vector<double> mass(mesh.X.size(), 1.0);
  const std::vector<FixedMask> fixed(mesh.X.size(), 0);
  const Part part = whole_part(mesh);
  const std::string error = error_of(
      [&] { build_model(mesh, part, std::vector<Material>{Material{}}, fixed, mass, {}); });
  EXPECT_TRUE(contains(error, "element 7 ")) << error;
}

TEST(BuildModel, refuses_impossible_materials_and_nodes_without_mass) {
  const Mesh mesh = irregular_elements()[1];
  for (const Material& bad : {Material{.young_modulus = 0}, Material{.poisson_ratio = 0.5},
                              Material{.poisson_ratio = -1}, Material{.density = -1}})
    EXPECT_THROW(make_body(mesh, {.materials = {bad}}), InputError);
  Mesh loose = mesh;
  loose.X.emplace_back(1, 1, 1);
  EXPECT_THROW(make_body(loose), InputError);
}

TEST(MemoryBytes, counts_what_a_tetrahedron_needs) {
  const Body body =
      make_body(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {8, 8, 8}, BoxElements::tet4_kuhn));
  // 3072 tetrahedra in full blocks: 11 constants and a step of 8 bytes, 4 corners and a place of 4,
  // and for a block of 8 what its lanes are, of 4; for a stride of 32 blocks which nodes are
  // complete behind it, of 4, and two of these more; 729 nodes: mass, 3 forces and 4 sums of 8,
  // their order of 4, a mark of 1; of one run where its blocks (8) and strides (4) begin and end; 4
  // for where the first of no clusters would begin; what one list would relax in a step.
  const std::size_t n_bytes = 8 * (11 + 1) + 4 * 5, n_node_bytes = 8 * 8 + 4 + 1;
  const std::size_t expected = 3072 * n_bytes + 384 * 4 + (12 + 2) * 4 + 729 * n_node_bytes +
                               2 * (8 + 4) + 4 + sizeof(ViscousStep);
  EXPECT_EQ(memory_bytes(body.model, body.scratch), expected);
}

// A general mesh: no element of it is a parallelepiped.
static double bytes_of_hexahedron(Precision precision) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {20, 20, 20}, BoxElements::hex8);
  Noise noise(3);
  for (Vec3& X : mesh.X) X += .005 * Vec3(noise(), noise(), noise());
  const Body body = make_body(mesh, {.solver = {.precision = precision}});
  const std::size_t state = (body.state.u.size() + body.state.v.size()) * sizeof(double);
  return static_cast<double>(memory_bytes(body.model, body.scratch) + state) / mesh.n_elements();
}

TEST(MemoryBytes, of_a_hexahedron_are_at_most_400_in_double_and_220_in_single) {
  EXPECT_LE(bytes_of_hexahedron(Precision::in_double), 400);
  EXPECT_LE(bytes_of_hexahedron(Precision::in_single), 220);
}

TEST(MemoryBytes, counts_the_clusters_of_scaled_mass) {
  Body body = make_body(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {4, 4, 4}, BoxElements::tet4_kuhn));
  const std::size_t before = memory_bytes(body.model, body.scratch);
  MassClusters& clusters = body.model.clusters;
  clusters.offset = {0, 3, 7};
  clusters.offset.shrink_to_fit();
  clusters.node = {0, 1, 2, 5, 6, 7, 8};
  clusters.added.assign(7, 1.0);
  clusters.total.assign(2, 1.0);
  clusters.of_node.assign(125, -1);
  EXPECT_EQ(memory_bytes(body.model, body.scratch), before + (3 - 1 + 7 + 125) * 4 + (7 + 2) * 8);
}

TEST(BuildModel, refuses_averaged_pressure_with_a_material_that_has_no_volumetric_energy) {
  const Mesh mesh = irregular_elements()[1];
  for (const MaterialModel model : all_models()) {
    const BodyOptions options{.materials = {material_of(model, 1000, 9000)},
                              .solver = with(Formulation::tet4_nodal_pressure)};
    if (is_possible(Formulation::tet4_nodal_pressure, model))
      EXPECT_NO_THROW(make_body(mesh, options));
    else
      EXPECT_THROW(make_body(mesh, options), InputError);
  }
}

TEST(BuildModel, takes_every_material_in_plane_stress_and_lets_it_relax) {
  for (const MaterialModel model : all_models()) {
    BodyOptions options{.materials = {material_of(model, 1000, 9000)},
                        .solver = with(Formulation::tri3_plane_stress)};
    EXPECT_NO_THROW(make_body(irregular_elements()[0], options));
    options.materials[0].prony = {{.5, .1}};
    EXPECT_NO_THROW(make_body(irregular_elements()[0], options));
  }
}

TEST(BuildModel, averages_volume_changes_around_a_node_of_each_region_on_its_own) {
  // Two tetrahedra that share a face, in two regions: each node of a region has the change of its
  // only tetrahedron.
  Mesh mesh = irregular_patch(Formulation::tet4_nodal_pressure);
  mesh.region_name = {"a", "b"};
  mesh.element_region[1] = 1;
  Body body = make_body(mesh, {.materials = {Material{}, Material{}},
                               .solver = with(Formulation::tet4_nodal_pressure)});
  shake(body.state.u, 1e-3, 3);
  force(body);
  std::vector<Vec3> x = mesh.X;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += Vec3::Map(&body.state.u[3 * i]);
  for (std::int32_t e = 0; e < 2; ++e) {
    const double j = element_volume(mesh, e, x) / element_volume(mesh, e, mesh.X) - 1;
    for (const std::int32_t node : mesh.corners(e))
      EXPECT_NEAR(body.state.theta[2 * node + e], j, 1e-15);
  }
  EXPECT_EQ(body.state.theta[2 * 0 + 1], 0);  // node 0 has no element of region b
  EXPECT_EQ(body.state.theta[2 * 4 + 0], 0);
}
