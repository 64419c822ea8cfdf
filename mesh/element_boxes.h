// Boxes of elements in a binary tree over them, for positions that move little between two
// questions: what moved is asked for by a margin, so that a question costs what is near.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "mesh/edit.h"

namespace trocar {

// Of its corners at x.
Box element_box(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x);

struct ElementBoxes {
  std::vector<Vec3> x;              // (n_nodes) positions that the boxes are of [m]
  std::vector<std::int32_t> order;  // (n_elements when made) leaf by leaf
  std::vector<std::int32_t> first;  // (n_leaves + 1) into order
  std::vector<std::int32_t> leaf;   // (n_elements)
  // Elements that splits added since: the last one of each leaf, -1: none, and of each added one
  // that before it in its leaf.
  std::vector<std::int32_t> last_added, next_added;
  std::vector<Box> box;  // (2 n_leaves) root 1, children 2 k and 2 k + 1, leaves last
  double size = 0;       // mean longest side of an element's box, when made [m]

  bool is_empty() const { return leaf.empty(); }
};

// Splits at the median middle along the longest side.
ElementBoxes make_element_boxes(const Mesh& mesh, std::span<const Vec3> x);

// What an edit changes: its splits; nodes that moved or are new; all elements that touch them.
struct BoxesEdit {
  std::span<const ElementSplit> splits;
  std::span<const std::int32_t> nodes, elements;
};
// mesh and x: after the edit. Tetrahedra share the leaf of the element that they were.
void update_element_boxes(const Mesh& mesh, std::span<const Vec3> x, const BoxesEdit& edit,
                          ElementBoxes& boxes);

// Whether the largest component of the ways of nodes from the boxes' positions [m] is so large that
// the boxes had better be fitted anew.
bool are_outrun(const ElementBoxes& boxes, double way);
void fit_element_boxes(const Mesh& mesh, std::span<const Vec3> x, ElementBoxes& boxes);

// All elements whose boxes overlap `box` where no node is more than `way` [m] from the boxes'
// positions along any axis, and perhaps some that are near, ascending.
std::vector<std::int32_t> elements_near(const Box& box, double way, const ElementBoxes& boxes);
// The same of those whose boxes may overlap this one.
std::vector<std::int32_t> elements_near(const OrientedBox& box, double way,
                                        const ElementBoxes& boxes);

}  // namespace trocar
