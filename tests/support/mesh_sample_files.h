// One small mesh in every format that is read: two tetrahedra in two regions, a triangle that makes
// a node set, and a node that no element uses, which a reader has to drop.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "mesh/triangle_mesh.h"

namespace trocar::test {

// What reading must give where the format has groups.
Mesh sample_mesh();
// And where it has none.
Mesh sample_mesh_without_groups();

// Appends numbers as bytes in the order asked for.
template <class Number>
void put(std::string& bytes, Number number, std::endian order = std::endian::little) {
  char stored[sizeof(Number)];
  std::memcpy(stored, &number, sizeof(Number));
  for (std::size_t k = 0; k < sizeof(Number); ++k)
    bytes += stored[order == std::endian::native ? k : sizeof(Number) - 1 - k];
}

// Node tags of the gmsh files: unordered, with gaps.
inline constexpr std::int32_t sample_tag[6] = {10, 20, 7, 40, 50, 99};
inline constexpr double sample_X[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                          {0, 0, 1}, {1, 1, 1}, {7, 7, 7}};

std::string physical_names();

std::string gmsh_1();

std::string gmsh_2_ascii();

std::string gmsh_2_binary();

std::string gmsh_4_ascii();

void put_entity(std::string& f, std::int32_t tag, std::int32_t physical);

void put_block(std::string& f, std::int32_t a, std::int32_t b, std::int32_t c, std::uint64_t n);

std::string gmsh_4_binary();

std::string vtk_head(const std::string& version, const std::string& kind);

std::string vtk_4_ascii();

std::string vtk_5_ascii();

template <class Number, class List>
void put_all(std::string& f, const List& list) {
  for (const auto k : list) put(f, static_cast<Number>(k), std::endian::big);
}

std::string vtk_binary_points();

std::string vtk_binary_types();

std::string vtk_4_binary();

std::string vtk_5_binary();

std::string vtu_ascii();

// Appended raw data with 4-byte headers and big-endian numbers, plain.
std::string vtu_appended_raw();

struct SampleFile {
  std::string name, content;
  bool has_groups = false, has_names = false;
};

// Every volume format.
std::vector<SampleFile> sample_files();

// The surface of the unit tetrahedron.
inline constexpr int tetrahedron_face[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

std::string stl_ascii();

std::string stl_binary(const std::string& head = "binary");

std::string obj();

}  // namespace trocar::test
