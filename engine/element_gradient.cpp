#include "engine/element_gradient.h"

#include <span>

namespace trocar {

// Derivatives of a field at the element's centre by its reference coordinates, but for a factor.
template <class Value>
static Mat3 derivatives(ElementType type, std::span<const std::int32_t> corners,
                        const Value& value) {
  Mat3 by_reference = Mat3::Zero();
  if (type == ElementType::hex8) {
    for (int a = 0; a < 8; ++a)
      for (int k = 0; k < 3; ++k) by_reference.col(k) += hex_corner_xi[a][k] * value(corners[a]);
    return by_reference;
  }
  for (std::size_t k = 1; k < corners.size(); ++k)
    by_reference.col(static_cast<Eigen::Index>(k) - 1) = value(corners[k]) - value(corners[0]);
  return by_reference;
}

Mat3 displacement_gradient(const Mesh& mesh, std::int32_t e,
                           const std::function<Vec3(std::int32_t node)>& u) {
  const ElementType type = mesh.element_type[e];
  const auto corners = mesh.corners(e);
  Mat3 dX = derivatives(type, corners, [&](std::int32_t i) { return mesh.X[i]; });
  if (type == ElementType::tri3) dX.col(2) = Vec3::UnitZ();
  return derivatives(type, corners, u) * dX.inverse();
}

}  // namespace trocar
