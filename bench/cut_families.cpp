// The meshes that bench_cut cuts; all about 3,000 tetrahedra (512 hexahedra) but the organ, unless
// asked otherwise.
#include <cmath>
#include <filesystem>

#include "cut_case.h"
#include "mesh/mesh_file.h"

namespace trocar::cut_bench {

static Mesh cube(BoxElements elements, int n, double amount, unsigned seed) {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {n, n, n}, elements);
  if (amount > 0) jitter(mesh, amount, seed);
  return mesh;
}

// `amount`: how far nodes beside the interface are jittered.
static Mesh layered_cube(BoxElements elements, double amount, unsigned seed) {
  Mesh mesh = cube(elements, 8, amount, seed);
  for (Vec3& X : mesh.X)
    if (std::abs(X.z() - 0.5) < 0.5 * (1 - 2 * amount) / 8) X.z() = 0.5;
  cutting_test::add_region(mesh, [](const Vec3& X) { return X.z() > 0.5; });
  return mesh;
}

static Family from_file(const std::string& file) {
  return {std::filesystem::path(file).stem().string(),
          [mesh = read_mesh(file, 1)](unsigned) { return mesh; }};
}

std::vector<Family> generated_families(int n) {
  const auto cubes = [n](BoxElements elements, double amount) {
    return [=](unsigned seed) { return cube(elements, n, amount, seed); };
  };
  return {{"kuhn", cubes(BoxElements::tet4_kuhn, 0)},
          {"five", cubes(BoxElements::tet4_five, 0)},
          {"jittered", cubes(BoxElements::tet4_kuhn, 0.2)},
          {"ball",
           [n](unsigned) {
             return make_ball({0.5, 0.5, 0.5}, 0.5, n, BoxElements::tet4_kuhn);
           }},
          {"hex", cubes(BoxElements::hex8, 0)},
          {"hex_jittered", cubes(BoxElements::hex8, 0.1)}};
}

std::vector<Family> layered_families() {
  const auto cubes = [](BoxElements elements, double amount) {
    return [=](unsigned seed) { return layered_cube(elements, amount, seed); };
  };
  return {{"layers_kuhn", cubes(BoxElements::tet4_kuhn, 0)},
          {"layers_five", cubes(BoxElements::tet4_five, 0)},
          {"layers_jittered", cubes(BoxElements::tet4_kuhn, 0.2)},
          {"layers_hex", cubes(BoxElements::hex8, 0)}};
}

// 13 x 9 x 1 cells of unit edges; bent: about the y axis, by up to 0.4 edges at the ends.
static Mesh plate(BoxElements elements, bool is_bent, unsigned seed) {
  Mesh mesh = make_box(Vec3::Zero(), Vec3(13, 9, 1), {13, 9, 1}, elements);
  if (!is_bent) return mesh;
  std::mt19937_64 random(seed);
  const double bend = 0.01 * std::uniform_real_distribution<double>(-1, 1)(random);
  for (Vec3& X : mesh.X) X.z() += bend * (X.x() - 6.5) * (X.x() - 6.5);
  return mesh;
}

std::vector<Family> plate_families() {
  const auto plates = [](BoxElements elements, bool is_bent) {
    return [=](unsigned seed) { return plate(elements, is_bent, seed); };
  };
  return {{"plates_kuhn", plates(BoxElements::tet4_kuhn, false)},
          {"plates_five", plates(BoxElements::tet4_five, false)},
          {"plates_bent_kuhn", plates(BoxElements::tet4_kuhn, true)},
          {"plates_bent_five", plates(BoxElements::tet4_five, true)}};
}

std::vector<Family> families(int n_cells, const std::vector<std::string>& mesh_files) {
  std::vector<Family> all = generated_families(n_cells);
  all.push_back(from_file(TROCAR_SOURCE "/bench/meshes/box_delaunay.msh"));
  all.push_back(from_file(TROCAR_SOURCE "/configs/meshes/liver.msh"));
  for (const std::string& file : mesh_files) all.push_back(from_file(file));
  return all;
}

}  // namespace trocar::cut_bench
