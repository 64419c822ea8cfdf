// Parts and halos of all ranks, simulated in one process.
#include <gtest/gtest.h>

#include <map>

#include "mesh/partition.h"
#include "mesh_fixtures.h"

using namespace trocar;

struct Ranks {
  std::vector<std::int32_t> owner;
  std::vector<Part> part;
  std::vector<Halo> halo;
};

static Ranks make_ranks(const Mesh& mesh, int n_ranks) {
  Ranks ranks;
  ranks.owner = partition_nodes(mesh, n_ranks);
  for (int rank = 0; rank < n_ranks; ++rank) {
    ranks.part.push_back(make_part(mesh, ranks.owner, rank));
    ranks.halo.push_back(make_halo(mesh, ranks.owner, ranks.part.back()));
  }
  return ranks;
}

// Runs `check(mesh, ranks)` for all meshes and a few numbers of ranks.
template <class Check>
static void for_all_partitions(const Check& check) {
  for (const NamedMesh& named : all_meshes())
    for (const int n_ranks : {1, 2, 3, 5, 8}) {
      SCOPED_TRACE(named.name + " on " + std::to_string(n_ranks));
      check(named.mesh, make_ranks(named.mesh, n_ranks));
    }
}

TEST(Part, each_node_is_owned_by_exactly_one_rank) {
  for_all_partitions([](const Mesh& mesh, const Ranks& ranks) {
    std::vector<int> n_owners(mesh.X.size(), 0);
    for (const Part& part : ranks.part)
      for (std::int32_t k = 0; k < part.n_owned; ++k) ++n_owners[part.node_global[k]];
    EXPECT_EQ(n_owners, std::vector<int>(mesh.X.size(), 1));
  });
}

TEST(Part, holds_exactly_the_elements_that_touch_an_owned_node) {
  for_all_partitions([](const Mesh& mesh, const Ranks& ranks) {
    for (std::size_t rank = 0; rank < ranks.part.size(); ++rank) {
      std::vector<std::int32_t> expected;
      for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
        const std::span<const std::int32_t> node = mesh.corners(e);
        if (std::any_of(node.begin(), node.end(), [&](std::int32_t i) {
              return ranks.owner[i] == static_cast<std::int32_t>(rank);
            }))
          expected.push_back(e);
      }
      EXPECT_EQ(ranks.part[rank].element_global, expected);
    }
  });
}

TEST(Part, has_a_local_number_for_each_corner_and_for_nothing_else) {
  for_all_partitions([](const Mesh& mesh, const Ranks& ranks) {
    for (const Part& part : ranks.part) {
      std::set<std::int32_t> needed(part.node_global.begin(),
                                    part.node_global.begin() + part.n_owned);
      for (const std::int32_t e : part.element_global)
        needed.insert(mesh.corners(e).begin(), mesh.corners(e).end());
      EXPECT_EQ(needed.size(), part.node_global.size());
      for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
        ASSERT_EQ(part.node_local[i] >= 0, needed.contains(i));
        if (part.node_local[i] < 0) continue;
        ASSERT_EQ(part.node_global[part.node_local[i]], i);
      }
    }
  });
}

TEST(Part, numbers_owned_nodes_first_and_both_kinds_ascending) {
  for_all_partitions([](const Mesh&, const Ranks& ranks) {
    for (const Part& part : ranks.part) {
      const auto middle = part.node_global.begin() + part.n_owned;
      EXPECT_TRUE(std::is_sorted(part.node_global.begin(), middle));
      EXPECT_TRUE(std::is_sorted(middle, part.node_global.end()));
    }
  });
}

using NodesByRanks = std::map<std::pair<int, int>, std::vector<std::int32_t>>;

TEST(Part, that_is_whole_owns_every_node_and_has_every_element) {
  for (const NamedMesh& named : all_meshes()) {
    const Part part = whole_part(named.mesh);
    EXPECT_EQ(part.n_owned, named.mesh.n_nodes());
    EXPECT_EQ(part.n_local(), named.mesh.n_nodes());
    EXPECT_EQ(std::ssize(part.element_global), named.mesh.n_elements());
  }
}

