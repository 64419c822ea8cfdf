// A change of topology as a value: what a cut does to the mesh, and how the state goes over.
// Cutting makes it, engine applies it to mesh, model, state, contact and recording in one order.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

// Node `node` gets the reference position X, which lies in (or next to) element `host` of the mesh
// before the edit; a nodal field q becomes sum_a weight[a] q[corner a of host]: exact for affine
// motion.
struct NodeMove {
  std::int32_t node = 0;
  Vec3 X = Vec3::Zero();
  std::int32_t host = 0;
  std::array<double, max_corners> weight{};
};
// Corner `corner` of element `element` becomes node `node` (old or new).
struct CornerChange {
  std::int32_t element = 0;
  std::int32_t corner = 0;
  std::int32_t node = 0;
};
struct CutFacets {
  std::int32_t element = 0;
  std::uint8_t mask = 0;  // the whole new value of Mesh::cut_facets
};
struct DensityChange {
  std::int32_t element = 0;
  double factor = 1;  // the whole new value of Mesh::density_factor
};

// A new node on edge (end[0], end[1]) of the mesh before the edit, at X_0 + s (X_1 - X_0); a nodal
// field there becomes q_0 + s (q_1 - q_0): exact for affine motion.
struct EdgeNode {
  std::array<std::int32_t, 2> end{};  // ascending
  double s = 0;                       // 0 < s < 1
};

Vec3 position_of(const Mesh& before, const EdgeNode& node);

inline constexpr std::int32_t n_hex_tets = 6;
inline constexpr std::int32_t max_split_tets = n_hex_tets;

// Element `element` becomes tetrahedra: a hexahedron six on its own nodes, a tetrahedron two to six
// on its own nodes and new ones on its edges. They inherit all that it had; the first gets its
// number, the others come behind all elements, so that no other element gets another number.
struct ElementSplit {
  std::int32_t element = 0;
  std::int32_t n_tets = n_hex_tets;
  std::array<std::array<std::int32_t, 4>, max_split_tets> corner{};  // nodes

  std::span<const std::array<std::int32_t, 4>> tets() const {
    return {corner.data(), static_cast<std::size_t>(n_tets)};
  }
};

// An element, or a part of one, that an edit gives another shape.
struct Reshaped {
  std::int32_t element = 0, region = 0;
  double factor = 1;             // Mesh::density_factor
  double before = 0, after = 0;  // volume, in any unit; the first part has all of that before
};
// With them the elements of a region have the mass that they had; none where it differs by no more
// than `tolerance` of it.
std::vector<DensityChange> keep_masses(std::span<const Reshaped> elements, std::size_t n_regions,
                                       double tolerance = 0);

// Applied in the order of its members. The k-th inserted node becomes node n_nodes + k; all
// elements around its edge are split, none of them a hexahedron. Duplicates follow: each copies its
// parent (after moving). Corners, cut_facets and density are of elements after the splits, hosts of
// those before.
struct MeshEdit {
  std::vector<EdgeNode> inserted;              // (n_inserted)
  std::vector<ElementSplit> splits;            // ascending element
  std::vector<NodeMove> moves;                 // ascending node
  std::vector<std::int32_t> duplicate_parent;  // (n_duplicates)
  std::vector<CornerChange> corners;           // ascending (element, corner)
  std::vector<CutFacets> cut_facets;           // ascending element
  std::vector<DensityChange> density;          // ascending element
  bool is_empty() const {
    return splits.empty() && moves.empty() && duplicate_parent.empty() && corners.empty();
  }
  std::size_t n_new_nodes() const { return inserted.size() + duplicate_parent.size(); }
};

// Numbers of what the splits of an edit make.
class SplitNumbers {
 public:
  // splits: those of a MeshEdit, which must stay; n_before: elements before the edit.
  SplitNumbers(std::span<const ElementSplit> splits, std::int32_t n_before);
  // Of the k-th part of an element; of itself if it stays, k being 0.
  std::int32_t part(std::int32_t element, std::int32_t k) const;
  // The element that this is, or is a part of; and which part.
  std::int32_t whole(std::int32_t part) const;
  std::int32_t place_in_whole(std::int32_t part) const;
  // nullptr if the element stays.
  const ElementSplit* find(std::int32_t element) const;
  bool is_split(std::int32_t element) const { return find(element) != nullptr; }
  // All that these elements become; both ascending.
  std::vector<std::int32_t> all_after(std::span<const std::int32_t> elements) const;

 private:
  std::span<const ElementSplit> splits_;
  std::int32_t n_before_;
  std::vector<std::int32_t> n_added_;  // (n_splits) elements more, by the splits before each

  const ElementSplit& split_of_added(std::int32_t part) const;
};

// How many elements more there are after the splits.
std::int32_t n_added(std::span<const ElementSplit> splits);

// Bits of the facets of tetrahedron `part` (nodes), a part of tetrahedron `whole`, that lie on
// facets of `mask` of it. inserted: those of the edit, the first of which is node first_inserted.
std::uint8_t facets_of_part(std::span<const std::int32_t> whole, std::uint8_t mask,
                            std::span<const EdgeNode> inserted, std::int32_t first_inserted,
                            const std::array<std::int32_t, 4>& part);

// The node that a corner has until it changes. before: the mesh before the edit, numbers: those of
// its splits.
std::int32_t node_before(const SplitNumbers& numbers, const Mesh& before,
                         const CornerChange& change);
// That a corner of an element that is not split has after the edit.
std::int32_t node_after(const MeshEdit& edit, const Mesh& before, std::int32_t e,
                        std::int32_t corner);
// Mesh::cut_facets of such an element after the edit.
std::uint8_t cut_facets_after(const MeshEdit& edit, const Mesh& before, std::int32_t e);

std::vector<std::int32_t> moved_nodes(const MeshEdit& edit);  // ascending

void apply_edit(const MeshEdit& edit, Mesh& mesh);
// The same change on a nodal field with `width` doubles a node (n_nodes * width -> n_new_nodes *
// width); `before` is the mesh before the edit.
void apply_edit(const MeshEdit& edit, const Mesh& before, int width, std::vector<double>& field);

}  // namespace trocar
