// A mesh: where the nodes are, which elements they make, which nodes belong to named sets. Every
// rank holds the whole of it; what a rank computes of it is said by its Part (partition.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"

namespace trocar {

enum class ElementType : std::uint8_t { tri3, tet4, hex8 };
inline constexpr int n_element_types = 3;
inline constexpr int max_corners = 8;
constexpr int n_corners(ElementType type) {
  return type == ElementType::tri3 ? 3 : type == ElementType::tet4 ? 4 : 8;
}

// xi, eta, zeta of a hexahedron's corners.
inline constexpr int hex_corner_xi[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                            {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

// Nodes of a facet, ascending, after as many -1 as are missing to four.
using FacetNodes = std::array<std::int32_t, 4>;

// A named set of nodes, ascending ("attachment").
struct NodeSet {
  std::string name;
  std::vector<std::int32_t> node;
  // Of a surface in a mesh file: what does not belong to it although all its nodes do, outer facets
  // of the uncut mesh, ascending.
  std::vector<FacetNodes> left_out;
  bool operator==(const NodeSet&) const = default;
};

// A hexahedron that a cut has made tetrahedra of: the first has its number, the others have those
// from first_part on.
struct SplitHexahedron {
  std::int32_t element = 0, first_part = 0;
  bool operator==(const SplitHexahedron&) const = default;
};

// Global numbers are positions in these arrays. Element corners in the order of VTK and gmsh.
struct Mesh {
  std::vector<Vec3> X;                       // (n_nodes) reference positions [m]
  std::vector<ElementType> element_type;     // (n_elements)
  std::vector<std::int32_t> corner_offset;   // (n_elements) of the first corner in corner_node
  std::vector<std::int32_t> corner_node;     // (n_corners) each of one element
  std::vector<std::int32_t> element_region;  // (n_elements) index into region_name
  std::vector<std::string> region_name;      // at least one, "" where the file names none
  // (n_elements) keeps the mass when a cut moves nodes of a curved surface
  std::vector<double> density_factor;
  // (n_elements) bit f: facet f was opened by a cut (facets.h numbers them)
  std::vector<std::uint8_t> cut_facets;
  // (n_elements) direction of the fibres, unit vectors in the reference; or empty: the material's.
  std::vector<Vec3> fibre;
  std::vector<NodeSet> node_sets;
  // (n_made) The last nodes are those that cuts made: copies, the node that each is of, or new ones
  // on edges, themselves.
  std::vector<std::int32_t> copied_node;
  // (n_nodes of the uncut mesh, or empty) How hexahedra become tetrahedra: bits 0 to 6, the node's
  // rank where facets choose their diagonals (hex_split.h); bit 7, at a hexahedron that never does.
  std::vector<std::uint8_t> hex_split_rank;
  std::vector<SplitHexahedron> split_hexahedra;  // in the order of their splits
  bool operator==(const Mesh&) const = default;

  std::int32_t n_nodes() const { return static_cast<std::int32_t>(X.size()); }
  std::int32_t n_elements() const { return static_cast<std::int32_t>(element_type.size()); }
  std::span<const std::int32_t> corners(std::int32_t e) const {
    return {corner_node.data() + corner_offset[e],
            static_cast<std::size_t>(n_corners(element_type[e]))};
  }
  // 2 if all elements are triangles (plane problem, z = 0), else 3.
  int dimension() const;
  // The node that node i is or copies: of the uncut mesh, or one that a cut put on an edge.
  std::int32_t uncut_node(std::int32_t i) const {
    const std::int32_t first_made = n_nodes() - static_cast<std::int32_t>(copied_node.size());
    return i < first_made ? i : copied_node[i - first_made];
  }
};

const char* element_type_name(ElementType type);
bool has_type(const Mesh& mesh, ElementType type);

// Appends an element of region 0 with density factor 1.
void add_element(Mesh& mesh, ElementType type, std::span<const std::int32_t> corners,
                 std::int32_t region = 0);

// The nodes of a tetrahedron.
inline std::array<std::int32_t, 4> tet_nodes(const Mesh& mesh, std::int32_t e) {
  const std::span<const std::int32_t> c = mesh.corners(e);
  return {c[0], c[1], c[2], c[3]};
}

// nullptr if there is none of that name.
const NodeSet* find_node_set(const Mesh& mesh, const std::string& name);

// Mean of the corners.
Vec3 element_centre(const Mesh& mesh, std::int32_t e);

// x = X + u for all nodes; u (n_nodes * 3). [m]
std::vector<Vec3> present_positions(std::span<const Vec3> X, std::span<const double> u);

// x (n_nodes) of an element's corners, in the first places.
std::array<Vec3, max_corners> corner_positions(const Mesh& mesh, std::int32_t e,
                                               std::span<const Vec3> x);

// Volume of an element with its corners at x (n_corners, or more), or in positions x (n_nodes); the
// exact trilinear one for hex8, the area for tri3 (corners counter-clockwise seen from z > 0).
// Negative if inverted. [m^3], [m^2]
double element_volume(ElementType type, std::span<const Vec3> x);
double element_volume(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x);

// Sum of density * factor * volume (* thickness for tri3) of an element, spread equally on its
// corners. density (n_regions) [kg/m^3]; thickness [m] counts for tri3 only. Result (n_nodes) [kg],
// summed in element order.
std::vector<double> lumped_mass(const Mesh& mesh, std::span<const double> density,
                                double thickness);

}  // namespace trocar
