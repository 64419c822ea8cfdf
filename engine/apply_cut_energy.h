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
// splits, with nodes that it makes, but for held ones and those supported in all directions;
// ascending.
std::vector<std::int32_t> adjustable_nodes(const Simulation& s, const MeshEdit& edit);

// All elements whose strain energy such an edit changes, or its nodes: the edited ones, with those
// around them if they share nodes of split hexahedra or averaged pressures. Before the edit or
// after it; nodes: the corners of both, ascending.
std::unique_ptr<Patch> make_strained_patch(const Simulation& s, const MeshEdit& edit,
                                           std::span<const std::int32_t> edited,
                                           std::span<const std::int32_t> nodes,
                                           GlobalState& global);

// Moves `nodes` of the body (local, their elements complete), as far as supports let them, until
// its strain energy is `wanted` up to `tolerance`, or as near as thirty rounds come to it. None
// leaves an element with less than half of the least det F that it met. The same bits on any number
// of threads. Returns what is too much. [J]
double restore_strain_energy(std::span<const std::int32_t> nodes, double wanted, double tolerance,
                             RankBody& body);
// The same with numbers of the whole mesh, after the edit; u and x follow.
double restore_strain_energy(std::span<const std::int32_t> nodes, double wanted, double tolerance,
                             const Mesh& mesh, Patch& patch, GlobalState& global);

// Nodes that were moved, ascending, what that changed of the body's energy, 0 without a ledger, and
// what strain energy is still too much. [J]
struct TakenUp {
  std::vector<std::int32_t> nodes;
  double energy = 0, surplus = 0;
};

// What these nodes could not bring back, `surplus`, is taken up around them: the nodes of a ring
// move with them, then those of two and three, until no more than `tolerance` is left [J].
// Momentum, angular momentum and kinetic energy stay. Collective.
TakenUp take_up_around(Simulation& s, std::span<const std::int32_t> nodes, double surplus,
                       double tolerance, GlobalState& global, CutRecord& record);

}  // namespace trocar
