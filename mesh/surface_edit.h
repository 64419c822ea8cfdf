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
// copy of the surface.
void update_surface(const Mesh& mesh, const SurfaceEdit& edit, Surface& surface);

// Facets of one element only, as bits by element.
std::vector<std::uint8_t> boundary_facets(const Mesh& mesh);
// Appends facet f of element e.
void add_facet(Surface& surface, const Mesh& mesh, std::int32_t e, int f);

}  // namespace trocar
