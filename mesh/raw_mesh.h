// What a mesh file says, before it is judged: cells of all dimensions with their groups. All
// formats come down to it, and one place (make_mesh) turns it into a sound Mesh or says what is
// wrong.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "mesh/mesh.h"
#include "mesh/triangle_mesh.h"

namespace trocar {

enum class CellKind : std::uint8_t { point, line, triangle, quadrangle, tetrahedron, hexahedron };
int n_cell_corners(CellKind kind);
int cell_dimension(CellKind kind);
const char* cell_kind_name(CellKind kind);

// A physical group of gmsh that has a name.
struct NamedGroup {
  int dimension = 0;
  std::int32_t tag = 0;
  std::string name;
};

// That a file gives to some cells.
using CellDirections = std::vector<std::pair<std::int32_t, Vec3>>;

struct RawMesh {
  std::string file;
  std::string tag_word;                   // how messages call cell_tag: "gmsh tag"
  std::vector<Vec3> X;                    // (n_nodes) finite
  std::vector<std::int64_t> node_tag;     // (n_nodes), or empty: the position is the name
  std::vector<CellKind> cell_kind;        // (n_cells)
  std::vector<std::int64_t> cell_tag;     // (n_cells)
  std::vector<std::int32_t> cell_group;   // (n_cells) index into the group lists, 0: no group
  std::vector<std::int32_t> cell_corner;  // positions in X, one cell after the other
  std::vector<std::int32_t> group_offset{0, 0};  // (n_group_lists + 1)
  std::vector<std::int32_t> group_tag;           // physical tags, one list after the other
  std::vector<NamedGroup> named_groups;
  CellDirections fibre;
  std::string left_out;  // what of the file's data no mesh has, for a warning

  std::int32_t n_cells() const { return static_cast<std::int32_t>(cell_kind.size()); }
  std::span<const std::int32_t> groups(std::int32_t list) const {
    return {group_tag.data() + group_offset[list],
            static_cast<std::size_t>(group_offset[list + 1] - group_offset[list])};
  }
};

// Throws InputError if the numbers of the mesh would not fit 32 bits.
void add_cell(RawMesh& raw, CellKind kind, std::span<const std::int32_t> corners, std::int64_t tag,
              std::int32_t group);
void reserve_cells(RawMesh& raw, std::size_t n);
// Where cell_group holds physical tags themselves (0: none), makes group lists of them.
void make_group_lists(RawMesh& raw);

// Calls f(cell, corners) for each cell of the dimension.
template <class F>
void for_cells(const RawMesh& raw, int dimension, const F& f) {
  const std::int32_t* corner = raw.cell_corner.data();
  for (std::int32_t c = 0; c < raw.n_cells(); ++c) {
    const auto n = static_cast<std::size_t>(n_cell_corners(raw.cell_kind[c]));
    if (cell_dimension(raw.cell_kind[c]) == dimension) f(c, std::span(corner, n));
    corner += n;
  }
}

// The volume (or plane) mesh of it, positions times `scale`. Throws InputError naming the element.
Mesh make_mesh(RawMesh raw, double scale);
// For a file that holds no mesh but a surface; count: "12 triangles".
[[noreturn]] void fail_surface(const std::string& file, const std::string& count);
// Its triangles and quadrangles, the latter as two triangles; vertices not merged. Throws
// InputError if it holds volume elements.
TriangleMesh make_surface(const RawMesh& raw);

// Finds the position of a tag; tags may be sparse, unordered, negative.
class TagIndex {
 public:
  // `tag` outlives the index.
  explicit TagIndex(std::span<const std::int64_t> tag);
  // -1 if there is none.
  std::int32_t find(std::int64_t tag) const;
  // Position of the second of two equal tags, -1 if all differ.
  std::int32_t duplicate() const { return duplicate_; }

 private:
  void fill_dense();
  void fill_sorted();

  std::span<const std::int64_t> tag_;
  std::int64_t low_ = 0;
  bool is_dense_ = false;
  std::vector<std::int32_t> position_;  // of tag low_ + k if dense, else of all tags in order
  std::int32_t duplicate_ = -1;
};

}  // namespace trocar
