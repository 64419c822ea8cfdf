// The surface elements of a mesh file as the shape of an instrument.
#include "base/error.h"
#include "mesh/raw_mesh.h"

namespace trocar {

TriangleMesh make_surface(const RawMesh& raw) {
  TriangleMesh mesh;
  mesh.X = raw.X;
  const std::int32_t* corner = raw.cell_corner.data();
  for (std::int32_t c = 0; c < raw.n_cells(); ++c) {
    if (cell_dimension(raw.cell_kind[c]) == 3)
      throw InputError(raw.file + ": holds volume elements (the first is " + raw.tag_word + " " +
                       std::to_string(raw.cell_tag[c]) +
                       "); save only its surface, e.g. as STL or OBJ");
    const int n = n_cell_corners(raw.cell_kind[c]);
    for (int a = 2; a < n; ++a) mesh.triangle.push_back({corner[0], corner[a - 1], corner[a]});
    corner += n;
  }
  return mesh;
}

}  // namespace trocar
