// Elements in rows are gathered and added by whole registers: the same bits as one by one.
#include "solver/row_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "solver_body.h"

using namespace trocar;

namespace {

Mesh bent_box() {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.09, .02, .02), {19, 2, 2}, BoxElements::hex8);
  jitter(mesh, .2, 3);
  return mesh;
}

// The same elements, each turned about zeta: corners start elsewhere.
Mesh turned_box() {
  Mesh mesh = bent_box();
  const std::vector<std::int32_t> before = mesh.corner_node;
  constexpr std::array<std::size_t, 8> turned = {1, 2, 3, 0, 5, 6, 7, 4};
  for (std::size_t k = 0; k < before.size(); ++k)
    mesh.corner_node[k] = before[k / 8 * 8 + turned[k % 8]];
  return mesh;
}

// Copies that have no node in common, numbered corner by corner, the corners in the order of a box:
// nodes of a row follow each other, those of neighbouring corners don't.
Mesh separate_copies(const Mesh& single) {
  constexpr std::int32_t n_copies = 19;
  constexpr std::array<std::int32_t, 8> place = {0, 1, 3, 2, 4, 5, 7, 6};
  const std::int32_t n = single.n_nodes();
  const auto node = [&](std::int32_t a, std::int32_t copy) {
    return (n == 8 ? place[a] : a) * n_copies + copy;
  };
  Mesh mesh;
  mesh.X.resize(static_cast<std::size_t>(n * n_copies));
  for (std::int32_t copy = 0; copy < n_copies; ++copy) {
    std::vector<std::int32_t> corner;
    for (std::int32_t a = 0; a < n; ++a) {
      corner.push_back(node(a, copy));
      mesh.X[corner.back()] = single.X[a];
    }
    add_element(mesh, single.element_type[0], corner);
  }
  return mesh;
}

// How often each order of a row occurs.
std::map<std::uint32_t, int> rows_of(const Body& body) {
  std::map<std::uint32_t, int> n;
  for (const ElementBlocks& blocks : body.model.blocks)
    for (const std::uint32_t row : blocks.row)
      if (is_row(row)) ++n[row];
  return n;
}

std::vector<double> force_one_by_one(Body body) {
  for (ElementBlocks& blocks : body.model.blocks)
    std::fill(blocks.row.begin(), blocks.row.end(), no_row_at_end);
  return force(body);
}

// Of all instruction sets in both precisions.
void expect_same_bits(const Mesh& mesh, Formulation formulation) {
  for (const Precision precision : precisions) {
    Body body = make_body(mesh, {.solver = with(formulation, {.precision = precision})});
    put_node_by_node(body);
    shake(body.state.u, 5e-4, 11);
    EXPECT_FALSE(rows_of(body).empty());
    for (int i = 0; i < n_simd; ++i) {
      if (!is_supported(static_cast<Simd>(i))) continue;
      select_simd(name_of(static_cast<Simd>(i)));
      const std::vector<double> f = force(body);
      EXPECT_GT(largest(f), 0);
      EXPECT_EQ(f, force_one_by_one(body)) << name_of(static_cast<Simd>(i));
    }
    select_simd("auto");
  }
}

}  // namespace

// box_row is for boxes as make_box numbers them; the others reach the loops for any order.
TEST(RowOrder, hexahedra_of_a_box_are_in_the_order_that_kernels_know_beforehand) {
  EXPECT_EQ(rows_of(make_body(bent_box())).count(box_row), 1U);
  EXPECT_EQ(rows_of(make_body(turned_box())).count(box_row), 0U);
  EXPECT_EQ(rows_of(make_body(separate_copies(irregular_elements()[2]))).count(box_row), 1U);
}

TEST(RowOrder, rows_of_a_box_get_the_forces_of_its_elements_one_by_one) {
  for (const Formulation formulation : {Formulation::hex8_one_point, Formulation::hex8_full})
    for (const Mesh& mesh : {bent_box(), turned_box()}) expect_same_bits(mesh, formulation);
}

TEST(RowOrder, rows_without_common_nodes_get_the_forces_of_their_elements_one_by_one) {
  for (const Formulation formulation :
       {Formulation::tri3_plane_strain, Formulation::tet4, Formulation::hex8_one_point})
    expect_same_bits(
        separate_copies(irregular_elements()[static_cast<std::size_t>(shape_of(formulation))]),
        formulation);
}
