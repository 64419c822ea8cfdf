#include "cutting/cut_plane_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/quality.h"

namespace trocar {

namespace {

constexpr double in_mm = 1e3, in_mm2 = 1e6;  // a metre, a square metre

Spread spread(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto n = static_cast<double>(values.size());
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  Spread s{*least, *most, std::accumulate(values.begin(), values.end(), 0.0) / n, 0};
  double squares = 0;
  for (const double value : values) squares += (value - s.mean) * (value - s.mean);
  s.sigma = std::sqrt(squares / n);
  return s;
}

}  // namespace

PlaneStatistics plane_statistics(const Mesh& mesh) {
  std::vector<double> area, edge, of_two;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::span<const std::int32_t> corner = mesh.corners(e);
    area.push_back(in_mm2 * element_volume(mesh, e, mesh.X));
    for (std::size_t a = 0; a < 3; ++a) {
      edge.push_back(in_mm * (mesh.X[corner[a]] - mesh.X[corner[(a + 1) % 3]]).norm());
      if (a < 2) of_two.push_back(edge.back());
    }
  }
  return {mesh.n_nodes(), mesh.n_elements(), spread(area), spread(edge), spread(of_two).sigma};
}

}  // namespace trocar
