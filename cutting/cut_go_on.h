// Where a stroke meets what another one has begun: around the end of a slit elements are crossed in
// part, and nobody parts them. A blade that comes there again, or from the other side, does.
#pragma once

#include <span>

#include "cutting/cut_stroke.h"
#include "mesh/mesh.h"

namespace trocar {

// What the stroke leaves when it ends, with what it was left by others.
CutLeft left_by(const CutStroke& stroke);

void add_left(const CutLeft& more, CutLeft& left);

// Adds to the stroke's crossings those that are left beside those of `found`, along them.
void take_up_left(const Mesh& mesh, std::span<const CutHit> found, CutStroke& stroke);

}  // namespace trocar
