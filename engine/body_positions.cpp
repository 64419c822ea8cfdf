#include "engine/body_positions.h"

#include <algorithm>

#include "mesh/node_corners.h"

namespace trocar {

namespace {

// Of this rank's nodes, as largest_way.
double largest_own_way(const Simulation& s) {
  double most = 0;
  for (std::int32_t local = 0; local < s.part.n_owned; ++local) {
    const auto i = static_cast<std::size_t>(s.part.node_global[static_cast<std::size_t>(local)]);
    const Vec3 x = s.mesh.X[i] + Vec3::Map(&s.state.u[3 * std::ptrdiff_t{local}]);
    most = std::max(most, (x - s.boxes.x[i]).cwiseAbs().maxCoeff());
  }
  return most;
}

}  // namespace

BodyPositions::BodyPositions(Simulation& s) : s_(s) {
  forget_state(s.mesh.X.size(), s.cut_state);
  if (!s.boxes.is_empty()) way_ = s.communicator->all_max(largest_own_way(s));
  // In the plane, places beside the body are looked for in all of it.
  if (s.mesh.dimension() == 2 || are_outrun(s.boxes, way_)) find_all_nodes(s, s.cut_state);
  if (!are_outrun(s.boxes, way_)) return;
  fit_element_boxes(s.mesh, x(), s.boxes);
  way_ = 0;
}

void BodyPositions::find(std::span<const std::int32_t> nodes) {
  find_nodes(s_, nodes, s_.cut_state);
}

std::vector<std::int32_t> BodyPositions::elements_around(const Box& box) {
  if (s_.boxes.is_empty()) {
    find_all_nodes(s_, s_.cut_state);
    s_.boxes = make_element_boxes(s_.mesh, x());
    way_ = 0;
  }
  std::vector<std::int32_t> elements = elements_near(box, way_, s_.boxes);
  find(nodes_of(s_.mesh, elements));
  return elements;
}

std::vector<std::int32_t> BodyPositions::nodes_near(const Box& box) {
  return nodes_of(s_.mesh, elements_around(box));
}

}  // namespace trocar
