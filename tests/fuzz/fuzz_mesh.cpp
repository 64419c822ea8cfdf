// Mesh files by the front door: format by content, then what `trocar mesh` looks at.
#include "base/check.h"
#include "fuzz_targets.h"
#include "mesh/mesh_file.h"
#include "mesh/quality.h"
#include "mesh/vtu_file.h"
#include "mesh_sample_files.h"
#include "test_files.h"

namespace trocar {

namespace {

void look_at(const Mesh& mesh) {
  CHECK(!mesh.X.empty() && mesh.n_elements() > 0);
  for (const Vec3& X : mesh.X) CHECK(X.allFinite());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    for (const std::int32_t i : mesh.corners(e)) CHECK(i >= 0 && i < mesh.n_nodes());
    CHECK_OP(element_volume(mesh, e, mesh.X), >, 0);
  }
  validate(mesh);
  mesh_statistics(mesh);
  elements_by_region(mesh);
}

void look_at(const TriangleMesh& surface) {
  CHECK(!surface.triangle.empty());
  for (const Vec3& x : surface.X) CHECK(x.allFinite());
  for (const auto& triangle : surface.triangle)
    for (const std::int32_t i : triangle)
      CHECK(i >= 0 && static_cast<std::size_t>(i) < surface.X.size());
}

// A file is a body's or an instrument's.
bool read_both(const std::string& name, std::string_view bytes) {
  const std::string file = hostile_file(name, bytes);
  const bool is_body = is_taken([&] { look_at(read_mesh(file, 1e-3)); });
  const bool is_surface = is_taken([&] { look_at(read_triangle_mesh(file, 1e-3)); });
  return is_body || is_surface;
}

std::vector<FuzzSeed> samples_with(std::string_view ending) {
  std::vector<FuzzSeed> seeds;
  for (const test::SampleFile& sample : test::sample_files())
    if (sample.name.ends_with(ending)) seeds.push_back({sample.name, sample.content});
  return seeds;
}

}  // namespace

bool read_gmsh_bytes(std::string_view bytes) {
  return read_both("x.msh", bytes);
}
bool read_vtk_bytes(std::string_view bytes) {
  return read_both("x.vtk", bytes);
}
bool read_vtu_bytes(std::string_view bytes) {
  return read_both("x.vtu", bytes);
}
bool read_stl_bytes(std::string_view bytes) {
  return read_both("x.stl", bytes);
}
bool read_obj_bytes(std::string_view bytes) {
  return read_both("x.obj", bytes);
}

std::vector<FuzzSeed> gmsh_seeds() {
  return samples_with(".msh");
}
std::vector<FuzzSeed> vtk_seeds() {
  return samples_with(".vtk");
}

std::vector<FuzzSeed> vtu_seeds() {
  std::vector<FuzzSeed> seeds = samples_with(".vtu");
  const TestFolder folder;
  const Mesh mesh = test::sample_mesh();
  write_vtu(mesh, mesh.X, {}, {}, folder.file("zlib.vtu"));
  seeds.push_back({"zlib.vtu", read_text(folder.file("zlib.vtu"))});
  return seeds;
}

std::vector<FuzzSeed> stl_seeds() {
  return {{"ascii.stl", test::stl_ascii()},
          {"binary.stl", test::stl_binary()},
          {"binary_that_begins_with_solid.stl", test::stl_binary("solid")}};
}

std::vector<FuzzSeed> obj_seeds() {
  return {{"a.obj", test::obj()}};
}

}  // namespace trocar
