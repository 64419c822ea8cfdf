// Random displacement of interior nodes: an irregular mesh from a regular one.
#include <algorithm>
#include <random>

#include "mesh/facet_sort.h"
#include "mesh/quality.h"
#include "mesh_fixtures.h"

namespace trocar {

// A star keeps this part of each element's quality; otherwise the move is halved.
static constexpr double kept_quality = 0.2;
static constexpr int max_halvings = 8;

static std::vector<std::uint8_t> boundary_nodes(const Mesh& mesh) {
  std::vector<std::uint8_t> is_boundary(mesh.X.size(), 0);
  for (const FacetSide& side : single_sides(mesh))
    for (const std::int32_t i : side.node)
      if (i >= 0) is_boundary[i] = 1;
  return is_boundary;
}

static std::vector<double> mean_edges_at_nodes(const Mesh& mesh) {
  std::vector<double> sum(mesh.X.size(), 0);
  std::vector<int> n(mesh.X.size(), 0);
  for (const auto& edge : mesh_edges(mesh))
    for (const std::int32_t i : edge) {
      sum[i] += (mesh.X[edge[1]] - mesh.X[edge[0]]).norm();
      ++n[i];
    }
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (n[i] > 0) sum[i] /= n[i];
  return sum;
}

// Uniform in the unit ball (disc in 2D). The generator's numbers are fixed by the C++ standard,
// those of std::uniform_real_distribution are not.
static Vec3 random_direction(std::mt19937_64& generator, int dimension) {
  Vec3 d = Vec3::Zero();
  do {
    for (int k = 0; k < dimension; ++k) d[k] = static_cast<double>(generator() >> 11) * 0x1p-52 - 1;
  } while (d.squaredNorm() > 1);
  return d;
}

static bool is_star_sound(const Mesh& mesh, std::span<const std::int32_t> star,
                          std::span<const double> least_quality) {
  return std::all_of(star.begin(), star.end(), [&](std::int32_t e) {
    return element_volume(mesh, e, mesh.X) > 0 &&
           element_quality(mesh, e, mesh.X) >= least_quality[e];
  });
}

void jitter(Mesh& mesh, double amount, unsigned seed) {
  const std::vector<std::uint8_t> is_boundary = boundary_nodes(mesh);
  const std::vector<double> h = mean_edges_at_nodes(mesh);
  const NodeElements around = node_elements(mesh);
  std::vector<double> least_quality;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    least_quality.push_back(kept_quality * element_quality(mesh, e, mesh.X));

  const int dimension = mesh.dimension();
  std::mt19937_64 generator(seed);
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    if (is_boundary[i] != 0) continue;
    const Vec3 X = mesh.X[i];
    Vec3 move = amount * h[i] * random_direction(generator, dimension);
    for (int k = 0; k <= max_halvings; ++k, move /= 2) {
      mesh.X[i] = X + move;
      if (is_star_sound(mesh, around.of(i), least_quality)) break;
      mesh.X[i] = X;
    }
  }
}

}  // namespace trocar
