// Boxes of hexahedra, of six tetrahedra a cell (Kuhn) and of five a cell.
#include <algorithm>
#include <string>

#include "base/error.h"
#include "mesh/box_cells.h"
#include "mesh/generate.h"

namespace trocar {

// Corner (i, j, k) of the unit cell, one bit a direction: x = 1, y = 2, z = 4.
using Tetrahedron = std::array<unsigned, 4>;

// One tetrahedron for each monotone path from corner 000 to corner 111 (Kuhn, Freudenthal).
static constexpr std::array<Tetrahedron, 6> kuhn_tetrahedra = {
    {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};
// One at every second corner of the cell, and the regular one between these.
static constexpr std::array<Tetrahedron, 5> five_tetrahedra = {
    {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 1, 4, 7}, {6, 4, 2, 7}, {1, 2, 4, 7}}};
static constexpr std::array<unsigned, 8> vtk_hexahedron = {0, 1, 3, 2, 4, 5, 7, 6};

void check_cells(const std::array<int, 3>& n) {
  std::int64_t n_nodes = 1;
  for (const int cells : n) {
    if (cells < 1)
      throw InputError("a generated mesh needs at least 1 cell in each direction, not " +
                       std::to_string(cells));
    n_nodes *= std::int64_t{cells} + 1;
    if (n_nodes > max_generated_nodes)
      throw InputError("a generated mesh of " + std::to_string(n[0]) + " x " +
                       std::to_string(n[1]) + " x " + std::to_string(n[2]) +
                       " cells has more than " + std::to_string(max_generated_nodes) + " nodes");
  }
}

// Cell corners after mirroring in the directions whose bits are set; mirroring an odd number of
// times swaps two corners so that the volume stays positive.
static void add_tetrahedra(Mesh& mesh, const std::array<std::int32_t, 8>& node,
                           std::span<const Tetrahedron> tetrahedra, unsigned mirror) {
  const bool is_odd = ((mirror ^ mirror >> 1 ^ mirror >> 2) & 1U) != 0;
  for (const Tetrahedron& t : tetrahedra) {
    std::array<std::int32_t, 4> corner{};
    for (std::size_t a = 0; a < 4; ++a) corner[a] = node[t[a] ^ mirror];
    if (is_odd) std::swap(corner[2], corner[3]);
    add_element(mesh, ElementType::tet4, corner);
  }
}

static void add_cell(Mesh& mesh, const std::array<std::int32_t, 8>& node, BoxElements elements,
                     unsigned mirror) {
  if (elements == BoxElements::tet4_kuhn) {
    add_tetrahedra(mesh, node, kuhn_tetrahedra, mirror);
  } else if (elements == BoxElements::tet4_five) {
    add_tetrahedra(mesh, node, five_tetrahedra, mirror);
  } else {
    std::array<std::int32_t, 8> corner{};
    for (std::size_t a = 0; a < 8; ++a) corner[a] = node[vtk_hexahedron[a]];
    add_element(mesh, ElementType::hex8, corner);
  }
}

static NodeSet side_nodes(const std::array<int, 3>& n, std::size_t direction, bool is_high) {
  NodeSet set;
  set.name = std::string(1, "xyz"[direction]) + (is_high ? "+" : "-");
  std::int32_t node = 0;
  std::array<int, 3> i{};
  for (i[2] = 0; i[2] <= n[2]; ++i[2])
    for (i[1] = 0; i[1] <= n[1]; ++i[1])
      for (i[0] = 0; i[0] <= n[0]; ++i[0], ++node)
        if (i[direction] == (is_high ? n[direction] : 0)) set.node.push_back(node);
  return set;
}

void add_box_cells(Mesh& mesh, const std::array<int, 3>& n, BoxElements elements,
                   const CellMirror& mirror) {
  const std::int32_t row = n[0] + 1, layer = row * (n[1] + 1);
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        std::array<std::int32_t, 8> node{};
        for (int c = 0; c < 8; ++c)
          node[c] = i + (c & 1) + row * (j + (c >> 1 & 1)) + layer * (k + (c >> 2));
        add_cell(mesh, node, elements, mirror(i, j, k));
      }
  for (std::size_t direction = 0; direction < 3; ++direction) {
    mesh.node_sets.push_back(side_nodes(n, direction, false));
    mesh.node_sets.push_back(side_nodes(n, direction, true));
  }
}

unsigned alternate_mirror(int i, int j, int k) {
  return ((i + j + k) & 1) != 0 ? 7U : 0U;
}

// The last position is `high` to the last bit.
static double grid_position(double low, double high, int i, int n) {
  return i == n ? high : low + (high - low) * i / n;
}

Mesh make_box(const Vec3& low, const Vec3& high, const std::array<int, 3>& n,
              BoxElements elements) {
  check_cells(n);
  if (!(low.array() < high.array()).all())
    throw InputError("the low corner of a box must lie below the high corner in each direction");
  Mesh mesh;
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i)
        mesh.X.emplace_back(grid_position(low.x(), high.x(), i, n[0]),
                            grid_position(low.y(), high.y(), j, n[1]),
                            grid_position(low.z(), high.z(), k, n[2]));
  const auto no_mirror = [](int, int, int) { return 0U; };
  if (elements == BoxElements::tet4_five)
    add_box_cells(mesh, n, elements, alternate_mirror);
  else
    add_box_cells(mesh, n, elements, no_mirror);
  return mesh;
}

}  // namespace trocar
