// The cells of a structured box without its positions: what boxes, balls and cylinders share.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "mesh/generate.h"

namespace trocar {

// Six tetrahedra a cell have 24 corners and 24 facets a node: their offsets must stay inside int32.
inline constexpr std::int64_t max_generated_nodes = 50'000'000;

// Directions (bits x = 1, y = 2, z = 4) in which the pattern of tetrahedra of cell (i, j, k) is
// mirrored.
using CellMirror = std::function<unsigned(int i, int j, int k)>;
// Every second cell in all directions: what makes five tetrahedra a cell fit together.
unsigned alternate_mirror(int i, int j, int k);

// Throws InputError if there is a direction without cells or too many nodes.
void check_cells(const std::array<int, 3>& n);
// Adds the elements of n cells on nodes i + (n_x + 1) (j + (n_y + 1) k), and the six node sets.
void add_box_cells(Mesh& mesh, const std::array<int, 3>& n, BoxElements elements,
                   const CellMirror& mirror);

}  // namespace trocar
