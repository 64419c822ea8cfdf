#include "engine/tissue_way.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/box.h"
#include "base/segment.h"
#include "engine/simulation.h"

namespace trocar {

double share_of_frame(double seconds) {
  constexpr double memory = 0.3;  // [s]
  return seconds / (memory + seconds);
}

double largest_surface_way(const Simulation& s) {
  double most = 0;
  for (const std::int32_t local : s.view.local) {
    const Vec3 way = present_position(s, local) - s.view.x[s.part.node_global[local]];
    most = std::max(most, way.squaredNorm());
  }
  return std::sqrt(s.communicator->all_max(most));
}

namespace {

std::vector<std::int32_t> surface_nodes_near(const Simulation& s, PresentPositions& positions,
                                             const BladeSweep& sweep, double reach) {
  Box box;
  for (const std::vector<Vec3>* edge : {&sweep.before, &sweep.after}) box.add(bounding_box(*edge));
  box = box.grown(reach);
  std::vector<std::int32_t> nodes;
  std::ranges::set_intersection(positions.nodes_near({.low = box.low, .high = box.high}),
                                s.surface.node, std::back_inserter(nodes));
  return nodes;
}

}  // namespace

std::vector<Vec3> ways_beside(const Simulation& s, PresentPositions& positions,
                              const BladeSweep& sweep, double reach) {
  const std::vector<std::int32_t> nodes = surface_nodes_near(s, positions, sweep, reach);
  if (nodes.empty()) return {};
  std::vector<Vec3> ways(sweep.before.size());
  for (std::size_t k = 0; k < ways.size(); ++k) {
    double least = 1e300;
    for (const std::int32_t node : nodes) {
      const Vec3& x = positions.x()[node];
      const Vec3 way = x - s.view.x[node];
      const double distance =
          (x - nearest_on_segment(Vec3(sweep.before[k] + way), sweep.after[k], x)).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      ways[k] = way;
    }
  }
  return ways;
}

std::optional<Vec3> velocity_beside(const Simulation& s, PresentPositions& positions,
                                    const std::vector<Vec3>& edge, double reach) {
  double least = reach * reach;
  std::optional<Vec3> velocity;
  for (const std::int32_t node :
       surface_nodes_near(s, positions, {.before = edge, .after = edge}, reach)) {
    const auto i = static_cast<std::size_t>(node);
    const Vec3& x = s.cut_state.x[i];
    const double distance = (x - nearest_on_segment(edge.front(), edge.back(), x)).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    velocity = Vec3::Map(&s.cut_state.v[3 * i]);
  }
  return velocity;
}

Vec3 velocity_along(const Simulation& s, std::span<const SegmentPiece> engaged) {
  std::vector<std::int32_t> node;
  std::vector<double> share;
  double length = 0;
  for (const SegmentPiece& piece : engaged) {
    const auto corner = s.mesh.corners(piece.middle.element);
    node.insert(node.end(), corner.begin(), corner.end());
    for (std::size_t a = 0; a < corner.size(); ++a)
      share.push_back(piece.middle.weight[a] * piece.length);
    length += piece.length;
  }
  const std::vector<double> motion = motion_at(s, node, *s.communicator);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < node.size(); ++k) sum += share[k] * Vec3::Map(&motion[6 * k + 3]);
  return length > 0 ? Vec3(sum / length) : sum;
}

}  // namespace trocar