TEST(Halo, what_a_rank_sends_is_what_the_other_expects_in_the_same_order) {
  for_all_partitions([](const Mesh&, const Ranks& ranks) {
    NodesByRanks sent, received;  // (from, to) -> global numbers
    for (std::size_t r = 0; r < ranks.part.size(); ++r)
      for (const Halo::Neighbour& neighbour : ranks.halo[r].neighbours) {
        const int rank = static_cast<int>(r);
        for (const std::int32_t local : neighbour.send)
          sent[{rank, neighbour.rank}].push_back(ranks.part[r].node_global[local]);
        for (const std::int32_t local : neighbour.receive)
          received[{neighbour.rank, rank}].push_back(ranks.part[r].node_global[local]);
      }
    EXPECT_EQ(sent, received);
    for (const auto& [pair, nodes] : sent) EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
  });
}

TEST(Halo, fills_each_halo_node_once_from_its_owner) {
  for_all_partitions([](const Mesh&, const Ranks& ranks) {
    for (std::size_t r = 0; r < ranks.part.size(); ++r) {
      const Part& part = ranks.part[r];
      std::vector<int> n_fills(part.node_global.size(), 0);
      int last_rank = -1;
      for (const Halo::Neighbour& neighbour : ranks.halo[r].neighbours) {
        EXPECT_GT(neighbour.rank, last_rank);
        last_rank = neighbour.rank;
        for (const std::int32_t local : neighbour.send) EXPECT_LT(local, part.n_owned);
        for (const std::int32_t local : neighbour.receive) {
          ++n_fills[local];
          EXPECT_EQ(ranks.owner[part.node_global[local]], neighbour.rank);
        }
      }
      for (std::int32_t k = 0; k < part.n_local(); ++k)
        ASSERT_EQ(n_fills[k], k < part.n_owned ? 0 : 1);
    }
  });
}

TEST(HaloExchange, alone_leaves_the_field_as_it_is) {
  const Mesh mesh = make_rectangle(1, 1, 3, 3);
  const Ranks ranks = make_ranks(mesh, 1);
  Communicator alone;
  HaloExchange exchange(ranks.halo[0], 2);
  std::vector<double> field(18);
  for (std::size_t k = 0; k < field.size(); ++k) field[k] = static_cast<double>(k);
  const std::vector<double> before = field;
  exchange.exchange(field, alone);
  EXPECT_EQ(field, before);
}

TEST(GatherField, alone_gives_the_field_in_global_order) {
  const Mesh mesh = make_rectangle(1, 1, 3, 3);
  const Ranks ranks = make_ranks(mesh, 1);
  Communicator alone;
  std::vector<double> field(27);
  for (std::size_t k = 0; k < field.size(); ++k) field[k] = static_cast<double>(k) / 3;
  EXPECT_EQ(all_gather_field(ranks.part[0], 3, field, alone), field);
  EXPECT_EQ(gather_field(ranks.part[0], 3, field, alone), field);
}

TEST(ScatterField, gives_each_rank_the_values_of_its_nodes) {
  const Mesh mesh = make_rectangle(1, 1, 4, 4);
  const Ranks ranks = make_ranks(mesh, 2);
  std::vector<double> field(2 * mesh.X.size());
  for (std::size_t k = 0; k < field.size(); ++k) field[k] = static_cast<double>(k) / 3;
  for (const Part& part : ranks.part)
    for (const std::int32_t n : {part.n_owned, part.n_local()}) {
      const std::vector<double> local = scatter_field(part, 2, field, n);
      ASSERT_EQ(std::ssize(local), 2 * n);
      for (std::size_t k = 0; k < local.size(); ++k) {
        const auto node = static_cast<std::size_t>(part.node_global[k / 2]);
        EXPECT_EQ(local[k], field[2 * node + k % 2]);
      }
    }
}
