#include "study/study_interpolate.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/check.h"
#include "engine/mesh_measures.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

using Simplex = std::array<std::int32_t, 4>;  // nodes; -1 fills up

// Six tetrahedra around the diagonal from corner 0 to 6, corners as in VTK.
constexpr int hex_tets[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};

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
    for (const auto& tet : hex_tets)
      simplices.push_back({c[tet[0]], c[tet[1]], c[tet[2]], c[tet[3]]});
  }
  return simplices;
}

const Vec3& at(const Mesh& mesh, std::int32_t node) {
  return mesh.X[node];
}

// Whether the point is within `reach` of the simplex's box.
bool is_near(const Mesh& mesh, const Simplex& simplex, const Vec3& point, double reach) {
  Box box;
  for (const std::int32_t node : simplex)
    if (node >= 0) box.add(at(mesh, node));
  return box.holds(point, reach);
}

SamplePoint weigh(const Mesh& mesh, const Simplex& simplex, const Vec3& point) {
  Mat3 edges = Mat3::Identity();  // a triangle's plane is z = 0
  const int n = simplex[3] < 0 ? 2 : 3;
  for (int a = 0; a < n; ++a)
    edges.col(a) = at(mesh, simplex[static_cast<std::size_t>(a) + 1]) - at(mesh, simplex[0]);
  const Vec3 w = edges.inverse() * (point - at(mesh, simplex[0]));
  SamplePoint sample{.weight = {1 - w[0] - w[1], w[0], w[1], 0}};
  if (n == 3) {
    sample.weight[0] -= w[2];
    sample.weight[3] = w[2];
  }
  for (std::size_t a = 0; a < 4; ++a) sample.node[a] = std::max(simplex[a], 0);
  return sample;
}

double least_weight(const SamplePoint& sample, const Simplex& simplex) {
  const auto end = sample.weight.begin() + (simplex[3] < 0 ? 3 : 4);
  return *std::min_element(sample.weight.begin(), end);
}

// The best of the simplices within reach; false if there is none.
bool locate(const Mesh& mesh, const std::vector<Simplex>& simplices, const Vec3& point,
            double reach, SamplePoint& best) {
  double most = -1e300;
  for (const Simplex& simplex : simplices) {
    if (!is_near(mesh, simplex, point, reach)) continue;
    const SamplePoint sample = weigh(mesh, simplex, point);
    const double least = least_weight(sample, simplex);
    if (!(least > most)) continue;
    most = least;
    best = sample;
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
    sum += sample.weight[a] * Vec3::Map(&u[3 * static_cast<std::size_t>(sample.node[a])]);
  return sum;
}

std::vector<Vec3> surface_points(const Mesh& mesh, std::size_t n_most) {
  const Surface surface = boundary_surface(mesh);
  const std::size_t stride = (surface.node.size() + n_most - 1) / n_most;
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < surface.node.size(); k += stride)
    points.push_back(at(mesh, surface.node[k]));
  return points;
}

}  // namespace trocar
