// The part of a mesh around a cut with numbers of its own, so that a cut costs what it touches and
// not what the body has. Local numbers ascend with the global ones: no order depends on how the
// patch was found.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cutting/cut_constraints.h"
#include "cutting/cut_index.h"
#include "cutting/cut_positions.h"
#include "mesh/facets.h"
#include "mesh/mesh.h"

namespace trocar {

// Rings of elements around the seeds. Nodes up to ring n_cut_rings - 1 have all their elements in
// the patch.
inline constexpr int n_cut_rings = 3;

struct CutPatch {
  std::vector<std::int32_t> element;                // global number, ascending
  std::vector<std::int32_t> node;                   // global number, ascending
  std::vector<std::array<std::int32_t, 4>> corner;  // local nodes of an element
  // local element across each facet; -1: boundary, or outside
  std::vector<std::array<std::int32_t, 4>> across;
  std::vector<std::uint8_t> node_ring;  // 0 for the seeds' nodes
  std::vector<std::uint8_t> is_locked;  // node that must stay where it is
  // node of an element that is no tetrahedron: must stay one node
  std::vector<std::uint8_t> is_joined;
  // of a bent hexahedron: must stay where and what it is for now
  std::vector<std::uint8_t> is_bent;
  std::vector<Vec3> X, x;  // reference and present positions
  // (n_elements) of the mesh; none where it has one region.
  std::vector<std::int32_t> region;
  std::vector<BorderEdge> border;  // of the constraints: both ways, ascending
  NodeElements stars;              // local elements around local nodes

  std::int32_t n_elements() const { return static_cast<std::int32_t>(element.size()); }
  std::int32_t n_nodes() const { return static_cast<std::int32_t>(node.size()); }
  // Local elements around a local node, ascending.
  std::span<const std::int32_t> star(std::int32_t i) const { return stars.of(i); }
  bool is_whole(std::int32_t i) const { return node_ring[i] < n_cut_rings; }
  // Local number of a global node or element that is in the patch, -1 if it isn't.
  std::int32_t local_node(std::int32_t global) const;
  std::int32_t local_element(std::int32_t global) const;
};

// Tetrahedra of `mesh` within n_cut_rings of the seeds (global elements, ascending). `index` is
// that of the mesh.
CutPatch make_patch(const Mesh& mesh, CutIndex& index, PresentPositions& positions,
                    const CutConstraints& constraints, std::span<const std::int32_t> seeds);

std::array<std::int32_t, 3> facet_nodes(const CutPatch& patch, std::int32_t e, int f);
// Outward and twice as long as its area [m^2].
Vec3 facet_normal(const CutPatch& patch, const std::array<std::int32_t, 3>& node);
// Whether no element of the body lies across; of a facet at the patch's rim that isn't known:
// false.
bool is_outer(const CutPatch& patch, std::int32_t e, int f);
// The facet of `e` that neighbour `u` lies behind.
int facet_towards(const CutPatch& patch, std::int32_t e, std::int32_t u);

// The least barycentric coordinate of the triangle's plane's point next to X.
double least_share(const std::array<Vec3, 3>& triangle, const Vec3& X);

// Six times the volume of a tetrahedron. [m^3]
double six_volumes(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner);
// 6 V / sqrt(sum of squared double facet areas): in proportion to the element's bound of the stable
// step; negative if inverted. [m]
double step_bound(std::span<const Vec3> X, const std::array<std::int32_t, 4>& corner);
// Of tetrahedron e in the reference.
double tet_step_bound(const Mesh& mesh, std::int32_t e);
double tet_mean_edge(const Mesh& mesh, std::int32_t e);
// The least one of the elements around node i, all at the positions X.
double star_step(const CutPatch& patch, std::span<const Vec3> X, std::int32_t i);

// Mean of all corners of some elements, as they lie before the cut. [m]
Vec3 centre_of(const CutPatch& patch, std::span<const std::int32_t> element);

}  // namespace trocar
