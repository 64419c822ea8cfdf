// From the cells of a file to a sound Mesh: which cells are elements, which nodes they use, which
// way round they are.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/box.h"
#include "base/check.h"
#include "base/error.h"
#include "base/log.h"
#include "base/number_text.h"
#include "mesh/raw_mesh.h"
#include "mesh/raw_mesh_groups.h"

namespace trocar {

namespace {

std::array<std::int64_t, 6> count_kinds(const RawMesh& raw) {
  std::array<std::int64_t, 6> n{};
  for (const CellKind kind : raw.cell_kind) ++n[static_cast<std::size_t>(kind)];
  return n;
}

// All in one plane z = const, up to the rounding of whoever wrote the file.
bool is_plane(const RawMesh& raw) {
  Box box;
  for_cells(raw, 2, [&](std::int32_t, std::span<const std::int32_t> corners) {
    for (const std::int32_t i : corners) box.add(raw.X[i]);
  });
  const Vec3 size = box.size();
  return size.z() <= 1e-9 * std::max(size.x(), size.y());
}

std::string place_text(const RawMesh& raw, std::int32_t e, std::int32_t cell) {
  return raw.file + ": element " + std::to_string(e) + " (" + raw.tag_word + " " +
         std::to_string(raw.cell_tag[cell]) + ")";
}

[[noreturn]] void fail_quadrangle(const RawMesh& raw) {
  const auto first = std::find(raw.cell_kind.begin(), raw.cell_kind.end(), CellKind::quadrangle);
  const auto c = static_cast<std::int32_t>(first - raw.cell_kind.begin());
  throw InputError(place_text(raw, c, c) +
                   " is a quadrangle: a plane mesh is made of triangles only");
}

// 3 if there are volume elements, 2 for a plane mesh.
int element_dimension(const RawMesh& raw) {
  const auto [n_point, n_line, n_triangle, n_quadrangle, n_tetrahedron, n_hexahedron] =
      count_kinds(raw);
  if (n_tetrahedron + n_hexahedron > 0) return 3;
  if (n_triangle + n_quadrangle == 0)
    throw InputError(raw.file + ": holds no elements (" + std::to_string(n_line) + " lines and " +
                     std::to_string(n_point) +
                     " points): a mesh is made of tetrahedra, hexahedra or plane triangles");
  if (is_plane(raw)) {
    if (n_quadrangle > 0) fail_quadrangle(raw);
    return 2;
  }
  std::string count = std::to_string(n_triangle) + " triangles";
  if (n_quadrangle > 0) count += ", " + std::to_string(n_quadrangle) + " quadrangles";
  fail_surface(raw.file, count);
}

// Keeps the nodes of elements, in the order of the file. New number of each node, -1 if dropped.
std::vector<std::int32_t> take_nodes(const RawMesh& raw, int dimension, double scale, Mesh& mesh) {
  std::vector<std::int32_t> new_node(raw.X.size(), -1);
  for_cells(raw, dimension, [&](std::int32_t, std::span<const std::int32_t> corners) {
    for (const std::int32_t i : corners) new_node[i] = 0;
  });
  mesh.X.reserve(raw.X.size() -
                 static_cast<std::size_t>(std::count(new_node.begin(), new_node.end(), -1)));
  double height = 0;  // of a plane mesh
  for (std::size_t i = 0; i < raw.X.size(); ++i) {
    if (new_node[i] < 0) continue;
    new_node[i] = mesh.n_nodes();
    Vec3 x = raw.X[i] * scale;
    if (dimension == 2) height = std::exchange(x.z(), 0.0);
    if (!x.allFinite())
      throw InputError(raw.file + ": a node lies at a position that is not finite when scaled by " +
                       short_text(scale, 4));
    mesh.X.push_back(x);
  }
  if (std::abs(height) > 1e-6)
    log_warning(raw.file + ": is a plane mesh at z = " + short_text(height, 4) +
                " m; plane bodies lie at z = 0, and so does this one now");
  return new_node;
}

ElementType element_type(CellKind kind) {
  if (kind == CellKind::triangle) return ElementType::tri3;
  return kind == CellKind::tetrahedron ? ElementType::tet4 : ElementType::hex8;
}

void take_elements(const RawMesh& raw, int dimension, std::span<const std::int32_t> new_node,
                   Mesh& mesh) {
  const std::vector<std::int32_t> region = make_regions(raw, dimension, mesh);
  std::size_t n = 0, n_corners_all = 0;
  for_cells(raw, dimension, [&](std::int32_t, std::span<const std::int32_t> corners) {
    ++n;
    n_corners_all += corners.size();
  });
  mesh.element_type.reserve(n);
  mesh.corner_offset.reserve(n);
  mesh.corner_node.reserve(n_corners_all);
  mesh.element_region.reserve(n);
  mesh.density_factor.reserve(n);
  mesh.cut_facets.reserve(n);
  std::array<std::int32_t, max_corners> node{};
  for_cells(raw, dimension, [&](std::int32_t c, std::span<const std::int32_t> corners) {
    for (std::size_t a = 0; a < corners.size(); ++a) node[a] = new_node[corners[a]];
    add_element(mesh, element_type(raw.cell_kind[c]), std::span(node.data(), corners.size()),
                region[raw.cell_group[c]]);
  });
}

double longest_edge(const Mesh& mesh, std::int32_t e) {
  double longest2 = 0;
  for (const std::int32_t i : mesh.corners(e))
    for (const std::int32_t j : mesh.corners(e))
      longest2 = std::max(longest2, (mesh.X[i] - mesh.X[j]).squaredNorm());
  return std::sqrt(longest2);
}

bool has_repeated_corner(std::span<const std::int32_t> corners) {
  for (std::size_t a = 0; a < corners.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (corners[a] == corners[b]) return true;
  return false;
}

// Number of the cell that became element e.
std::int32_t cell_of_element(const RawMesh& raw, int dimension, std::int32_t e) {
  std::int32_t cell = 0, next = 0;
  for_cells(raw, dimension, [&](std::int32_t c, std::span<const std::int32_t>) {
    if (next++ == e) cell = c;
  });
  return cell;
}

std::string volume_text(const Mesh& mesh, double volume) {
  return mesh.dimension() == 2 ? "area " + short_text(volume, 4) + " m^2"
                               : "volume " + short_text(volume, 4) + " m^3";
}

[[noreturn]] void fail_element(const RawMesh& raw, const Mesh& mesh, std::int32_t e,
                               const std::string& sentence) {
  const std::int32_t cell = cell_of_element(raw, mesh.dimension(), e);
  throw InputError(place_text(raw, e, cell) + " " + sentence);
}

// Volume of an element that is neither flat nor beyond the range of double.
double sound_volume(const RawMesh& raw, const Mesh& mesh, std::int32_t e) {
  if (has_repeated_corner(mesh.corners(e)))
    fail_element(raw, mesh, e, "has one node at two corners");
  const double volume = element_volume(mesh, e, mesh.X);
  const double edge = longest_edge(mesh, e);
  const double cube = mesh.element_type[e] == ElementType::tri3 ? edge * edge : edge * edge * edge;
  if (!std::isfinite(cube) || !std::isfinite(volume))
    fail_element(raw, mesh, e, "is too large: its longest edge is " + short_text(edge, 4) + " m");
  // Not <=: the volume of a tiny element may underflow to zero together with the cube.
  if (!(std::abs(volume) > 1e-12 * cube))
    fail_element(raw, mesh, e,
                 "is flat: " + volume_text(mesh, volume) + " with edges up to " +
                     short_text(edge, 4) + " m");
  return volume;
}

void mirror(Mesh& mesh, std::int32_t e) {
  std::int32_t* node = mesh.corner_node.data() + mesh.corner_offset[e];
  if (mesh.element_type[e] == ElementType::hex8)
    std::swap_ranges(node, node + 4, node + 4);
  else
    std::swap(node[1], node[2]);
}

// Some programs number all corners the other way round: that is a convention. A mixture is a broken
// mesh.
void orient_elements(const RawMesh& raw, Mesh& mesh) {
  std::int32_t n_inverted = 0, first = -1;
  double first_volume = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const double volume = sound_volume(raw, mesh, e);
    if (volume > 0) continue;
    if (n_inverted++ > 0) continue;
    first = e;
    first_volume = volume;
  }
  if (n_inverted == 0) return;
  if (n_inverted < mesh.n_elements())
    fail_element(raw, mesh, first,
                 "is inverted: " + volume_text(mesh, first_volume) + " (" +
                     std::to_string(n_inverted) + " of " + std::to_string(mesh.n_elements()) +
                     " elements are)");
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) mirror(mesh, e);
}

// Cells below the elements' dimension have none.
void take_fibres(const RawMesh& raw, int dimension, Mesh& mesh) {
  if (raw.fibre.empty()) return;
  std::vector<std::int32_t> element(raw.cell_kind.size(), -1);
  std::int32_t next = 0;
  for_cells(raw, dimension,
            [&](std::int32_t c, std::span<const std::int32_t>) { element[c] = next++; });
  mesh.fibre.assign(mesh.element_type.size(), Vec3::Zero());
  for (const auto& [cell, direction] : raw.fibre) {
    const std::int32_t e = element[cell];
    if (e < 0) continue;
    const double length = std::sqrt(direction.dot(direction));
    if (!(length > 0) || !std::isfinite(length))
      fail_element(raw, mesh, e, "has a fibre direction of length " + short_text(length, 4));
    mesh.fibre[e] = direction / length;
  }
}

}  // namespace

Mesh make_mesh(RawMesh raw, double scale) {
  CHECK(std::isfinite(scale) && scale > 0);
  const int dimension = element_dimension(raw);
  Mesh mesh;
  {
    const std::vector<std::int32_t> new_node = take_nodes(raw, dimension, scale, mesh);
    raw.X = {};
    raw.node_tag = {};
    const GroupNumbers groups = number_groups_below(raw, dimension);
    mesh.node_sets = make_node_sets(raw, groups, dimension, new_node);
    take_elements(raw, dimension, new_node, mesh);
    leave_out_facets(raw, groups, dimension, new_node, mesh);
  }
  orient_elements(raw, mesh);
  take_fibres(raw, dimension, mesh);
  return mesh;
}

}  // namespace trocar
