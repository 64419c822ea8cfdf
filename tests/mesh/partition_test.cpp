// Owners of nodes.
#include "mesh/partition.h"

#include <gtest/gtest.h>

#include <string>

#include "error_of.h"
#include "mesh/partition_work.h"
#include "mesh_fixtures.h"
#include "mesh_joined.h"

using namespace trocar;

static std::vector<int> part_sizes(std::span<const std::int32_t> owner, int n_parts) {
  std::vector<int> size(static_cast<std::size_t>(n_parts), 0);
  for (const std::int32_t part : owner) ++size.at(static_cast<std::size_t>(part));
  return size;
}

TEST(PartitionNodes, is_balanced_on_twenty_thousand_nodes) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {26, 26, 26}, BoxElements::tet4_kuhn);
  for (const int n_parts : {2, 3, 4}) {
    const std::vector<std::int32_t> owner = partition_nodes(mesh, n_parts);
    ASSERT_EQ(owner.size(), mesh.X.size());
    const std::vector<int> size = part_sizes(owner, n_parts);
    const double mean = static_cast<double>(mesh.n_nodes()) / n_parts;
    EXPECT_LT(*std::max_element(size.begin(), size.end()), 1.1 * mean) << n_parts;
    EXPECT_GT(*std::min_element(size.begin(), size.end()), 0.9 * mean) << n_parts;
  }
}

// As many nodes in hexahedra as in tetrahedra, six in the place of each: parts of equal numbers of
// nodes would have an imbalance of up to 2 * 6 * 12 / (6 * 12 + 32) = 1.38.
TEST(PartitionNodes, is_balanced_by_the_work_of_elements) {
  const Mesh mesh =
      joined(make_box(Vec3::Zero(), Vec3::Ones(), {8, 8, 8}, BoxElements::hex8),
             make_box(Vec3(2, 0, 0), Vec3(3, 1, 1), {8, 8, 8}, BoxElements::tet4_kuhn));
  for (const int n_parts : {2, 3})
    EXPECT_LT(imbalance(mesh, partition_nodes(mesh, n_parts), n_parts), 1.1) << n_parts;
}

// Planes of four nodes with one or two hexahedra beside them: 48 of 256 parts of the work.
TEST(Imbalance, is_the_largest_share_of_the_work_over_the_mean) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3(8, 1, 1), {8, 1, 1}, BoxElements::hex8);
  std::vector<std::int32_t> owner;
  for (const Vec3& X : mesh.X) owner.push_back(X.x() < 1.5 ? 0 : 1);
  EXPECT_DOUBLE_EQ(imbalance(mesh, owner, 2), 2 * 208 / 256.0);
}

// Rows of nodes along x have one owner each, where that makes no border longer.
TEST(PartitionNodes, keeps_the_rows_of_a_box_whole) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {16, 12, 12}, BoxElements::hex8);
  for (const int n_parts : {2, 3, 4}) {
    const std::vector<std::int32_t> owner = partition_nodes(mesh, n_parts);
    for (std::size_t i = 0; i < owner.size(); ++i)
      EXPECT_EQ(owner[i], owner[i - i % 17]) << n_parts;
    EXPECT_LT(imbalance(mesh, owner, n_parts), 1.1) << n_parts;
  }
}

// Of a long box, of which rows are the longest side.
TEST(PartitionNodes, breaks_rows_where_their_border_would_be_long) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3(96, 6, 6), {96, 6, 6}, BoxElements::hex8);
  const std::vector<std::int32_t> owner = partition_nodes(mesh, 2);
  EXPECT_NE(owner[0], owner[96]);
}

// Eight elements with the same owner at each corner are a row, others take 1.4 times as long, and
// fewer than eight as long as eight: part 0 has a row and one element more, part 1 eight of which
// one has corners of either.
TEST(MostWork, counts_elements_by_eights_those_of_rows_less) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3(16, 1, 1), {16, 1, 1}, BoxElements::hex8);
  std::vector<std::int32_t> owner(mesh.X.size(), 0);
  EXPECT_DOUBLE_EQ(most_work(mesh, owner, 2), 16 * 8 * 4);
  for (std::size_t i = 0; i < owner.size(); ++i) owner[i] = mesh.X[i].x() < 8.5 ? 0 : 1;
  EXPECT_DOUBLE_EQ(most_work(mesh, owner, 2), (1 + 1.4) * 8 * 8 * 4);
}

TEST(PartitionNodes, cuts_few_edges) {
  // Two halves of a cube of n^3 nodes meet in n^2 nodes: about 7 edges each for Kuhn's tetrahedra
  // (14 a node).
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {20, 20, 20}, BoxElements::tet4_kuhn);
  const std::vector<std::int32_t> owner = partition_nodes(mesh, 2);
  int n_cut = 0;
  for (const auto& [i, j] : mesh_edges(mesh)) n_cut += owner[i] != owner[j] ? 1 : 0;
  EXPECT_LT(n_cut,
            2 * 7 * 21 * 21);  // twice the plane cut: a random partition has 14 times as many
}

TEST(PartitionNodes, is_repeatable) {
  for (const NamedMesh& named : all_meshes()) {
    const std::vector<std::int32_t> owner = partition_nodes(named.mesh, 3);
    std::srand(99);  // METIS draws from the C library's generator
    EXPECT_EQ(partition_nodes(named.mesh, 3), owner) << named.name;
  }
}

TEST(PartitionNodes, leaves_no_rank_without_a_node_on_tiny_meshes) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {2, 1, 1}, BoxElements::hex8);
  for (int n_parts = 1; n_parts <= mesh.n_nodes(); ++n_parts)
    for (const int size : part_sizes(partition_nodes(mesh, n_parts), n_parts))
      EXPECT_GE(size, 1) << n_parts;
}

TEST(PartitionNodes, refuses_more_ranks_than_nodes_with_the_number_that_would_do) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::hex8);
  EXPECT_EQ(error_of([&] { partition_nodes(mesh, 64); }),
            "the mesh has 8 nodes, too few for 64 ranks: use at most 8");
}

TEST(PartitionNodes, gives_everything_to_a_single_rank) {
  const Mesh mesh = make_rectangle(1, 1, 4, 4);
  Communicator alone;
  EXPECT_EQ(partition_nodes(mesh, alone), std::vector<std::int32_t>(16, 0));
}

TEST(PartitionNodes, splits_a_mesh_of_several_pieces) {
  Mesh mesh;
  for (int piece = 0; piece < 4; ++piece)
    mesh = joined(mesh, make_box(Vec3(3.0 * piece, 0, 0), Vec3(3.0 * piece + 1, 1, 1), {4, 4, 4},
                                 BoxElements::hex8));
  for (const int size : part_sizes(partition_nodes(mesh, 3), 3)) EXPECT_GT(size, 100);  // of 167
}

TEST(ApplyEditToOwners, leaves_a_duplicate_with_its_parent_s_owner) {
  std::vector<std::int32_t> owner = {0, 2, 1};
  apply_edit_to_owners({.duplicate_parent = {1, 2, 3}}, owner);  // node 3 is the first duplicate
  EXPECT_EQ(owner, (std::vector<std::int32_t>{0, 2, 1, 2, 1, 2}));
}
