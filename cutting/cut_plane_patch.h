// The triangles around a plane cut as a small mesh of their own, which may be flipped and moved
// freely: the mesh itself stays untouched until a whole valid edit has been found.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/grouped.h"
#include "base/segment.h"
#include "base/vec.h"
#include "cutting/cut_constraints.h"
#include "mesh/mesh.h"

namespace trocar {

// What lies across a facet of an element of the patch where it is no element of the patch.
inline constexpr int across_boundary =
    -1;                                // nothing: the body's boundary or the face of an older cut
inline constexpr int across_rim = -2;  // an element that is not part of the patch

// Numbers are local; ascending local numbers are ascending global ones.
struct PlanePatch {
  std::vector<std::int32_t> element, node;  // global numbers, ascending
  std::vector<std::array<int, 3>> corner;   // (n_elements) counter-clockwise
  std::vector<std::array<int, 3>> across;   // (n_elements) across the facet opposite each corner
  std::vector<std::uint8_t> opened;       // (n_elements) facets opened by cuts, as Mesh::cut_facets
  std::vector<std::uint8_t> chain;        // (n_elements) facets along this cut
  std::vector<int> region;                // (n_elements)
  std::vector<double> area;               // (n_elements) before the cut [m^2]
  std::vector<Vec2> X, x;                 // (n_nodes) before the cut and now [m]
  std::vector<Vec2> present;              // (n_nodes) in the deformed body; none: as X [m]
  std::vector<int> star;                  // (n_nodes) an element around each node
  std::vector<Vec2> side;                 // (n_nodes) direction of a straight boundary, else zero
  std::vector<std::uint8_t> is_boundary;  // (n_nodes)
  std::vector<std::uint8_t> is_sharp;     // (n_nodes) boundary turns by more than 30 degrees, lips
                                          // of older cuts by anything
  std::vector<std::uint8_t> is_held;      // (n_nodes) must not be displaced
  std::vector<std::uint8_t> is_anchored;  // (n_nodes) stays unless it becomes a cut node: on older
                                          // cuts and between regions
  std::vector<std::uint8_t> is_interface;  // (n_nodes) between regions; none if there is one
  bool has_held = false;  // nodes that must not be displaced whatever the patch, not just its rim's
  double h = 0;           // mean edge length [m]
  double least_edge = 0;  // [m]

  int n_elements() const { return static_cast<int>(element.size()); }
  int n_nodes() const { return static_cast<int>(node.size()); }
  bool has_interfaces() const { return !is_interface.empty(); }
};

// The elements that the path meets and `rings` rings around them. Empty if it meets none.
PlanePatch make_patch(const Mesh& mesh, std::span<const Vec2> path,
                      const CutConstraints& constraints, int rings);

inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}
// Where the line from p along d passes between a and b, over d. Ends count as left of the line when
// they lie on it, for all edges alike.
inline std::optional<double> pass_between(const Vec2& p, const Vec2& d, const Vec2& a,
                                          const Vec2& b) {
  if ((cross(d, a - p) >= 0) == (cross(d, b - p) >= 0)) return std::nullopt;
  return cross(b - a, a - p) / cross(b - a, d);
}
inline double triangle_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return 0.5 * cross(b - a, c - a);
}
inline double area(const PlanePatch& patch, int e) {
  const auto& [a, b, c] = patch.corner[e];
  return triangle_area(patch.x[a], patch.x[b], patch.x[c]);
}
// slack: how far outside p may be, over the triangle's area.
inline bool is_in_triangle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& p,
                           double slack) {
  const double least = -slack * triangle_area(a, b, c);
  return triangle_area(a, b, p) >= least && triangle_area(b, c, p) >= least &&
         triangle_area(c, a, p) >= least;
}
// The first element with p in it, as is_in_triangle has it, before the cut; -1 if there is none.
int element_at(const PlanePatch& patch, const Vec2& p, double slack);
// 4 sqrt(3) A / sum l^2: 1 for equilateral, <= 0 for inverted triangles.
inline double quality(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double four_sqrt_3 = 6.928203230275509;
  const double sum = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return four_sqrt_3 * triangle_area(a, b, c) / sum;
}
inline double quality(const PlanePatch& patch, int e) {
  const auto& [a, b, c] = patch.corner[e];
  return quality(patch.x[a], patch.x[b], patch.x[c]);
}
inline double least_altitude(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return 2 * triangle_area(a, b, c) / std::sqrt(longest);
}
// Bounds the stable step: omega^2 <= c^2 sum_a 1 / h_a^2 of an element with the altitudes h_a. [m]
inline double step_bound(const Vec2& a, const Vec2& b, const Vec2& c) {
  return 2 * triangle_area(a, b, c) /
         std::sqrt((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm());
}
inline int corner_of(const PlanePatch& patch, int e, int node) {
  const std::array<int, 3>& corner = patch.corner[e];
  return corner[0] == node ? 0 : corner[1] == node ? 1 : 2;
}

// Calls visit(e, a) for all elements e around a node, where it is corner a; false stops.
template <typename Visit>
void visit_star(const PlanePatch& patch, int node, Visit visit) {
  const int first = patch.star[node];
  int e = first;
  do {  // counter-clockwise, over the edge from the node to the corner before it
    const int a = corner_of(patch, e, node);
    if (!visit(e, a)) return;
    e = patch.across[e][(a + 1) % 3];
  } while (e >= 0 && e != first);
  if (e == first) return;
  e = patch.across[first][(corner_of(patch, first, node) + 2) % 3];
  while (e >= 0) {
    const int a = corner_of(patch, e, node);
    if (!visit(e, a)) return;
    e = patch.across[e][(a + 2) % 3];
  }
}

// Nodes that share an edge with a node, of all nodes at once.
Grouped<int> all_neighbours(const PlanePatch& patch);

// An element as seen from one of its facets.
struct PatchFacet {
  int element = -1;
  int facet = -1;
};
// Calls use(i, j) for each edge between two regions.
template <class Use>
void for_interface_edges(const PlanePatch& patch, const Use& use) {
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      const int g = patch.across[e][f];
      if (g >= e && patch.region[e] != patch.region[g])
        use(patch.corner[e][(f + 1) % 3], patch.corner[e][(f + 2) % 3]);
    }
}
// The element to the left of the edge from a to b, with the facet that the edge is; -1 if none.
PatchFacet find_edge(const PlanePatch& patch, int a, int b);
// The same facet from the other side; `element` is negative on the boundary and the rim.
PatchFacet opposite(const PlanePatch& patch, PatchFacet facet);

// May the edge be exchanged for the other diagonal? Not on boundaries and cuts, nor between
// regions.
bool is_flippable(const PlanePatch& patch, PatchFacet facet);
// The smaller area of the two triangles that a flip would make, over their mean area now.
double flipped_area(const PlanePatch& patch, PatchFacet facet);
// Exchanges the diagonal: e = (w, u, v), g = (z, v, u) become (w, u, z), (z, v, w); numbers of
// elements, masks of the outer edges and all other corners stay.
void flip(PlanePatch& patch, PatchFacet facet);

}  // namespace trocar
