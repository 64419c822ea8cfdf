#include "engine/markers.h"

#include "base/exact_sum.h"

namespace trocar {

std::vector<Location> locate_markers(std::span<const SceneMarker> markers, const Mesh& mesh) {
  if (markers.empty()) return {};
  std::vector<Vec3> points;
  for (const SceneMarker& marker : markers) points.push_back(marker.position);
  return locate_points(mesh, mesh.X, points);
}

std::vector<Location> follow_markers(std::span<const SceneMarker> markers, const Mesh& mesh) {
  std::vector<Location> locations = locate_markers(markers, mesh);
  for (std::size_t k = 0; k < locations.size(); ++k)
    if (locations[k].element < 0) locations[k] = locate_nearest(mesh, mesh.X, markers[k].position);
  return locations;
}

std::vector<Vec3> marker_positions(std::span<const Location> markers, const Mesh& mesh,
                                   const Part& part, std::span<const double> u,
                                   const Communicator& communicator) {
  std::vector<ExactSum3> sums(markers.size());
  for (std::size_t k = 0; k < markers.size(); ++k) {
    const Location& marker = markers[k];
    const std::span<const std::int32_t> corner = mesh.corners(marker.element);
    for (std::size_t a = 0; a < corner.size(); ++a) {
      const std::int32_t local = part.owned(corner[a]);
      if (local < 0) continue;
      add(marker.weight[a] * (mesh.X[corner[a]] + Vec3::Map(&u[3 * std::size_t(local)])), sums[k]);
    }
  }
  return sum_over_ranks(sums, communicator);
}

}  // namespace trocar
