// Positions of a body whose nodes are all known, for cuts.
#pragma once

#include "cutting/cut_positions.h"
#include "mesh/element_boxes.h"
#include "mesh/node_corners.h"
#include "mesh_fixtures.h"

namespace trocar {

// Keeps its arguments.
class KnownPositions final : public PresentPositions {
 public:
  KnownPositions(const Mesh& mesh, std::span<const Vec3> x)
      : mesh_(mesh), x_(x), own_boxes_(make_element_boxes(mesh, x)), boxes_(own_boxes_) {}
  // With the mesh's boxes, fitted anew where nodes have moved far.
  KnownPositions(const Mesh& mesh, std::span<const Vec3> x, ElementBoxes& boxes)
      : mesh_(mesh), x_(x), boxes_(boxes), way_(largest_way(x, boxes)) {
    if (!are_outrun(boxes, way_)) return;
    fit_element_boxes(mesh, x, boxes);
    way_ = 0;
  }
  KnownPositions(const KnownPositions&) = delete;
  KnownPositions& operator=(const KnownPositions&) = delete;
  std::span<const Vec3> x() const override { return x_; }
  void find(std::span<const std::int32_t> /*nodes*/) override {}
  std::vector<std::int32_t> nodes_near(const OrientedBox& box) override {
    return nodes_of(mesh_, elements_near(box, way_, boxes_));
  }

 private:
  const Mesh& mesh_;
  std::span<const Vec3> x_;
  ElementBoxes own_boxes_;
  ElementBoxes& boxes_;
  double way_ = 0;  // see elements_near
};

}  // namespace trocar
