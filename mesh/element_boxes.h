// Boxes of elements in a binary tree over them, for positions that move little between two
// questions: what moved is asked for by a margin, so that a question costs a look at the nodes and
// what is near.
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
  std::vector<std::int32_t> order;  // elements, leaf by leaf
  std::vector<std::int32_t> first;  // (n_leaves + 1) into order
  std::vector<std::int32_t> leaf;   // (n_elements)
  std::vector<Box> box;             // (2 n_leaves) root 1, children 2 k and 2 k + 1, leaves last
  double size = 0;                  // mean longest side of an element's box, when made [m]

  bool is_empty() const { return leaf.empty(); }
};

// Splits at the median middle along the longest side.
ElementBoxes make_element_boxes(const Mesh& mesh, std::span<const Vec3> x);

// What an edit changes: its splits; nodes that moved or are new; all elements that touch them.
struct BoxesEdit {
  std::span<const HexSplit> splits;
  std::span<const std::int32_t> nodes, elements;
};
// mesh and x: after the edit. Tetrahedra share the leaf that their hexahedron was in.
void update_element_boxes(const Mesh& mesh, std::span<const Vec3> x, const BoxesEdit& edit,
                          ElementBoxes& boxes);

// All elements whose boxes at x overlap `box`, and perhaps some that are near, ascending. Fits the
// boxes anew where nodes have moved by more than half an element since.
std::vector<std::int32_t> elements_near(const Mesh& mesh, std::span<const Vec3> x, const Box& box,
                                        ElementBoxes& boxes);

}  // namespace trocar
