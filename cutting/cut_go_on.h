// Where a stroke meets what another one has begun: around the end of a slit elements are crossed in
// part, or have sides and stay joined. A blade that comes there again, or from the other side, goes
// on as if both were one stroke; a slit of its own beside the other would end between the two.
#pragma once

#include <span>

#include "cutting/cut_index.h"
#include "cutting/cut_stroke.h"
#include "mesh/edit.h"
#include "mesh/mesh.h"

namespace trocar {

// What the stroke leaves when it ends, with what it was left by others.
CutLeft left_by(const CutStroke& stroke);

// Takes up what a stroke of another blade has left, in place of what was known of it until it
// ended.
void add_left(const CutLeft& other, CutStroke& stroke);

// What the stroke knows of the elements around the nodes that an edit of its own parts. `index` is
// that after the edit, `n_nodes` the number before it.
CutKnown known_around(const MeshEdit& edit, std::int32_t n_nodes, const CutIndex& index,
                      const CutStroke& stroke);

// Adds to the stroke what is left of elements crossed beside the crossings `found`, along them:
// their crossings, sides and opened facets, and where the rim was.
void take_up_left(const Mesh& mesh, std::span<const CutHit> found, CutStroke& stroke);

// The same of another blade that is in a stroke, with what it knows of elements around what it has
// parted just now, which is remembered for crossings to come.
void go_on_beside(const Mesh& mesh, const CutKnown& other, CutStroke& stroke);

}  // namespace trocar
