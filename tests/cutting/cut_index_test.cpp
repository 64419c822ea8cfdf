#include "cutting/cut_index.h"

#include <gtest/gtest.h>

#include "cutting/cut_patch.h"
#include "cutting/cut_split.h"
#include "cutting_tet.h"
#include "known_positions.h"

namespace trocar {
namespace {

using namespace cutting_test;

TEST(CutIndex, that_was_edited_is_the_index_of_the_edited_mesh) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {5, 5, 5}, BoxElements::tet4_five));
  CutIndex index = index_of(body.mesh);
  ASSERT_GT(cut_with_index(Vec3(1, 0.5, 0.2), body, index).n_edits, 3);
  const CutIndex fresh = index_of(body.mesh);
  ASSERT_EQ(index.star_size, fresh.star_size);
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    EXPECT_TRUE(std::ranges::equal(index.star(i), fresh.star(i))) << i;
  EXPECT_EQ(index.is_surface, fresh.is_surface);
}

// Nodes on edges of the surface and within, far from each other.
TEST(CutIndex, whose_elements_were_split_is_the_index_of_the_edited_mesh) {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {5, 5, 5}, BoxElements::tet4_five);
  jitter(mesh, 0.2, 7);
  CutIndex index = index_of(mesh);
  std::vector<std::int32_t> all;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) all.push_back(e);
  std::vector<EdgeNode> inserted;
  for (const std::int32_t e : {0, 62, 310, 620}) {
    const std::span<const std::int32_t> c = mesh.corners(e);
    inserted.push_back({.end = {std::min(c[0], c[1]), std::max(c[0], c[1])}, .s = 0.4});
  }
  std::ranges::sort(inserted, {}, &EdgeNode::end);
  const MeshEdit edit = split_edges(mesh, all, inserted);
  ASSERT_GT(edit.splits.size(), inserted.size());
  edit_index(mesh, edit, index);
  apply_edit(edit, mesh);

  ASSERT_TRUE(is_index_of(index, mesh));
  CutIndex fresh = index_of(mesh);
  ASSERT_EQ(index.star_size, fresh.star_size);
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    EXPECT_TRUE(std::ranges::equal(index.star(i), fresh.star(i))) << i;
  EXPECT_EQ(index.is_surface, fresh.is_surface);
  EXPECT_GT(std::count(fresh.is_surface.end() - 4, fresh.is_surface.end(), 0), 0);
  EXPECT_GT(std::count(fresh.is_surface.end() - 4, fresh.is_surface.end(), 1), 0);
}

// Found patch by patch, and forgotten where an edit parts elements.
TEST(CutIndex, that_was_edited_knows_no_neighbours_but_those_of_the_edited_mesh) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {5, 5, 5}, BoxElements::tet4_five));
  CutIndex index = index_of(body.mesh);
  const auto find_neighbours = [&](int k) {
    std::vector<std::int32_t> seeds;
    for (std::int32_t e = k % 3; e < body.mesh.n_elements(); e += 100) seeds.push_back(e);
    KnownPositions positions(body.mesh, body.x);
    make_patch(body.mesh, index, positions, {body.is_held}, seeds);
  };
  const auto check = [&] {
    const FacetNeighbours expected = facet_neighbours(body.mesh);
    std::ptrdiff_t n_known = 0;
    for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e)
      for (int f = 0; f < 4; ++f) {
        const std::int32_t u = index.across[e][f];
        if (u == not_known) continue;
        ++n_known;
        ASSERT_EQ(u, expected.of(e, f)) << e << ", facet " << f;
      }
    EXPECT_GT(n_known, body.mesh.n_elements());
  };
  const Ledger ledger = cut_with_index(Vec3(1, 0.5, 0.2), body, index, find_neighbours, check);
  EXPECT_GT(ledger.n_edits, 3);
}

TEST(CutIndex, knows_the_nodes_of_the_surface) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::hex8}) {
    const Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {4, 5, 3}, elements);
    std::vector<std::uint8_t> expected(mesh.X.size(), 0);
    for (const std::int32_t i : boundary_surface(mesh).node) expected[i] = 1;
    EXPECT_EQ(index_of(mesh).is_surface, expected);
  }
}

TEST(CutIndex, gives_a_patch_of_three_rings_around_its_seeds) {
  const Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {9, 9, 9}, BoxElements::tet4_kuhn);
  CutIndex index = index_of(mesh);
  const std::vector<std::uint8_t> is_held(mesh.X.size(), 0);
  const std::vector<std::int32_t> seeds{6 * (4 + 9 * (4 + 9 * 4))};  // in the middle cell
  KnownPositions positions(mesh, mesh.X);
  const CutPatch patch = make_patch(mesh, index, positions, {is_held}, seeds);
  // Brute force: rings by passes over all elements.
  std::vector<int> ring(mesh.X.size(), 9);
  for (const std::int32_t i : mesh.corners(seeds[0])) ring[i] = 0;
  std::vector<std::int32_t> expected;
  for (int next = 1; next <= n_cut_rings; ++next) {
    expected.clear();
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
      int least = 9;
      for (const std::int32_t i : mesh.corners(e)) least = std::min(least, ring[i]);
      if (least < next) expected.push_back(e);
    }
    for (const std::int32_t e : expected)
      for (const std::int32_t i : mesh.corners(e)) ring[i] = std::min(ring[i], next);
  }
  EXPECT_EQ(patch.element, expected);
  for (std::int32_t i = 0; i < patch.n_nodes(); ++i)
    EXPECT_EQ(int(patch.node_ring[i]), ring[patch.node[i]]);
  EXPECT_TRUE(std::ranges::all_of(index.ring, [](int r) { return r == no_ring; }));
}

}  // namespace
}  // namespace trocar
