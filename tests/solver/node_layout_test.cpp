// Nodal fields component by component: the same bits as node by node.
#include "solver/node_layout.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "solver/block_ranges.h"
#include "solver/row_order.h"
#include "solver/sum_order.h"
#include "solver_body.h"

using namespace trocar;

namespace {

Mesh straight_box(int nx, int ny, int nz) {
  return make_box(Vec3(.1, .2, .3), Vec3(.1, .2, .3) + .01 * Vec3(nx, ny, nz), {nx, ny, nz},
                  BoxElements::hex8);
}

Mesh jittered_box(int nx, int ny, int nz) {
  Mesh mesh = straight_box(nx, ny, nz);
  Noise noise(5);
  for (Vec3& X : mesh.X) X += .001 * Vec3(noise(), noise(), noise());
  return mesh;
}

// A few blocks stand anyhow.
Mesh with_disorder(Mesh mesh) {
  for (std::size_t e = 20; e + 90 < mesh.element_type.size(); e += 90)
    for (std::size_t a = 0; a < 8; ++a)
      std::swap(mesh.corner_node[8 * e + a], mesh.corner_node[8 * (e + 3) + a]);
  return mesh;
}

// Forces in either layout on every instruction set; whether they lie by component at all.
bool have_same_bits(const Mesh& mesh, const SolverOptions& solver) {
  Body by_component = make_body(mesh, {.solver = solver});
  shake(by_component.state.u, 5e-4, 11);
  Body node_by_node = by_component;
  put_node_by_node(node_by_node);
  for (int i = 0; i < n_simd; ++i) {
    if (!is_supported(static_cast<Simd>(i))) continue;
    select_simd(name_of(static_cast<Simd>(i)));
    EXPECT_GT(largest(force(node_by_node)), 0);
    for (int again = 0; again < 2; ++again)  // sums have to be zero again
      EXPECT_EQ(force(by_component), force(node_by_node)) << name_of(static_cast<Simd>(i));
  }
  select_simd("auto");
  return by_component.model.is_by_component;
}

void check_stride_nodes(const Model& model) {
  const ElementBlocks& blocks = model.blocks[0];
  const std::int64_t n = corners_of_block(blocks), n_blocks = blocks.n_blocks;
  std::int64_t block = 0, n_left_out = 0;
  for (const auto& [own, halo] : model.sums.stride_nodes) {
    const std::int64_t end = std::min(block + stride_blocks, n_blocks);
    for (std::int64_t k = block * n; k < end * n; ++k) {
      const std::int32_t i = blocks.corner[k];
      const bool is_in = (own.begin <= i && i < own.end) || (halo.begin <= i && i < halo.end);
      n_left_out += is_in ? 0 : 1;
    }
    block = end;
  }
  EXPECT_EQ(n_left_out, 0);
}

constexpr Formulation hexahedra[] = {Formulation::hex8_one_point, Formulation::hex8_enhanced,
                                     Formulation::hex8_full};

}  // namespace

static std::int32_t n_aligned(const Mesh& mesh) {
  return make_body(mesh).model.blocks[0].n_aligned;
}

// Boxes along the axes have kernels of their own.
TEST(NodeLayout, aligned_boxes_have_the_bits_of_any_hexahedra) {
  for (const Formulation formulation : hexahedra)
    for (const Precision precision : precisions)
      for (int nx = 16; nx <= 34; nx += 3) {
        const SolverOptions solver = with(formulation, {.precision = precision});
        const Mesh straight = straight_box(nx, 5, 4), some = with_disorder(straight_box(nx, 12, 9));
        EXPECT_TRUE(have_same_bits(straight, solver)) << nx;
        EXPECT_TRUE(have_same_bits(some, solver)) << nx;
        EXPECT_GT(n_aligned(straight), 0);
        EXPECT_GT(n_aligned(some), 0);
        EXPECT_LT(n_aligned(some), make_body(some).model.blocks[0].n_blocks);
      }
}

TEST(NodeLayout, blocks_are_aligned_where_all_their_edges_lie_along_the_axes) {
  EXPECT_EQ(n_aligned(straight_box(24, 6, 5)), 90);
  EXPECT_EQ(n_aligned(jittered_box(24, 6, 5)), 0);
  Mesh mesh = straight_box(24, 6, 5);
  mesh.X[30][1] += 1e-12;  // of the lowest layer, its second row
  EXPECT_EQ(n_aligned(mesh), 90 - 2);
  mesh = straight_box(24, 6, 5);
  for (Vec3& X : mesh.X) X = Vec3(X[1], -X[0], X[2]);
  EXPECT_EQ(n_aligned(mesh), 0);
}

// Rows of every length end anywhere in a block; those of 3 end in it more than once.
TEST(NodeLayout, by_component_gives_the_bits_of_node_by_node) {
  for (const Precision precision : precisions)
    for (int nx = 3; nx <= 24; ++nx) {
      const bool is_by_component = have_same_bits(jittered_box(nx, 5, 4), {.precision = precision});
      if (nx >= 16 || nx == 3) {
        EXPECT_EQ(is_by_component, nx >= 16) << nx;
      }
    }
}

TEST(NodeLayout, by_component_gives_the_bits_of_node_by_node_whatever_the_hexahedron) {
  for (const Formulation formulation : hexahedra)
    for (const Precision precision : precisions)
      for (const int nx : {20, 32})
        EXPECT_TRUE(have_same_bits(with_disorder(jittered_box(nx, 8, 8)),
                                   with(formulation, {.precision = precision})));
}

