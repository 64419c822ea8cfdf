#include "engine/swept_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/cut_look.h"
#include "engine/cut_parted.h"
#include "engine/edge_place.h"
#include "mesh/element_boxes.h"

namespace trocar {

namespace {

// Between places along the blade's way, and how far aside of them a facet counts, over the mean
// edge.
constexpr double place_spacing = 0.5, place_aside = 0.75;
constexpr int most_places = 32;  // a frame

// Elements with cut facets, by the cells of a grid that their boxes touch.
class CutElements {
 public:
  CutElements(const Mesh& mesh, double cell, const Box& around) : cell_(cell) {
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
      if (mesh.cut_facets[e] == 0) continue;
      const Box box = element_box(mesh, e, mesh.X);
      if (box.overlaps(around)) at_cells(box, [&](const Cell& at) { of_[at].push_back(e); });
    }
  }
  bool part(const Mesh& mesh, const std::array<Vec3, 2>& segment) const {
    std::vector<std::int32_t> near;  // some twice
    at_cells(bounding_box(segment), [&](const Cell& at) {
      if (const auto found = of_.find(at); found != of_.end())
        near.insert(near.end(), found->second.begin(), found->second.end());
    });
    return is_parted(mesh, near, segment);
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  template <class Use>
  void at_cells(const Box& box, const Use& use) const {
    Cell low, high;
    for (int j = 0; j < 3; ++j) {
      low[j] = static_cast<std::int64_t>(std::floor(box.low[j] / cell_));
      high[j] = static_cast<std::int64_t>(std::floor(box.high[j] / cell_));
    }
    for (Cell at = low; at[0] <= high[0]; ++at[0])
      for (at[1] = low[1]; at[1] <= high[1]; ++at[1])
        for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) use(at);
  }

  double cell_;
  std::map<Cell, std::vector<std::int32_t>> of_;
};

}  // namespace

std::vector<SweptPlace> swept_places(const Simulation& s, BodyPositions& positions,
                                     const BladeSweep& sweep) {
  std::vector<Vec3> before = sweep.before;  // as the tissue sees it, which lies as at the end
  for (std::size_t i = 0; i < sweep.tissue_way.size(); ++i) before[i] += sweep.tissue_way[i];
  const Vec3 way = middle_of(sweep.after) - middle_of(before);
  const Vec3 own_way = middle_of(sweep.after) - middle_of(sweep.before);
  const Vec3 along = (sweep.after.back() - sweep.after.front()).normalized();
  // Tissue that swings past a blade goes through the same places again and again.
  const double across = std::min(along.cross(way).norm(), along.cross(own_way).norm());
  const double parts = std::ceil(across / (place_spacing * s.edge_length));
  std::vector<SweptPlace> places;
  if (!(parts > 0)) return places;
  const int n = static_cast<int>(std::min<double>(parts, most_places));
  for (int k = 0; k < n; ++k) {
    const std::vector<Vec3> edge = edge_between(before, sweep.after, (k + 0.5) / n);
    for (const SegmentPiece& piece : locate_edge(s, positions, edge)) {
      const EdgePlace place =
          place_of(s.mesh, positions.x(), piece.middle, along, way.normalized());
      places.push_back({place.X, place.normal(), piece.length * across / n});
    }
  }
  return places;
}

SweptArea measure_swept(const Mesh& mesh, double edge_length, std::span<const SweptPlace> places) {
  const double reach = place_aside * edge_length;
  Box around;
  for (const SweptPlace& place : places) around.add(place.X);
  const CutElements cut(mesh, 2 * edge_length, around.grown(reach));
  SweptArea area;
  for (const SweptPlace& place : places) {
    area.whole += place.area;
    const Vec3 beside = reach * place.normal;
    if (cut.part(mesh, {place.X - beside, place.X + beside})) area.parted += place.area;
  }
  return area;
}

}  // namespace trocar
