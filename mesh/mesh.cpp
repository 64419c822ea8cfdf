// Element types, volumes and lumped mass of a mesh.
#include "mesh/mesh.h"

#include <algorithm>

#include "base/check.h"

namespace trocar {

int Mesh::dimension() const {
  const auto is_triangle = [](ElementType type) { return type == ElementType::tri3; };
  if (element_type.empty()) return 3;
  return std::all_of(element_type.begin(), element_type.end(), is_triangle) ? 2 : 3;
}

const char* element_type_name(ElementType type) {
  constexpr std::array<const char*, n_element_types> name = {"tri3", "tet4", "hex8"};
  return name[static_cast<std::size_t>(type)];
}

bool has_type(const Mesh& mesh, ElementType type) {
  return std::ranges::find(mesh.element_type, type) != mesh.element_type.end();
}

void add_element(Mesh& mesh, ElementType type, std::span<const std::int32_t> corners,
                 std::int32_t region) {
  CHECK_OP(static_cast<int>(corners.size()), ==, n_corners(type));
  mesh.element_type.push_back(type);
  mesh.corner_offset.push_back(static_cast<std::int32_t>(mesh.corner_node.size()));
  mesh.corner_node.insert(mesh.corner_node.end(), corners.begin(), corners.end());
  mesh.element_region.push_back(region);
  mesh.density_factor.push_back(1);
  mesh.cut_facets.push_back(0);
  if (mesh.region_name.empty()) mesh.region_name.emplace_back();
}

const NodeSet* find_node_set(const Mesh& mesh, const std::string& name) {
  for (const NodeSet& set : mesh.node_sets)
    if (set.name == name) return &set;
  return nullptr;
}

// Signed: positive if the corners run counter-clockwise seen from z > 0.
static double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * cross_z(b - a, c - a);
}

static double tetrahedron_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).dot((c - a).cross(d - a)) / 6;
}

// Exact integral of det(dx/dxi) of the trilinear map (Grandy 1997, "Efficient computation of volume
// of hexahedral cells", UCRL-ID-128886, eq. 9).
static double hexahedron_volume(std::span<const Vec3> x) {
  const auto triple = [](const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)); };
  const Vec3 x70 = x[7] - x[0], x61 = x[6] - x[1], x63 = x[6] - x[3];
  const Vec3 x50 = x[5] - x[0], x20 = x[2] - x[0], x64 = x[6] - x[4];
  return (triple(x[3] - x[1] + x[7] - x[2], x63, x20) +
          triple(x[4] - x[3] + x[5] - x[7], x64, x70) +
          triple(x[1] - x[4] + x[2] - x[5], x61, x50)) /
         12;
}

Vec3 element_centre(const Mesh& mesh, std::int32_t e) {
  Vec3 sum = Vec3::Zero();
  for (const std::int32_t i : mesh.corners(e)) sum += mesh.X[i];
  return sum / static_cast<double>(mesh.corners(e).size());
}

std::vector<Vec3> present_positions(std::span<const Vec3> X, std::span<const double> u) {
  std::vector<Vec3> x(X.begin(), X.end());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += Vec3(u[3 * i], u[3 * i + 1], u[3 * i + 2]);
  return x;
}

std::array<Vec3, max_corners> corner_positions(const Mesh& mesh, std::int32_t e,
                                               std::span<const Vec3> x) {
  const std::span<const std::int32_t> node = mesh.corners(e);
  std::array<Vec3, max_corners> corner;
  corner.fill(Vec3::Zero());
  for (std::size_t a = 0; a < node.size(); ++a) corner[a] = x[node[a]];
  return corner;
}

double element_volume(ElementType type, std::span<const Vec3> x) {
  switch (type) {
    case ElementType::tri3:
      return triangle_area(x[0], x[1], x[2]);
    case ElementType::tet4:
      return tetrahedron_volume(x[0], x[1], x[2], x[3]);
    case ElementType::hex8:
      break;
  }
  return hexahedron_volume(x);
}

double element_volume(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x) {
  return element_volume(mesh.element_type[e], corner_positions(mesh, e, x));
}

std::vector<double> lumped_mass(const Mesh& mesh, std::span<const double> density,
                                double thickness) {
  CHECK_OP(density.size(), >=, mesh.region_name.size());
  std::vector<double> mass(mesh.X.size(), 0.0);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const auto k = static_cast<std::size_t>(e);
    const double depth = mesh.element_type[k] == ElementType::tri3 ? thickness : 1.0;
    const double rho = density[mesh.element_region[k]];
    const double m = rho * mesh.density_factor[k] * element_volume(mesh, e, mesh.X) * depth;
    const std::span<const std::int32_t> node = mesh.corners(e);
    for (const std::int32_t i : node) mass[i] += m / static_cast<double>(node.size());
  }
  return mass;
}

}  // namespace trocar
