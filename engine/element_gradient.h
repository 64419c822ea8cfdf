// The displacement gradient of an element, for what is told of it: one value an element, at its
// centre.
#pragma once

#include <cstdint>
#include <functional>

#include "base/vec.h"
#include "mesh/mesh.h"

namespace trocar {

// H = du/dX at the centre; of a plane element in its plane. u: displacement of a node [m].
Mat3 displacement_gradient(const Mesh& mesh, std::int32_t e,
                           const std::function<Vec3(std::int32_t node)>& u);

}  // namespace trocar
