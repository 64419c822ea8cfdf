// The readers of the single formats, behind mesh_file.h. Each throws InputError.
#pragma once

#include <string>

#include "mesh/file_reader.h"
#include "mesh/raw_mesh.h"
#include "mesh/triangle_mesh.h"

namespace trocar {

// .msh 1.0 (ASCII), 2.x and 4.1 (ASCII and binary).
RawMesh read_gmsh(FileReader& in);
// Legacy VTK, UNSTRUCTURED_GRID, ASCII and BINARY, cells in the layout up to 4.2 and that of 5.1.
RawMesh read_legacy_vtk(FileReader& in);
// VTK XML unstructured grid of one piece.
RawMesh read_vtu_cells(FileReader& in);

// Triangles as they stand in the file, vertices not yet merged.
TriangleMesh read_stl(FileReader& in);
TriangleMesh read_obj(FileReader& in);
// Length and triangle count of a binary STL fit together.
bool is_binary_stl(std::string_view bytes);

// Vertices at equal positions become one, in the order of their first use. Triangles left with
// fewer than three different vertices have no area and are dropped, as are unused vertices.
// Throws InputError if nothing is left.
TriangleMesh merge_vertices(const std::string& file, TriangleMesh mesh);

}  // namespace trocar
