// Surfaces from STL (ASCII and binary) and OBJ files.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/quoted.h"
#include "mesh/equal_points.h"
#include "mesh/mesh_file_formats.h"

namespace trocar {

namespace {

constexpr std::size_t stl_header_bytes = 84;
constexpr std::size_t stl_triangle_bytes = 50;

Vec3 read_point(FileReader& in) {
  const double x = in.real("x"), y = in.real("y"), z = in.real("z");
  return {x, y, z};
}

// Triangle made of the three vertices added last.
void close_triangle(TriangleMesh& mesh) {
  const auto n = static_cast<std::int32_t>(mesh.X.size());
  mesh.triangle.push_back({n - 3, n - 2, n - 1});
}

// One or more solids, their names free text up to the end of the line.
TriangleMesh read_ascii_stl(FileReader& in) {
  TriangleMesh mesh;
  while (!in.is_at_end()) {
    in.expect_word("solid");
    in.line();
    while (in.peek_word() == "facet") {
      in.line();  // the normal follows from the corners
      in.expect_word("outer");
      in.expect_word("loop");
      for (int a = 0; a < 3; ++a) {
        in.expect_word("vertex");
        mesh.X.push_back(read_point(in));
      }
      in.expect_word("endloop");
      in.expect_word("endfacet");
      close_triangle(mesh);
    }
    in.expect_word("endsolid");
    in.line();
  }
  return mesh;
}

std::uint32_t stl_count(std::string_view bytes) {
  constexpr bool is_swapped = std::endian::native == std::endian::big;
  return FileReader::load_number<std::uint32_t>(bytes.data() + stl_header_bytes - 4, is_swapped);
}

TriangleMesh read_binary_stl(FileReader& in) {
  in.is_binary = true;
  in.swaps_bytes = std::endian::native == std::endian::big;
  in.take(stl_header_bytes - 4, "the header of a binary STL");
  const std::int64_t count = in.raw<std::uint32_t>("the number of triangles");
  const std::size_t n = in.check_count(count, stl_triangle_bytes, "triangles of a binary STL");
  TriangleMesh mesh;
  mesh.X.reserve(3 * n);
  mesh.triangle.reserve(n);
  for (std::size_t t = 0; t < n; ++t) {
    in.take(12, "a normal");
    for (int a = 0; a < 3; ++a) {
      Vec3 x;
      for (int i = 0; i < 3; ++i) x[i] = in.raw<float>("a vertex");
      if (!x.allFinite()) in.fail("triangle " + std::to_string(t) + " has a corner not finite");
      mesh.X.push_back(x);
    }
    in.take(2, "an attribute");
    close_triangle(mesh);
  }
  // Some programs add a few bytes.
  if (in.n_left() >= stl_triangle_bytes)
    in.fail("holds " + std::to_string(in.n_left()) + " bytes after the " + std::to_string(count) +
            " triangles that it announces: its number of triangles is wrong");
  return mesh;
}

// Vertex of "7", "7/1", "7//3" or "-1": from 1, or backwards from the last one so far.
std::int32_t obj_corner(FileReader& in, std::size_t n_vertices) {
  const std::string_view text = in.word("a corner of a face");
  const std::string_view number = text.substr(0, text.find('/'));
  std::int64_t k = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), k);
  if (error != std::errc() || end != number.data() + number.size())
    in.fail("a corner of a face should be a vertex number as in 7, 7/1 or 7//3, not " +
            in_quotes(text));
  const auto n = static_cast<std::int64_t>(n_vertices);
  if (k == 0 || k > n || k < -n)
    in.fail("a face refers to vertex " + std::to_string(k) + ", but " + std::to_string(n) +
            " vertices stand above it");
  return static_cast<std::int32_t>(k > 0 ? k - 1 : n + k);
}