TEST(NodeLayout, by_component_gives_the_bits_of_node_by_node_on_several_threads) {
  for (const Precision precision : precisions)
    for (const int n_threads : {2, 3}) {
      set_thread_count(n_threads);
      EXPECT_TRUE(have_same_bits(jittered_box(20, 20, 12), {.precision = precision}));
      EXPECT_TRUE(have_same_bits(straight_box(20, 20, 12), {.precision = precision}));
    }
  set_thread_count(1);
}

// In a part, rows lead from its own nodes into the halo: no node between is left out.
TEST(NodeLayout, strides_take_all_nodes_of_their_rows) {
  int n_rows = 0;
  for (const Mesh& mesh : {jittered_box(13, 18, 23), jittered_box(20, 20, 20)})
    for (int n_ranks = 1; n_ranks <= 5; ++n_ranks) {
      const std::vector<std::int32_t> owner = partition_nodes(mesh, n_ranks);
      for (int rank = 0; rank < n_ranks; ++rank)
        for (const Precision precision : precisions) {
          const Body body = make_body(mesh, {.solver = {.precision = precision}}, owner, rank);
          n_rows += body.model.is_by_component ? 1 : 0;
          check_stride_nodes(body.model);
        }
    }
  EXPECT_GT(n_rows, 20);
}

// A window holds 4096 nodes here and the box 18,081; in threads' halves too.
TEST(NodeLayout, windows_that_begin_anew_keep_the_bits) {
  for (const Mesh& mesh : {jittered_box(20, 6, 122), straight_box(20, 6, 122)})
    for (const int n_threads : {1, 2}) {
      set_thread_count(n_threads);
      for (const Precision precision : precisions) {
        EXPECT_TRUE(have_same_bits(mesh, {.precision = precision}));
        const Body body = make_body(mesh, {.solver = {.precision = precision}});
        EXPECT_LT(body.scratch.u_by_component.size(), 3 * mesh.X.size());
      }
    }
  set_thread_count(1);
}

// Of bodies that no cache holds, lines are asked for ahead, in either layout.
TEST(NodeLayout, large_bodies_have_the_same_bits_too) {
  const Mesh mesh = jittered_box(60, 60, 60);
  for (const Precision precision : precisions) {
    Body body = make_body(mesh, {.solver = {.precision = precision}});
    EXPECT_GT(memory_bytes(body.model, body.scratch), std::size_t{24} << 20);
    shake(body.state.u, 5e-4, 11);
    Body node_by_node = body;
    put_node_by_node(node_by_node);
    for (int k = 0; k < 2; ++k) {
      step_freely(body, 1e-6);
      step(node_by_node, 1e-6);
    }
    EXPECT_EQ(body.state.u, node_by_node.state.u);
  }
}

TEST(NodeLayout, is_by_component_only_where_most_blocks_are_hexahedra_in_rows) {
  EXPECT_TRUE(make_body(jittered_box(20, 6, 6)).model.is_by_component);
  EXPECT_FALSE(make_body(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {20, 6, 6}, BoxElements::tet4_kuhn))
                   .model.is_by_component);
  Mesh disordered = jittered_box(20, 6, 6);
  for (std::size_t e = 0; e + 8 < disordered.element_type.size(); e += 9)
    for (std::size_t a = 0; a < 8; ++a)
      std::swap(disordered.corner_node[8 * e + a], disordered.corner_node[8 * (e + 3) + a]);
  EXPECT_FALSE(make_body(disordered).model.is_by_component);
}

// Of elements 0 to 7 all stand in the first row of 20, of 16 to 23 four, of 20 to 27 all in the
// second one.
TEST(NodeLayout, tells_where_rows_end) {
  const Body body = make_body(jittered_box(20, 6, 6));
  const std::vector<std::uint32_t>& row_break = body.model.blocks[0].row_break;
  std::vector<int> lane, skip;
  for (int block = 0; block < 16; ++block) {
    lane.push_back(lane_of_break(row_break[block]));
    skip.push_back(skip_of_break(row_break[block]));
  }
  // The first layer ends with element 119, the last of a block; of elements 8 k to 8 k + 7 a row
  // ends behind number 19, 39, …
  EXPECT_EQ(lane, (std::vector<int>{8, 8, 4, 8, 8, 8, 8, 4, 8, 8, 8, 8, 4, 8, 8, 8}));
  EXPECT_EQ(skip, (std::vector<int>{0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0}));
}

// A layer of 20 x 5 elements ends behind the fourth of a block; its last row of nodes is skipped.
TEST(NodeLayout, tells_where_layers_end) {
  const Body body = make_body(jittered_box(20, 5, 6));
  const std::uint32_t row_break = body.model.blocks[0].row_break[12];
  EXPECT_EQ(lane_of_break(row_break), 4);
  EXPECT_EQ(skip_of_break(row_break), 1 + 21);
}

// Nodes are taken over stride by stride.
TEST(NodeLayout, knows_the_nodes_of_each_stride) {
  const Body body = make_body(jittered_box(20, 20, 3));
  const SumOrder& sums = body.model.sums;
  ASSERT_EQ(sums.stride_nodes.size(), 5U);  // 150 blocks
  // 256 elements: 12 rows of 20 and 16 of the next one; nodes of the plane above, too.
  EXPECT_EQ(sums.stride_nodes[0], (StrideNodes{{0, 441 + 13 * 21 + 17}, {}}));
  EXPECT_EQ(sums.stride_nodes.back().own.end, body.model.n_local);
}
