#include "engine/mesh_measures.h"

#include "mesh/facets.h"

namespace trocar {

double mean_edge_length(const Mesh& mesh) {
  double sum = 0;
  const auto edges = mesh_edges(mesh);
  for (const auto& [a, b] : edges) sum += (mesh.X[a] - mesh.X[b]).norm();
  return sum / static_cast<double>(edges.size());
}

std::vector<std::int64_t> elements_by_region(const Mesh& mesh) {
  std::vector<std::int64_t> n(mesh.region_name.size(), 0);
  for (const std::int32_t region : mesh.element_region) ++n[region];
  return n;
}

std::vector<Vec3> present_positions(std::span<const Vec3> X, std::span<const double> u) {
  std::vector<Vec3> x(X.begin(), X.end());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += Vec3(u[3 * i], u[3 * i + 1], u[3 * i + 2]);
  return x;
}

}  // namespace trocar
