// Which format a mesh file has: by its content, then by its ending.
#include "mesh/mesh_file.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "base/log.h"
#include "base/quoted.h"
#include "base/whole_file.h"
#include "mesh/mesh_file_formats.h"

namespace trocar {

namespace {

enum class Format { gmsh, legacy_vtk, vtu, stl, obj, unknown };

bool has_ending(const std::string& file, std::string_view ending) {
  return in_small_letters(file).ends_with(ending);
}

Format format_by_ending(const std::string& file) {
  if (has_ending(file, ".msh")) return Format::gmsh;
  if (has_ending(file, ".vtk")) return Format::legacy_vtk;
  if (has_ending(file, ".vtu")) return Format::vtu;
  if (has_ending(file, ".stl")) return Format::stl;
  return has_ending(file, ".obj") ? Format::obj : Format::unknown;
}

Format find_format(const std::string& file, std::string_view bytes) {
  if (is_binary_stl(bytes) && has_ending(file, ".stl")) return Format::stl;
  const std::size_t start = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  const std::string_view text = bytes.substr(start);
  if (text.starts_with("# vtk DataFile")) return Format::legacy_vtk;
  if (text.starts_with("<")) return Format::vtu;
  if (text.starts_with("$")) return Format::gmsh;
  if (text.starts_with("solid")) return Format::stl;
  return format_by_ending(file);
}

bool is_surface(Format format) {
  return format == Format::stl || format == Format::obj;
}

RawMesh read_cells(Format format, FileReader& in) {
  if (format == Format::gmsh) return read_gmsh(in);
  if (format == Format::legacy_vtk) return read_legacy_vtk(in);
  return read_vtu_cells(in);
}

TriangleMesh read_triangles(Format format, FileReader& in) {
  return format == Format::stl ? read_stl(in) : read_obj(in);
}

// Some editors put a mark of UTF-8 before the text.
std::string_view without_mark(std::string_view bytes) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return bytes.starts_with(mark) ? bytes.substr(mark.size()) : bytes;
}

// What read(format, reader) makes of the file, whose bytes are freed then. unknown: what is said of
// one in no known format.
template <class Read>
auto read_as(const std::string& file, const std::string& unknown, const Read& read) {
  const std::string whole = read_whole_file(file);
  const std::string_view bytes = without_mark(whole);
  FileReader in(file, bytes);
  const Format format = find_format(file, bytes);
  if (format == Format::unknown) in.fail_file(unknown);
  return read(format, in);
}

RawMesh read_raw_mesh(const std::string& file) {
  return read_as(file,
                 "is in no known mesh format: gmsh .msh (1.0, 2.2, 4.1), legacy VTK and VTU are",
                 [&](Format format, FileReader& in) {
                   if (!is_surface(format)) return read_cells(format, in);
                   const TriangleMesh surface = merge_vertices(file, read_triangles(format, in));
                   fail_surface(file, std::to_string(surface.triangle.size()) + " triangles");
                 });
}

TriangleMesh read_surface(const std::string& file) {
  return read_as(file, "is in no known surface format: STL, OBJ, gmsh .msh, legacy VTK and VTU are",
                 [](Format format, FileReader& in) {
                   return is_surface(format) ? read_triangles(format, in)
                                             : make_surface(read_cells(format, in));
                 });
}

}  // namespace

bool is_surface_file(const std::string& file) {
  return is_surface(format_by_ending(file));
}

Mesh read_mesh(const std::string& file, double scale) {
  RawMesh raw = read_raw_mesh(file);
  if (!raw.left_out.empty()) log_warning(file + ": " + raw.left_out);
  return make_mesh(std::move(raw), scale);
}

TriangleMesh read_triangle_mesh(const std::string& file, double scale) {
  CHECK(std::isfinite(scale) && scale > 0);
  TriangleMesh mesh = read_surface(file);
  for (Vec3& x : mesh.X) {
    x *= scale;
    if (!x.allFinite())
      throw InputError(file + ": a vertex lies at a position that is not finite when scaled");
  }
  return merge_vertices(file, std::move(mesh));
}

}  // namespace trocar
