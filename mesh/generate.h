// Meshes of boxes, balls, cylinders and plane rectangles, for scenes without a mesh file and for
// tests.
#pragma once

#include <array>
#include <span>

#include "mesh/mesh.h"

namespace trocar {

enum class BoxElements { hex8, tet4_kuhn, tet4_five };

// [low, high] with n cells a direction. Node sets "x-", "x+", "y-", … hold the nodes of the six
// sides. Kuhn: 6 tetrahedra a cell, diagonals in one direction; five: 5 a cell, mirrored in every
// second one.
Mesh make_box(const Vec3& low, const Vec3& high, const std::array<int, 3>& n, BoxElements elements);

// Ball and z-cylinder by mapping a box mesh of n (n x n x nz) cells; smooth surface, node set
// "surface" (cylinder: "z-", "z+", "side"). Kuhn's diagonals run outward in every octant. hex8:
// cells on the box's edges have nearly flat corners (but no flat element). tet4_five would have
// flat elements: InputError.
Mesh make_ball(const Vec3& centre, double radius, int n, BoxElements elements);
Mesh make_cylinder(const Vec3& base_centre, double radius, double height, int n, int nz,
                   BoxElements elements);

// The paper's plane meshes (Serby, Harders, Szekely 2001, Table 1): width x height with nx x ny
// nodes, each cell split by the diagonal from lower left to upper right… Node sets "x-", "x+",
// "y-", "y+".
Mesh make_rectangle(double width, double height, int nx, int ny);
// … and rows that alternate between n and n - 1 nodes (equilateral triangles), `rows` rows, side
// width / (n - 1).
Mesh make_triangular_rectangle(double width, int n, int rows);

// Graded rectangle [0, size]: rows of the given numbers of nodes from bottom to top, steps at the
// right and at the top grade^2 times those at the left and at the bottom. N nodes of which B lie on
// the outline make 2 N - B - 2 triangles (Euler).
Mesh make_graded_rectangle(const Vec2& size, std::span<const int> n_row_nodes, double grade_x,
                           double grade_y);

}  // namespace trocar
