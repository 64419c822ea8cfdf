#include "mesh_fixtures.h"

#include <numeric>

namespace trocar {

Mesh single_element(ElementType type, const std::vector<Vec3>& X) {
  Mesh mesh;
  mesh.X = X;
  std::vector<std::int32_t> corners(X.size());
  std::iota(corners.begin(), corners.end(), 0);
  add_element(mesh, type, corners);
  return mesh;
}

const std::vector<Vec3>& unit_cube_corners() {
  static const std::vector<Vec3> X = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  return X;
}

Mesh mixed_mesh(int n) {
  const Vec3 high(.06, .03, .03);
  const std::array<int, 3> cells = {8 * n, 4 * n, 4 * n};
  const Mesh hex = make_box(Vec3(0, 0, 0), high, cells, BoxElements::hex8);
  const Mesh tet = make_box(Vec3(0, 0, 0), high, cells, BoxElements::tet4_kuhn);
  Mesh mesh;
  mesh.X = hex.X;
  mesh.region_name = {"a", "b", "c"};
  for (std::int32_t cell = 0; cell < hex.n_elements(); ++cell)
    if (cell % (8 * n) < 4 * n)
      add_element(mesh, ElementType::hex8, hex.corners(cell), cell % 3);
    else
      for (int k = 0; k < 6; ++k)
        add_element(mesh, ElementType::tet4, tet.corners(6 * cell + k), (cell + k) % 3);
  return mesh;
}

Mesh with_thin_layer(BoxElements elements, int n) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.10, .03, .03), {10 * n, 3 * n, 3 * n}, elements);
  const double cell = .01 / n;
  for (Vec3& X : mesh.X)
    if (X.x() > 1.5 * cell) X.x() -= .9375 * cell;  // all behind the second plane of nodes
  return mesh;
}

std::vector<NamedMesh> volume_meshes() {
  std::vector<NamedMesh> meshes;
  const Vec3 low(-0.1, 0.2, 0), high(0.2, 0.4, 0.1);
  meshes.push_back({"hex8 box", make_box(low, high, {3, 4, 2}, BoxElements::hex8)});
  meshes.push_back({"Kuhn box", make_box(low, high, {3, 2, 4}, BoxElements::tet4_kuhn)});
  meshes.push_back({"five box", make_box(low, high, {3, 3, 2}, BoxElements::tet4_five)});
  meshes.push_back({"hex8 ball", make_ball(low, 0.1, 5, BoxElements::hex8)});
  meshes.push_back({"Kuhn ball", make_ball(low, 0.1, 6, BoxElements::tet4_kuhn)});
  meshes.push_back({"hex8 cylinder", make_cylinder(low, 0.1, 0.3, 4, 5, BoxElements::hex8)});
  meshes.push_back({"Kuhn cylinder", make_cylinder(low, 0.1, 0.3, 5, 4, BoxElements::tet4_kuhn)});
  meshes.push_back({"jittered box", make_box(low, high, {4, 3, 3}, BoxElements::tet4_kuhn)});
  jitter(meshes.back().mesh, 0.2, 1);
  return meshes;
}

std::vector<NamedMesh> plane_meshes() {
  return {{"rectangle", make_rectangle(0.070, 0.040, 10, 8)},
          {"triangular", make_triangular_rectangle(0.070, 10, 8)}};
}

std::vector<NamedMesh> all_meshes() {
  std::vector<NamedMesh> meshes = volume_meshes();
  for (NamedMesh& plane : plane_meshes()) meshes.push_back(std::move(plane));
  return meshes;
}

double largest_way(std::span<const Vec3> x, const ElementBoxes& boxes) {
  double most = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    most = std::max(most, (x[i] - boxes.x.at(i)).cwiseAbs().maxCoeff());
  return most;
}

double total_volume(const Mesh& mesh) {
  double sum = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) sum += element_volume(mesh, e, mesh.X);
  return sum;
}

double total_mass(const Mesh& mesh) {
  double sum = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    sum += mesh.density_factor[e] * element_volume(mesh, e, mesh.X);
  return sum;
}

bool is_closed(const Triangles& triangles) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> count;
  for (const auto& t : triangles)
    for (std::size_t a = 0; a < 3; ++a) ++count[{t[a], t[(a + 1) % 3]}];
  return std::all_of(count.begin(), count.end(), [&](const auto& entry) {
    const auto reverse = count.find({entry.first.second, entry.first.first});
    return entry.second == 1 && reverse != count.end();
  });
}

int euler_characteristic(const Triangles& triangles) {
  std::set<std::int32_t> vertices;
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  for (const auto& t : triangles)
    for (std::size_t a = 0; a < 3; ++a) {
      vertices.insert(t[a]);
      edges.insert(std::minmax(t[a], t[(a + 1) % 3]));
    }
  return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) +
         static_cast<int>(triangles.size());
}

int euler_characteristic(const Mesh& mesh) {
  return euler_characteristic(boundary_surface(mesh).triangle);
}

double enclosed_volume(const Triangles& triangles, const std::vector<Vec3>& X) {
  double sum = 0;
  for (const auto& [a, b, c] : triangles)
    sum += (X[a] - X[0]).dot((X[b] - X[0]).cross(X[c] - X[0])) / 6;
  return sum;
}

}  // namespace trocar
