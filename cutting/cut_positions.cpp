#include "cutting/cut_positions.h"

#include "mesh/node_corners.h"

namespace trocar {

KnownPositions::KnownPositions(const Mesh& mesh, std::span<const Vec3> x)
    : mesh_(mesh), x_(x), own_boxes_(make_element_boxes(mesh, x)), boxes_(own_boxes_) {}

KnownPositions::KnownPositions(const Mesh& mesh, std::span<const Vec3> x, ElementBoxes& boxes)
    : mesh_(mesh), x_(x), boxes_(boxes), way_(largest_way(x, boxes)) {
  if (!are_outrun(boxes, way_)) return;
  fit_element_boxes(mesh, x, boxes);
  way_ = 0;
}

std::vector<std::int32_t> KnownPositions::nodes_near(const Box& box) {
  return nodes_of(mesh_, elements_near(box, way_, boxes_));
}

}  // namespace trocar
