// The surface elements of a mesh file as the shape of an instrument.
#include "base/error.h"
#include "mesh/raw_mesh.h"

namespace trocar {

void fail_surface(const std::string& file, const std::string& count) {
  throw InputError(
      file + ": this file holds only a surface (" + count +
      "): make a volume mesh of it (docs/howto.md says how), or use it as an instrument");
}

TriangleMesh make_surface(const RawMesh& raw) {
  TriangleMesh mesh;
  mesh.X = raw.X;
  for_cells(raw, 3, [&](std::int32_t c, std::span<const std::int32_t>) {
    throw InputError(raw.file + ": holds volume elements (the first is " + raw.tag_word + " " +
                     std::to_string(raw.cell_tag[c]) +
                     "); save only its surface, e.g. as STL or OBJ");
  });
  for_cells(raw, 2, [&](std::int32_t, std::span<const std::int32_t> corner) {
    for (std::size_t a = 2; a < corner.size(); ++a)
      mesh.triangle.push_back({corner[0], corner[a - 1], corner[a]});
  });
  return mesh;
}

}  // namespace trocar
