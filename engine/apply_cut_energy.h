// What an edit adds to the strain energy or takes from it. Moved nodes get their displacements by
// interpolation, which smooths strains; a one-point hexahedron hardly resists hourglass deformation
// that tetrahedra in its place feel as strain. Steps along the forces undo both.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/apply_cut.h"
#include "solver/rank_body.h"

namespace trocar {

// Of the body before the edit: nodes that it moves or duplicates and those of hexahedra that it
// splits, with nodes that it makes, but for held and supported ones; ascending.
std::vector<std::int32_t> adjustable_nodes(const Simulation& s, const MeshEdit& edit);

// Moves `nodes` of the body (local, ascending, their elements complete) until its strain_energy is
// `wanted` up to 0.5 %, or as near as ten steps come to it. None leaves an element with less than
// half of the least det F that it met. The same bits on any number of threads.
void restore_strain_energy(std::span<const std::int32_t> nodes, double wanted, RankBody& body);

}  // namespace trocar
