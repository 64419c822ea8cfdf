// Shape quality of elements and figures of a whole mesh.
#include "mesh/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/box.h"
#include "mesh/connected_nodes.h"
#include "mesh/element_shape.h"
#include "mesh/facets.h"

namespace trocar {

// |x|^(2/3) with the sign of x, by Newton's method on t^3 = |x|: quality steers cuts, so it stays
// away from libm's cube root.
static double signed_two_thirds_power(double x) {
  if (!(std::abs(x) > 0) || !std::isfinite(x)) return x;
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(x), &exponent);  // in [1/2, 1)
  const int shift = ((exponent % 3) + 3) % 3;
  const double scaled = std::ldexp(mantissa, shift);  // in [1/2, 4), cube root in [0.79, 1.59)
  double t = 1.2;
  for (int k = 0; k < 6; ++k) t -= (t * t * t - scaled) / (3 * t * t);
  const double root = std::ldexp(t, (exponent - shift) / 3);
  return x > 0 ? root * root : -root * root;
}

static double sum_of_squared_edges(ElementType type, std::span<const Vec3> x) {
  double sum = 0;
  for (const auto& [a, b] : edge_corners(type)) sum += (x[b] - x[a]).squaredNorm();
  return sum;
}

// min_a 3 det(A_a)^(2/3) / |A_a|^2, columns of A_a are the three edges at corner a (Knupp 2001).
static double hexahedron_quality(std::span<const Vec3> x) {
  // The three neighbours of each corner, right-handed.
  static constexpr int neighbour[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                          {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
  double quality = 1;
  for (int a = 0; a < 8; ++a) {
    Mat3 A;
    for (int k = 0; k < 3; ++k) A.col(k) = x[neighbour[a][k]] - x[a];
    const double det = A.col(0).dot(A.col(1).cross(A.col(2)));
    quality = std::min(quality, 3 * signed_two_thirds_power(det) / A.squaredNorm());
  }
  return quality;
}

double element_quality(ElementType type, std::span<const Vec3> x) {
  if (type == ElementType::hex8) return hexahedron_quality(x);
  const double V = element_volume(type, x);
  const double sum_l2 = sum_of_squared_edges(type, x);
  if (type == ElementType::tri3) return 4 * std::sqrt(3.0) * V / sum_l2;
  return 12 * signed_two_thirds_power(3 * V) / sum_l2;
}

double element_quality(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x) {
  return element_quality(mesh.element_type[e], corner_positions(mesh, e, x));
}

// Half the cross product of the diagonals: exact for flat faces.
static double facet_area(const Mesh& mesh, std::int32_t e, int f, std::span<const Vec3> x) {
  const std::array<int, 4> corner = facet_corners(mesh.element_type[e], f);
  const std::span<const std::int32_t> node = mesh.corners(e);
  const Vec3 &a = x[node[corner[0]]], &b = x[node[corner[1]]];
  if (corner[2] < 0) return (b - a).norm();
  const Vec3& c = x[node[corner[2]]];
  const Vec3& d = corner[3] < 0 ? a : x[node[corner[3]]];
  return 0.5 * (c - a).cross(d - b).norm();
}

double least_altitude(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x) {
  double largest = 0;
  for (int f = 0; f < n_facets(mesh.element_type[e]); ++f)
    largest = std::max(largest, facet_area(mesh, e, f, x));
  constexpr std::array<double, n_element_types> base_factor = {2, 3, 1};
  return base_factor[static_cast<std::size_t>(mesh.element_type[e])] * element_volume(mesh, e, x) /
         largest;
}

using MeshEdges = std::vector<std::array<std::int32_t, 2>>;

static double mean_length(const Mesh& mesh, const MeshEdges& edges) {
  double sum = 0;
  for (const auto& [a, b] : edges) sum += (mesh.X[a] - mesh.X[b]).norm();
  return sum / static_cast<double>(edges.size());
}

double mean_edge_length(const Mesh& mesh) {
  return mean_length(mesh, mesh_edges(mesh));
}

std::vector<std::int64_t> elements_by_region(const Mesh& mesh) {
  std::vector<std::int64_t> n(mesh.region_name.size(), 0);
  for (const std::int32_t region : mesh.element_region) ++n[region];
  return n;
}

static void count_edges(const Mesh& mesh, MeshStatistics& statistics) {
  const MeshEdges edges = mesh_edges(mesh);
  if (edges.empty()) return;
  statistics.edge_min = std::numeric_limits<double>::max();
  for (const auto& [a, b] : edges) {
    const double length = (mesh.X[a] - mesh.X[b]).norm();
    statistics.edge_min = std::min(statistics.edge_min, length);
    statistics.edge_max = std::max(statistics.edge_max, length);
  }
  statistics.edge_mean = mean_length(mesh, edges);
}

ElementStatistics element_statistics(const Mesh& mesh) {
  ElementStatistics statistics;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    ++statistics.n_elements_by_type[static_cast<std::size_t>(mesh.element_type[e])];
    statistics.volume += element_volume(mesh, e, mesh.X);
    const double quality = element_quality(mesh, e, mesh.X);
    statistics.quality_mean += quality / mesh.n_elements();
    if (e > 0 && !(quality < statistics.quality_min)) continue;
    statistics.quality_min = quality;
    statistics.worst_element = e;
  }
  return statistics;
}

PieceStatistics piece_statistics(const Mesh& mesh) {
  const std::vector<std::int32_t> piece = connected_nodes(mesh);
  PieceStatistics statistics{.n_pieces = count_pieces(piece)};
  if (statistics.n_pieces > 1)
    statistics.n_unjoined = count_unjoined(mesh, piece, 1e-6 * mean_edge_length(mesh));
  return statistics;
}

MeshStatistics mesh_statistics(const Mesh& mesh) {
  MeshStatistics statistics{element_statistics(mesh), piece_statistics(mesh)};
  statistics.n_nodes = mesh.n_nodes();
  statistics.n_surface_triangles =
      static_cast<std::int32_t>(boundary_surface(mesh).triangle.size());
  if (!mesh.X.empty()) statistics.box = bounding_box(mesh.X);
  count_edges(mesh, statistics);
  return statistics;
}

}  // namespace trocar
