// The plane meshes of Serby, Harders and Szekely 2001, Table 1.
#include <cmath>
#include <string>

#include "base/error.h"
#include "mesh/box_cells.h"
#include "mesh/generate.h"

namespace trocar {

static void check_plane(double width, double height, int n, int n_rows) {
  if (!(width > 0) || !(height > 0))
    throw InputError("a plane mesh needs a positive width and height");
  if (n < 2 || n_rows < 2)
    throw InputError("a plane mesh needs at least 2 nodes in each direction, not " +
                     std::to_string(n) + " x " + std::to_string(n_rows));
  if (static_cast<std::int64_t>(n) * n_rows > max_generated_nodes)
    throw InputError("a plane mesh of " + std::to_string(n) + " x " + std::to_string(n_rows) +
                     " nodes has more than " + std::to_string(max_generated_nodes));
}

static void add_triangle(Mesh& mesh, std::int32_t a, std::int32_t b, std::int32_t c) {
  add_element(mesh, ElementType::tri3, std::array<std::int32_t, 3>{a, b, c});
}

// Sets of the four sides from the first node of each row; the last entry is the number of nodes.
static void add_side_sets(Mesh& mesh, const std::vector<std::int32_t>& row_begin) {
  NodeSet left{"x-", {}}, right{"x+", {}}, bottom{"y-", {}}, top{"y+", {}};
  for (std::size_t row = 0; row + 1 < row_begin.size(); ++row) {
    left.node.push_back(row_begin[row]);
    right.node.push_back(row_begin[row + 1] - 1);
  }
  for (std::int32_t i = 0; i < row_begin[1]; ++i) bottom.node.push_back(i);
  for (std::int32_t i = row_begin.end()[-2]; i < row_begin.back(); ++i) top.node.push_back(i);
  mesh.node_sets = {left, right, bottom, top};
}

Mesh make_rectangle(double width, double height, int nx, int ny) {
  check_plane(width, height, nx, ny);
  Mesh mesh;
  std::vector<std::int32_t> row_begin;
  for (int j = 0; j < ny; ++j) {
    row_begin.push_back(mesh.n_nodes());
    for (int i = 0; i < nx; ++i)
      mesh.X.emplace_back(width * i / (nx - 1), height * j / (ny - 1), 0.0);
  }
  row_begin.push_back(mesh.n_nodes());
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      const std::int32_t a = j * nx + i, above = a + nx;
      add_triangle(mesh, a, a + 1, above + 1);
      add_triangle(mesh, a, above + 1, above);
    }
  add_side_sets(mesh, row_begin);
  return mesh;
}

// Triangles between a row of n nodes from `longer` on and one of n - 1 from `shorter` on, left to
// right.
static void add_strip(Mesh& mesh, std::int32_t longer, std::int32_t shorter, int n) {
  const bool is_long_below = longer < shorter;
  const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    is_long_below ? add_triangle(mesh, a, b, c) : add_triangle(mesh, a, c, b);
  };
  for (std::int32_t i = 0; i + 1 < n; ++i) {
    add(longer + i, longer + i + 1, shorter + i);
    if (i + 2 < n) add(longer + i + 1, shorter + i + 1, shorter + i);
  }
}

Mesh make_triangular_rectangle(double width, int n, int rows) {
  check_plane(width, width, n, rows);
  if (n < 3) throw InputError("rows that alternate between n and n - 1 nodes need n >= 3");
  Mesh mesh;
  const double side = width / (n - 1), row_height = side * std::sqrt(3.0) / 2;
  std::vector<std::int32_t> row_begin;
  for (int j = 0; j < rows; ++j) {
    row_begin.push_back(mesh.n_nodes());
    const int is_short = j % 2;
    for (int i = 0; i < n - is_short; ++i)
      mesh.X.emplace_back(width * (2 * i + is_short) / (2 * (n - 1)), row_height * j, 0.0);
  }
  row_begin.push_back(mesh.n_nodes());
  for (int j = 0; j + 1 < rows; ++j) {
    const bool is_long_below = j % 2 == 0;
    add_strip(mesh, row_begin[is_long_below ? j : j + 1], row_begin[is_long_below ? j + 1 : j], n);
  }
  add_side_sets(mesh, row_begin);
  return mesh;
}

}  // namespace trocar
