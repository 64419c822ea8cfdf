// Writing gmsh .msh 4.1 ASCII, such that reading gives the same mesh: regions are physical groups
// of volumes (surfaces in 2D), node sets are physical groups of points.
#pragma once

#include <string>

#include "mesh/mesh.h"

namespace trocar {

// read_mesh gives the same mesh again if every node is used, but for fibres, density factors and
// what cuts have opened.
void write_mesh(const Mesh& mesh, const std::string& file);

}  // namespace trocar
