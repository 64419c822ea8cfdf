#include "engine/blade_drag.h"

#include <algorithm>
#include <cmath>

namespace trocar {

namespace {

BladeDrag::Node& node_of(BladeDrag& drag, std::int32_t tool, std::int32_t local) {
  const auto place = std::lower_bound(
      drag.node.begin(), drag.node.end(), std::pair(tool, local),
      [](const BladeDrag::Node& n, const auto& key) { return std::pair(n.tool, n.local) < key; });
  if (place != drag.node.end() && place->tool == tool && place->local == local) return *place;
  return *drag.node.insert(place, {.local = local, .tool = tool});
}

}  // namespace

Vec3 direction_of(const EngagedEdge& edge) {
  constexpr double goes_along = 0.1;
  const Vec3 relative = edge.velocity - edge.tissue_velocity;
  const bool is_along = relative.norm() < goes_along * edge.velocity.norm();
  const Vec3& way = is_along ? edge.velocity : relative;
  const double size = way.norm();
  return size > 0 ? Vec3(way / size) : Vec3::Zero();
}

void add_engaged_edge(const EngagedEdge& edge, const Mesh& mesh, const Part& part,
                      double resistance, BladeDrag& drag) {
  const Vec3 direction = direction_of(edge);
  if (resistance == 0 || direction.isZero(0)) return;
  for (const auto& [location, length] : edge.piece) {
    const auto corner = mesh.corners(location.element);
    for (std::size_t a = 0; a < corner.size(); ++a) {
      const std::int32_t local = part.owned(corner[a]);
      if (local < 0) continue;
      BladeDrag::Node& node = node_of(drag, edge.tool, local);
      node.most += location.weight[a] * resistance * length;
      node.speed = direction.dot(edge.velocity);
      node.direction = direction;
    }
  }
}

void add_drag(const Model& model, const State& state, double dt, BladeDrag& drag,
              std::span<double> force) {
  if (drag.node.empty()) return;
  const double gain = step_response(model, state, dt) / dt;  // of velocity to force over mass
  for (BladeDrag::Node& node : drag.node) {
    const auto k = 3 * static_cast<std::size_t>(node.local);
    const double behind = node.speed - node.direction.dot(Vec3::Map(&state.v[k]));  // [m/s]
    const double mass = model.mass[node.local];
    auto f = Vec3::Map(&force[k]);
    node.force = std::clamp(mass / gain * behind - node.direction.dot(f), 0.0, node.most);
    node.force_sum += node.force;
    f += node.force * node.direction;
  }
}

void sum_drag_reactions(const BladeDrag& drag, std::int64_t n_substeps, std::span<ToolLoad> loads) {
  for (const BladeDrag::Node& node : drag.node) {
    const Vec3 force = -node.force_sum / static_cast<double>(n_substeps) * node.direction;
    add(force, node.arm.cross(force), loads[node.tool]);
  }
}

}  // namespace trocar
