#include "engine/support_check.h"

#include <algorithm>
#include <string>
#include <vector>

#include "base/log.h"
#include "engine/support_forces.h"

namespace trocar {

namespace {

constexpr std::int32_t nobody = -1;

// By number of the support in the scene.
struct Holders {
  std::vector<std::int32_t> at_rest;  // (n_nodes * 3)
  std::vector<std::int32_t> moving;   // (n_nodes)
};

// What of a support's nodes others have.
struct Overlap {
  std::size_t n_nodes_against = 0;  // that others move otherwise
  std::int32_t against = nobody;    // one of these others
  std::int32_t same = nobody;       // one that holds a component alike
  bool has_own = false;             // a component that is its own
};

std::string name_of(std::int32_t support) {
  return item_path("support", static_cast<std::size_t>(support));
}

bool rests_along(const SceneSupport& support, int axis) {
  return std::all_of(support.path.begin(), support.path.end(),
                     [&](const SupportKey& key) { return key.displacement[axis] == 0; });
}

bool move_alike(const SceneSupport& a, const SceneSupport& b, int axis) {
  if (rests_along(a, axis) || rests_along(b, axis))
    return rests_along(a, axis) && rests_along(b, axis);
  return std::equal(a.path.begin(), a.path.end(), b.path.begin(), b.path.end(),
                    [&](const SupportKey& p, const SupportKey& q) {
                      return p.time == q.time && p.displacement[axis] == q.displacement[axis];
                    });
}

Holders find_holders(const Scene& scene, const Mesh& mesh) {
  Holders holders{.at_rest = holders_at_rest(scene.supports, mesh),
                  .moving = std::vector<std::int32_t>(mesh.X.size(), nobody)};
  for (std::size_t k = 0; k < scene.supports.size(); ++k) {
    if (scene.supports[k].path.empty()) continue;
    for (const std::int32_t node : find_node_set(mesh, scene.supports[k].region)->node)
      if (holders.moving[node] == nobody) holders.moving[node] = static_cast<std::int32_t>(k);
  }
  return holders;
}

Overlap find_overlap(const Scene& scene, std::int32_t number, const NodeSet& region,
                     const Holders& holders) {
  const SceneSupport& support = scene.supports[number];
  const std::vector<int> axes = axes_of(support.fix);
  Overlap overlap;
  for (const std::int32_t node : region.node) {
    const auto i = static_cast<std::size_t>(node);
    bool is_against = false;
    for (const int axis : axes) {
      const std::int32_t at_rest = holders.at_rest[3 * i + static_cast<std::size_t>(axis)];
      const std::int32_t holder = at_rest != nobody ? at_rest : holders.moving[i];
      if (holder == number) {
        overlap.has_own = true;
      } else if (move_alike(support, scene.supports[holder], axis)) {
        overlap.same = holder;
      } else {
        is_against = true;
        overlap.against = holder;
      }
    }
    overlap.n_nodes_against += is_against ? 1 : 0;
  }
  return overlap;
}

void tell_overlap(std::int32_t number, const NodeSet& region, const Overlap& overlap,
                  OptionErrors& errors) {
  const std::string who = name_of(number), n_nodes = std::to_string(region.node.size());
  if (region.node.empty()) return;
  if (overlap.n_nodes_against == region.node.size())
    errors.add(who + ".region", "all its " + n_nodes + " nodes (region \"" + region.name +
                                    "\") are held by " + name_of(overlap.against) +
                                    ", which moves them otherwise: leave out one of the two, or "
                                    "give them regions or components (fix) of their own");
  else if (overlap.n_nodes_against > 0)
    log_warning(who + ": " + name_of(overlap.against) + " holds " +
                std::to_string(overlap.n_nodes_against) + " of its " + n_nodes +
                " nodes otherwise, and keeps them in the components that both name");
  else if (!overlap.has_own)
    log_warning(who + " adds nothing: its nodes (region \"" + region.name +
                "\") are held in the same way without it, by " + name_of(overlap.same));
}

}  // namespace

void check_supports(const Scene& scene, const Mesh& mesh, OptionErrors& errors) {
  if (scene.supports.size() < 2) return;
  const Holders holders = find_holders(scene, mesh);
  for (std::int32_t k = 0; k < static_cast<std::int32_t>(scene.supports.size()); ++k) {
    const NodeSet& region = *find_node_set(mesh, scene.supports[k].region);
    tell_overlap(k, region, find_overlap(scene, k, region, holders), errors);
  }
}

}  // namespace trocar
