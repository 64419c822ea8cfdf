#include "engine/body_positions.h"

#include <algorithm>

#include "mesh/node_corners.h"

namespace trocar {

namespace {

constexpr double rounding = 1e-6;  // edges: elements hold points that lie on their faces

// Largest component of the ways of this rank's nodes from the boxes' positions. [m]
double largest_own_way(const Simulation& s) {
  double most = 0;
  for (std::int32_t local = 0; local < s.part.n_owned; ++local) {
    const Vec3 way = present_position(s, local) - s.boxes.x[s.part.node_global[local]];
    most = std::max(most, way.cwiseAbs().maxCoeff());
  }
  return most;
}

}  // namespace

double begin_positions(Simulation& s) {
  forget_state(s.mesh.X.size(), s.cut_state);
  const double way = s.boxes.is_empty() ? 0 : s.communicator->all_max(largest_own_way(s));
  const bool are_fit = !s.boxes.is_empty() && !are_outrun(s.boxes, way);
  // In the plane, places beside the body are looked for in all of it.
  if (s.mesh.dimension() == 2 || !are_fit) find_all_nodes(s, s.cut_state);
  if (are_fit) return way;
  if (s.boxes.is_empty())
    s.boxes = make_element_boxes(s.mesh, s.cut_state.x);
  else
    fit_element_boxes(s.mesh, s.cut_state.x, s.boxes);
  return 0;
}

// overlaps: whether an element's box overlaps `box` but for a margin.
template <class AnyBox, class Overlaps>
std::vector<std::int32_t> BodyPositions::find_elements(const AnyBox& box,
                                                       const Overlaps& overlaps) {
  const double margin = rounding * s_.edge_length;
  std::vector<std::int32_t> elements = trocar::elements_near(box, way_ + margin, s_.boxes);
  find(nodes_of(s_.mesh, elements));
  std::erase_if(elements,
                [&](std::int32_t e) { return !overlaps(element_box(s_.mesh, e, x()), margin); });
  return elements;
}

std::vector<std::int32_t> BodyPositions::elements_near(const Box& box) {
  return find_elements(box,
                       [&](const Box& own, double margin) { return own.overlaps(box, margin); });
}

std::vector<std::int32_t> BodyPositions::nodes_near(const OrientedBox& box) {
  return nodes_of(s_.mesh, find_elements(box, [&](const Box& own, double margin) {
                    return box.may_overlap(own, margin);
                  }));
}

}  // namespace trocar
