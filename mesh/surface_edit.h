// The boundary surface after an edit, from the one before it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/facets.h"
#include "mesh/sub_mesh.h"

namespace trocar {

// Where facets may have come to the boundary or left it.
struct SurfaceEdit {
  std::span<const std::int32_t> nodes;     // all corners of edited elements, before and after
  std::span<const std::int32_t> elements;  // all that touch these nodes, ascending
  const SubMesh& around;                   // all that touch corners of these elements
};
// The surface of before the edit becomes boundary_surface's, in a time of the edit's, but for a
// copy of the surface; in the plane it is made anew.
void update_surface(const Mesh& mesh, const SurfaceEdit& edit, Surface& surface);

}  // namespace trocar
