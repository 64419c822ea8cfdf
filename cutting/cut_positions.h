// Where a body's nodes are, from whoever knows: of one that lies on several ranks, what is around a
// blade goes to those that cut and the rest stays where it is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/vec.h"

namespace trocar {

class PresentPositions {
 public:
  virtual ~PresentPositions() = default;
  // (n_nodes) [m]; NaN where nobody has asked. Stays where it is while the mesh does.
  virtual std::span<const Vec3> x() const = 0;
  // From here on x() has these nodes.
  virtual void find(std::span<const std::int32_t> nodes) = 0;
  // All nodes of elements whose boxes may overlap `box`, and perhaps some that are near, ascending;
  // from here on x() has them.
  virtual std::vector<std::int32_t> nodes_near(const OrientedBox& box) = 0;
};

}  // namespace trocar
