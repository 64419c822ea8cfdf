#include "study/study_interpolate.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/check.h"
#include "mesh/barycentric.h"
#include "mesh/facets.h"
#include "mesh/hex_split.h"
#include "mesh/quality.h"

namespace trocar {

namespace {

using Simplex = std::array<std::int32_t, 4>;  // nodes; -1 fills up

std::span<const std::int32_t> nodes_in(const Simplex& simplex) {
  return std::span(simplex).first(simplex[3] < 0 ? 3 : 4);
}

std::vector<Simplex> simplices_of(const Mesh& mesh) {
  std::vector<Simplex> simplices;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::span<const std::int32_t> c = mesh.corners(e);
    if (mesh.element_type[e] != ElementType::hex8) {
      Simplex simplex{-1, -1, -1, -1};
      std::copy(c.begin(), c.end(), simplex.begin());
      simplices.push_back(simplex);
      continue;
    }
    for (const Simplex& simplex : hex_tet_nodes(mesh, e)) simplices.push_back(simplex);
  }
  return simplices;
}

// Whether the point is within `reach` of the simplex's box.
bool is_near(const Mesh& mesh, const Simplex& simplex, const Vec3& point, double reach) {
  Box box;
  for (const std::int32_t node : nodes_in(simplex)) box.add(mesh.X[node]);
  return box.holds(point, reach);
}

// The best of the simplices within reach; false if there is none.
bool locate(const Mesh& mesh, const std::vector<Simplex>& simplices, const Vec3& point,
            double reach, SamplePoint& best) {
  double most = -1e300;
  for (const Simplex& simplex : simplices) {
    if (!is_near(mesh, simplex, point, reach)) continue;
    const std::array<double, 4> weight = barycentric(nodes_in(simplex), mesh.X, point);
    const double least = std::ranges::min(std::span(weight).first(nodes_in(simplex).size()));
    if (!(least > most)) continue;
    most = least;
    best = {.node = simplex, .weight = weight};
  }
  return most > -1e300;
}

}  // namespace

std::vector<SamplePoint> locate_samples(const Mesh& mesh, std::span<const Vec3> points) {
  const std::vector<Simplex> simplices = simplices_of(mesh);
  CHECK(!simplices.empty());
  const double edge = mean_edge_length(mesh);
  std::vector<SamplePoint> samples(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    for (double reach = 1e-9 * edge; !locate(mesh, simplices, points[k], reach, samples[k]);)
      reach = std::max(2 * reach, edge / 2);
  return samples;
}

Vec3 interpolate(const SamplePoint& sample, std::span<const double> u) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < 4; ++a)
    if (sample.node[a] >= 0)
      sum += sample.weight[a] * Vec3::Map(&u[3 * static_cast<std::size_t>(sample.node[a])]);
  return sum;
}

std::vector<Vec3> surface_points(const Mesh& mesh, std::size_t n_most) {
  const Surface surface = boundary_surface(mesh);
  const std::size_t stride = (surface.node.size() + n_most - 1) / n_most;
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < surface.node.size(); k += stride)
    points.push_back(mesh.X[surface.node[k]]);
  return points;
}

}  // namespace trocar
