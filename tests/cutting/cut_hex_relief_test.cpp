// What conversions leave out of an hourglass deformation.
#include "cutting/cut_hex_relief.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "mesh/generate.h"
#include "mesh/hex_split.h"

namespace trocar {
namespace {

using Shift = std::function<Vec3(const Vec3&)>;

// A body of hexahedra all of which are converted, and its tetrahedra.
struct Converted {
  explicit Converted(std::array<int, 3> cells)
      : body(make_box({-1, -1, -1}, {2.0 * cells[0] - 1, 1, 1}, cells, BoxElements::hex8)) {
    for (std::int32_t e = 0; e < body.n_elements(); ++e) {
      HexSplit split{.element = e};
      const auto local = hex_tets(body, e);
      for (std::size_t k = 0; k < n_hex_tets; ++k)
        for (std::size_t a = 0; a < 4; ++a)
          split.corner[k][a] = body.corners(e)[static_cast<std::size_t>(local[k][a])];
      edit.splits.push_back(split);
    }
    tets = body;
    apply_edit(edit, tets);
    is_held.assign(body.X.size(), 0);
  }

  void deform(const Shift& shift) {
    x = body.X;
    for (Vec3& position : x) position += shift(position);
  }
  // Present positions after the edit.
  std::vector<Vec3> relieved() {
    CutIndex index;
    update_index(tets, index);
    relieve_hourglass(body, x, is_held, tets, index, edit);
    std::vector<Vec3> result = x;
    for (const NodeMove& move : edit.moves) {
      EXPECT_EQ(move.X, body.X[move.node]);
      result[move.node].setZero();
      for (std::size_t a = 0; a < 8; ++a)
        result[move.node] += move.weight[a] * x[body.corners(move.host)[a]];
    }
    return result;
  }

  Mesh body, tets;
  MeshEdit edit;
  std::vector<Vec3> x;
  std::vector<std::uint8_t> is_held;
};

std::int32_t node_at(const Mesh& mesh, const Vec3& X) {
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if ((mesh.X[i] - X).norm() < 1e-9) return i;
  return -1;
}

// The cell is the cube of edge 2 around the origin, so that an hourglass mode is a product of
// coordinates there.
const Shift twist = [](const Vec3& X) { return Vec3(0, 0, 0.1 * X.x() * X.y()); };

// Sums of eight terms of order 1.
constexpr double rounding = 1e-14;

TEST(CutHexRelief, affine_motion_stays_what_it_is_and_needs_no_move) {
  Converted cells({2, 1, 1});
  Mat3 F;
  F << 0.1, 0.2, -0.1, 0, 0.3, 0.1, 0.2, 0, -0.2;
  cells.deform([&](const Vec3& X) { return Vec3(F * X + Vec3(1, 2, 3)); });
  cells.relieved();
  EXPECT_TRUE(cells.edit.moves.empty());
}

TEST(CutHexRelief, half_of_an_hourglass_deformation_is_left_out_beside_affine_motion) {
  Converted cell({1, 1, 1});
  const auto stretch = [](const Vec3& X) { return Vec3(0.2 * X.x(), 0.1 * X.z(), 0); };
  cell.deform([&](const Vec3& X) { return Vec3(stretch(X) + twist(X)); });
  const std::vector<Vec3> x = cell.relieved();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3& X = cell.body.X[i];
    EXPECT_LT((x[i] - (X + stretch(X) + 0.5 * twist(X))).norm(), rounding);
  }
}

TEST(CutHexRelief, a_node_that_its_hexahedra_pull_to_opposite_sides_stays) {
  // A bend: u_x = 0.1 x y has residuals +0.1 y and -0.1 y of the two cells at their facet x = 1.
  Converted cells({2, 1, 1});
  cells.deform([](const Vec3& X) { return Vec3(0.1 * X.x() * X.y(), 0, 0); });
  const std::vector<Vec3> x = cells.relieved();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool is_common = cells.body.X[i].x() == 1;
    EXPECT_EQ((x[i] - cells.x[i]).norm() > 0.01, !is_common);
  }
}

TEST(CutHexRelief, held_nodes_stay) {
  Converted cell({1, 1, 1});
  cell.is_held[3] = 1;
  cell.deform(twist);
  const std::vector<Vec3> x = cell.relieved();
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_LT((x[i] - (cell.body.X[i] + (i == 3 ? 1.0 : 0.5) * twist(cell.body.X[i]))).norm(),
              rounding);
}

TEST(CutHexRelief, nodes_that_would_invert_a_tetrahedron_on_the_cell_stay) {
  // The upper node at (1, -1) lies 0.1 below its place and would rise by 0.05; the tip of the
  // tetrahedron is 0.04 above it.
  Converted cell({1, 1, 1});
  cell.deform(twist);
  const std::array<std::int32_t, 3> base = {node_at(cell.body, {-1, -1, 1}),
                                            node_at(cell.body, {1, -1, 1}),
                                            node_at(cell.body, {1, 1, 1})};
  cell.tets.X.emplace_back(1, -1, 1.5);
  cell.body.X.emplace_back(1, -1, 1.5);
  cell.is_held.push_back(0);
  cell.x.emplace_back(1, -1, 1 - 0.1 + 0.04);
  const std::int32_t tip = cell.body.n_nodes() - 1;
  add_element(cell.tets, ElementType::tet4, std::array{base[0], base[1], base[2], tip});
  const std::vector<Vec3> x = cell.relieved();
  for (std::int32_t i = 0; i < tip; ++i) {
    const bool is_base = std::find(base.begin(), base.end(), i) != base.end();
    EXPECT_LT((x[i] - (cell.body.X[i] + (is_base ? 1.0 : 0.5) * twist(cell.body.X[i]))).norm(),
              rounding);
  }
}

}  // namespace
}  // namespace trocar
