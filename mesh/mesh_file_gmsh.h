// What the parts of the gmsh reader share: the file so far, and numbers that are text in ASCII
// files and machine words in binary ones.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/file_reader.h"
#include "mesh/raw_mesh.h"

namespace trocar {

// A geometric entity of format 4.1, to which physical groups are given.
struct GmshEntity {
  int dimension = 0;
  std::int32_t tag = 0;
  std::int32_t group_list = 0;  // in RawMesh
};

struct GmshReader {
  FileReader& in;
  RawMesh mesh;
  int version = 0;                  // 1, 2 or 4
  bool is_binary = false;           // as the header says; in.is_binary while inside binary data
  std::optional<TagIndex> node_of;  // set once the nodes are read
  bool has_elements = false;
  std::vector<GmshEntity> entities;  // ascending (dimension, tag)
};

// Inside a section of a binary file numbers are binary; its first and last line are always text.
void begin_data(GmshReader& g);
void end_section(GmshReader& g, std::string_view end);

std::int64_t gmsh_int(GmshReader& g, const char* what);   // int
std::int64_t gmsh_size(GmshReader& g, const char* what);  // int64 (size_t) of format 4.1
double gmsh_real(GmshReader& g, const char* what);
Vec3 gmsh_point(GmshReader& g);

// A physical tag; its sign is an orientation, which does not matter here.
std::int32_t gmsh_physical_tag(GmshReader& g);
// Throws InputError naming the element where its type is not supported.
CellKind gmsh_cell_kind(const GmshReader& g, std::int64_t type, std::int64_t element);
// Adds the cell whose corners, numbers by `read`, come next.
void read_gmsh_corners(GmshReader& g, CellKind kind, std::int64_t tag, std::int32_t group,
                       std::int64_t (*read)(GmshReader&, const char* what));
// Builds node_of.
void finish_nodes(GmshReader& g);

// Format 1.0 and 2.x (mesh_file_gmsh_2.cpp).
void read_nodes_2(GmshReader& g, std::string_view end);
void read_elements_1(GmshReader& g);
void read_elements_2(GmshReader& g);
// Format 4.1 (mesh_file_gmsh_4.cpp).
void read_entities_4(GmshReader& g);
void read_nodes_4(GmshReader& g);
void read_elements_4(GmshReader& g);

}  // namespace trocar