// A large polygon that comes back to a vertex has a hole cut into it, which a fan would fill.
void check_simple(const FileReader& in, std::vector<std::int32_t> corner) {
  if (corner.size() <= 4) return;
  std::sort(corner.begin(), corner.end());
  const auto twice = std::adjacent_find(corner.begin(), corner.end());
  if (twice != corner.end())
    in.fail("a face of " + std::to_string(corner.size()) + " corners has vertex " +
            std::to_string(*twice + 1) + " twice; split it into triangles");
}

// A polygon as the fan of triangles around its first corner.
void read_obj_face(FileReader& in, std::vector<std::int32_t>& corner, TriangleMesh& mesh) {
  corner.clear();
  while (!in.is_at_line_end() && !in.peek_word().starts_with('#'))
    corner.push_back(obj_corner(in, mesh.X.size()));
  if (corner.size() < 3)
    in.fail("a face has " + std::to_string(corner.size()) + " corners; 3 are the least");
  check_simple(in, corner);
  for (std::size_t a = 2; a < corner.size(); ++a)
    mesh.triangle.push_back({corner[0], corner[a - 1], corner[a]});
}

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < stl_header_bytes) return false;
  const std::size_t n = stl_count(bytes);
  return n > 0 && (bytes.size() - stl_header_bytes) / stl_triangle_bytes >= n;
}

TriangleMesh read_stl(FileReader& in) {
  // A binary file may begin with "solid" as well: its length tells.
  if (is_binary_stl(in.rest())) return read_binary_stl(in);
  const std::string text = in_small_letters(in.rest());  // some programs write capitals
  FileReader of_text(in.file(), text);
  if (of_text.peek_word() == "solid") return read_ascii_stl(of_text);
  return read_binary_stl(in);
}

// From where the reader is, which stays there.
static std::size_t count_vertices(FileReader in) {
  std::size_t n = 0;
  for (; !in.is_at_end(); in.line())
    if (in.word("a keyword") == "v") ++n;
  return n;
}

TriangleMesh read_obj(FileReader& in) {
  constexpr std::size_t shortest = 8;  // "v 0 0 0" and the line's end: what says less is refused
  TriangleMesh mesh;
  // Growing would take seven times the file.
  mesh.X.reserve(std::min(count_vertices(in), in.n_left() / shortest + 1));
  std::vector<std::int32_t> corner;
  while (!in.is_at_end()) {
    const std::string_view keyword = in.word("a keyword");
    if (keyword == "v") mesh.X.push_back(read_point(in));
    if (keyword == "f") read_obj_face(in, corner, mesh);
    in.line();  // what else stands there (colours, normals, groups, materials) is of no use here
  }
  return mesh;
}

TriangleMesh merge_vertices(const std::string& file, TriangleMesh mesh) {
  constexpr std::size_t limit = std::numeric_limits<std::int32_t>::max() / 3;
  if (mesh.X.size() > limit || mesh.triangle.size() > limit)
    throw InputError(file + ": has more than " + std::to_string(limit) + " vertices or triangles");
  const std::vector<std::int32_t> first = first_equal(mesh.X);
  std::vector<std::int32_t> new_vertex(mesh.X.size(), -1);
  std::vector<Vec3> X;
  std::size_t n_kept = 0;
  for (const std::array<std::int32_t, 3>& triangle : mesh.triangle) {
    std::array<std::int32_t, 3> corner{};
    for (std::size_t a = 0; a < 3; ++a) corner[a] = first[triangle[a]];
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    for (std::int32_t& i : corner) {
      if (new_vertex[i] < 0) {
        new_vertex[i] = static_cast<std::int32_t>(X.size());
        X.push_back(mesh.X[i]);
      }
      i = new_vertex[i];
    }
    mesh.triangle[n_kept++] = corner;
  }
  if (n_kept == 0) throw InputError(file + ": holds no triangle with an area");
  mesh.triangle.resize(n_kept);
  mesh.X = std::move(X);
  return mesh;
}

}  // namespace trocar
