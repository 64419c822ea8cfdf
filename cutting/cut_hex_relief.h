// Hexahedra that become tetrahedra leave part of their hourglass deformation behind.
#pragma once

#include <cstdint>
#include <span>

#include "base/vec.h"
#include "cutting/cut_index.h"
#include "mesh/edit.h"
#include "mesh/mesh.h"

namespace trocar {

// A one-point hexahedron hardly resists hourglass deformation, which tetrahedra in its place feel
// as strain: a conversion adds energy. So the nodes of edit.splits take displacement and velocity
// with half of it left out, as far as the converted hexahedra around agree; affine motion stays
// what it is. `body` before the edit, present positions x, `tets` its tetrahedra after the edit
// with their index. Held nodes stay, and nodes that would squeeze a tetrahedron.
void relieve_hourglass(const Mesh& body, std::span<const Vec3> x,
                       std::span<const std::uint8_t> is_held, const Mesh& tets,
                       const CutIndex& index, MeshEdit& edit);

}  // namespace trocar
