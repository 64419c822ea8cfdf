#include "cutting_plane.h"

#include <map>

namespace trocar {

std::vector<std::uint8_t> none_held(const Mesh& mesh) {
  return std::vector<std::uint8_t>(mesh.X.size(), 0);
}

PlaneCut cut(const Mesh& mesh, const std::vector<Vec3>& path, std::int32_t tip, bool is_robust) {
  const CutPlaneOptions options = is_robust ? CutPlaneOptions{} : published_options();
  return cut_plane(mesh, path, tip, {none_held(mesh)}, options);
}

Mesh applied(const MeshEdit& edit, Mesh mesh) {
  apply_edit(edit, mesh);
  return mesh;
}

double least_altitude(const Mesh& mesh) {
  double least = 1e300;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    least = std::min(least, least_altitude(mesh, e, mesh.X));
  return least;
}

bool has_closed_boundary(const Mesh& mesh) {
  const FacetNeighbours across = facet_neighbours(mesh);
  std::map<std::int32_t, int> in, out;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 3; ++f)
      if (across.of(e, f) < 0) {
        ++out[mesh.corners(e)[(f + 1) % 3]];
        ++in[mesh.corners(e)[(f + 2) % 3]];
      }
  const auto is_one = [](const auto& entry) { return entry.second == 1; };
  return in.size() == out.size() && std::all_of(in.begin(), in.end(), is_one) &&
         std::all_of(out.begin(), out.end(), is_one);
}

int n_marked_sides(const Mesh& mesh, bool& are_on_boundary) {
  const FacetNeighbours across = facet_neighbours(mesh);
  int n = 0;
  are_on_boundary = true;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 3; ++f)
      if ((mesh.cut_facets[e] >> f & 1) != 0) {
        ++n;
        are_on_boundary = are_on_boundary && across.of(e, f) < 0;
      }
  return n;
}

}  // namespace trocar
