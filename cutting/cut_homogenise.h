// The plane algorithm's combined system taken to tetrahedra (Serby et al. 2001, eqs. 4 to 6): nodes
// are displaced onto the swept surface, then springs of the edges' old lengths and Lennard-Jones
// particles even the mesh out around them. Nothing in it sees volumes: docs/cutting-measured.md has
// what it gives beside descent on the barrier (cut_move.h).
#pragma once

#include <vector>

#include "cutting/cut_move.h"

namespace trocar {

// Moves the patch's nodes from where they are in X. A motion that lets the step bound of an element
// around sink below `least_step`, or further, is shortened or not made; minus infinity: all are.
void homogenise_nodes(const CutSurroundings& around, const std::vector<NodeRole>& role,
                      double least_step, std::vector<Vec3>& X);

}  // namespace trocar
