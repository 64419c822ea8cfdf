// The meshes that bench_cut cuts; all about 3,000 tetrahedra but the organ.
#include <time.h>

#include <filesystem>

#include "cut_case.h"
#include "mesh/mesh_file.h"

namespace trocar::cut_bench {

double mean_edge(const Mesh& mesh) {
  return cutting_test::mean_edge_of(mesh);
}

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

static Mesh cube(BoxElements elements, double amount, unsigned seed) {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, elements);
  if (amount > 0) jitter(mesh, amount, seed);
  return mesh;
}

static Family from_file(const std::string& file) {
  return {std::filesystem::path(file).stem().string(),
          [mesh = read_mesh(file, 1)](unsigned) { return mesh; }};
}

std::vector<Family> families(const std::vector<std::string>& mesh_files) {
  std::vector<Family> all = {
      {"kuhn", [](unsigned) { return cube(BoxElements::tet4_kuhn, 0, 0); }},
      {"five", [](unsigned) { return cube(BoxElements::tet4_five, 0, 0); }},
      {"jittered", [](unsigned seed) { return cube(BoxElements::tet4_kuhn, 0.2, seed); }},
      {"ball",
       [](unsigned) {
         return make_ball({0.5, 0.5, 0.5}, 0.5, 8, BoxElements::tet4_kuhn);
       }},
      from_file(TROCAR_SOURCE "/bench/meshes/box_delaunay.msh"),
      from_file(TROCAR_SOURCE "/configs/meshes/liver.msh")};
  for (const std::string& file : mesh_files) all.push_back(from_file(file));
  return all;
}

}  // namespace trocar::cut_bench
