// Where a body's nodes are, from whoever knows: of one that lies on several ranks, what is around a
// blade goes to those that cut and the rest stays where it is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "mesh/element_boxes.h"
#include "mesh/mesh.h"

namespace trocar {

class PresentPositions {
 public:
  virtual ~PresentPositions() = default;
  // (n_nodes) [m]; NaN where nobody has asked. Stays where it is while the mesh does.
  virtual std::span<const Vec3> x() const = 0;
  // From here on x() has these nodes.
  virtual void find(std::span<const std::int32_t> nodes) = 0;
  // All nodes of elements whose boxes overlap `box`, and perhaps some that are near, ascending;
  // from here on x() has them.
  virtual std::vector<std::int32_t> nodes_near(const Box& box) = 0;
};

// Of a body whose nodes are all known. Keeps its arguments.
class KnownPositions final : public PresentPositions {
 public:
  KnownPositions(const Mesh& mesh, std::span<const Vec3> x);
  // With the mesh's boxes, fitted anew where nodes have moved far.
  KnownPositions(const Mesh& mesh, std::span<const Vec3> x, ElementBoxes& boxes);
  KnownPositions(const KnownPositions&) = delete;
  KnownPositions& operator=(const KnownPositions&) = delete;
  std::span<const Vec3> x() const override { return x_; }
  void find(std::span<const std::int32_t> /*nodes*/) override {}
  std::vector<std::int32_t> nodes_near(const Box& box) override;

 private:
  const Mesh& mesh_;
  std::span<const Vec3> x_;
  ElementBoxes own_boxes_;
  ElementBoxes& boxes_;
  double way_ = 0;  // see elements_near
};

}  // namespace trocar
