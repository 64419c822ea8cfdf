#include "engine/support_forces.h"

#include <algorithm>

namespace trocar {

std::vector<int> axes_of(const std::string& fix) {
  std::vector<int> axes;
  for (const char letter : fix) axes.push_back(letter - 'x');
  return axes;
}

std::vector<std::int32_t> holders_at_rest(std::span<const SceneSupport> supports,
                                          const Mesh& mesh) {
  std::vector<std::int32_t> holder(3 * mesh.X.size(), -1);
  for (std::size_t k = 0; k < supports.size(); ++k) {
    if (!supports[k].path.empty()) continue;
    const std::vector<int> axes = axes_of(supports[k].fix);
    for (const std::int32_t node : find_node_set(mesh, supports[k].region)->node)
      for (const int axis : axes)
        if (std::int32_t& at = holder[3 * std::int64_t{node} + axis]; at < 0)
          at = static_cast<std::int32_t>(k);
  }
  return holder;
}

void localise_supports(std::span<const SceneSupport> supports, const Mesh& mesh, const Part& part,
                       SupportForces& forces) {
  forces.of_rank.clear();
  const std::vector<std::int32_t> holder = holders_at_rest(supports, mesh);
  for (std::int64_t c = 0; c < 3 * std::int64_t{part.n_owned}; ++c)
    if (const std::int32_t k = holder[3 * std::int64_t{part.node_global[c / 3]} + c % 3]; k >= 0)
      forces.of_rank.push_back({.support = k, .component = c});
  forces.sum.assign(forces.of_rank.size(), 0.0);
}

void forget_support_forces(SupportForces& forces) {
  std::fill(forces.sum.begin(), forces.sum.end(), 0.0);
}

void add_support_forces(std::span<const double> force, SupportForces& forces) {
  for (std::size_t k = 0; k < forces.sum.size(); ++k)
    forces.sum[k] += force[forces.of_rank[k].component];
}

void sum_support_forces(const SupportForces& forces, std::int64_t n_substeps,
                        std::span<ExactSum3> force) {
  for (std::size_t k = 0; k < forces.sum.size(); ++k) {
    const SupportedComponent& at = forces.of_rank[k];
    force[at.support][at.component % 3].add(forces.sum[k] / static_cast<double>(n_substeps));
  }
}

std::vector<std::string> support_names(std::span<const SceneSupport> supports) {
  std::vector<std::string> names;
  const auto is_taken = [&](const std::string& name, std::size_t own) {
    const auto is_region = [&](const SceneSupport& other) { return other.region == name; };
    return std::ranges::count(names, name) > 0 ||
           (name != supports[own].region && std::ranges::any_of(supports, is_region));
  };
  for (std::size_t k = 0; k < supports.size(); ++k) {
    std::string name = supports[k].region;
    for (int n = 2; is_taken(name, k); ++n) name = supports[k].region + "_" + std::to_string(n);
    names.push_back(name);
  }
  return names;
}

}  // namespace trocar
