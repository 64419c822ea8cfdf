// What a stroke takes up of another blade's edit.
#pragma once

#include <span>

#include "cutting/cut_index.h"
#include "cutting/cut_stroke.h"
#include "mesh/edit.h"
#include "mesh/mesh.h"

namespace trocar {

// Step bounds of these elements, ascending, as they are before another blade touches them: the
// floor under them must not sink from blade to blade. Tetrahedra only.
void keep_steps(const Mesh& mesh, std::span<const std::int32_t> element, CutStroke& stroke);
// Of the elements around nodes that the edit moves. `mesh` and `index` are those before it.
void keep_steps_around(const Mesh& mesh, const CutIndex& index, const MeshEdit& edit,
                       CutStroke& stroke);

// Where the stroke goes the other blade's way, it goes on as if both were one (go_on_beside).
// Elsewhere it forgets crossings of edges whose ends the edit has parted, and all those in elements
// at facets that it opened, along its surface: made again, they would be a second slit beside the
// first. Elements of those of this stroke go to in_slit. Copies of nodes join their parents. `mesh`
// is that before the edit, `along` what the other blade knows of the elements around it.
void follow_opening(const Mesh& mesh, const MeshEdit& edit, const CutKnown& along,
                    CutStroke& stroke);

}  // namespace trocar
