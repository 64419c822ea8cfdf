// What an edit adds to the strain energy or takes from it. Moved nodes get their displacements by
// interpolation, which smooths strains; a one-point hexahedron hardly resists hourglass deformation
// that tetrahedra in its place feel as strain. Steps along the forces undo both.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/patch.h"

namespace trocar {

// Strain and hourglass energy of the present displacement. [J]
double strain_energy(RankBody& body);

// Of the body before the edit: nodes that it moves or duplicates and those of hexahedra that it
// splits, with nodes that it makes, but for held and supported ones; ascending.
std::vector<std::int32_t> adjustable_nodes(const Simulation& s, const MeshEdit& edit);

// All elements whose strain energy such an edit changes, or its nodes: the edited ones, with those
// around them if they share nodes of split hexahedra or averaged pressures. Before the edit or
// after it; nodes: the corners of both, ascending.
std::unique_ptr<Patch> make_strained_patch(const Simulation& s, const MeshEdit& edit,
                                           std::span<const std::int32_t> edited,
                                           std::span<const std::int32_t> nodes,
                                           GlobalState& global);

// Moves `nodes` of the body (local, their elements complete) until its strain energy is `wanted` up
// to 0.5 %, or as near as thirty rounds come to it. None leaves an element with less than half of
// the least det F that it met. The same bits on any number of threads.
void restore_strain_energy(std::span<const std::int32_t> nodes, double wanted, RankBody& body);
// The same with numbers of the whole mesh, after the edit; u and x follow.
void restore_strain_energy(std::span<const std::int32_t> nodes, double wanted, const Mesh& mesh,
                           Patch& patch, GlobalState& global);

}  // namespace trocar
