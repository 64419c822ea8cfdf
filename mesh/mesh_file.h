// Reading meshes. Formats by content and ending: gmsh .msh 1.0, 2.2, 4.1 (ASCII and
// binary), legacy VTK, VTU for volumes; STL (ASCII and binary) and OBJ for surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "mesh/triangle_mesh.h"

namespace trocar {

// Volume (or plane, where triangles are all there is and they lie in z = const) mesh; positions
// times `scale`. Physical groups of surfaces, lines and points become node sets, those of volumes
// regions; nodes that no element uses are dropped, as are surface elements where there are volume
// elements. A file whose elements are all mirrored is turned round; if only some are inverted, or
// one is flat, that is an error. Throws InputError "file: sentence" naming the line or byte, or the
// element; counts are checked against the bytes left before anything is allocated.
Mesh read_mesh(const std::string& file, double scale);

// By its ending: STL or OBJ, which hold no volumes.
bool is_surface_file(const std::string& file);

// Surface of an instrument, from STL, OBJ or the surface elements of a file of the other formats
// that holds no volume elements; vertices merged where positions are equal. Throws InputError.
TriangleMesh read_triangle_mesh(const std::string& file, double scale);

}  // namespace trocar
