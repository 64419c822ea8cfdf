#include "engine/added_mass.h"

#include <algorithm>

#include "base/log.h"
#include "base/number_text.h"
#include "engine/event_log.h"
#include "engine/point_text.h"
#include "engine/simulation.h"

namespace trocar {

namespace {

constexpr double share_of_event = 0.05;

AddedMass measure(const MassScaling& scaling, const Simulation& s) {
  AddedMass added{.n_elements = static_cast<std::int32_t>(scaling.element.size()),
                  .n_nodes = static_cast<std::int32_t>(scaling.node.size()),
                  .n_clusters = scaling.n_clusters()};
  if (scaling.node.empty()) return added;
  added.mass = exact_sum(scaling.added);
  added.share = added.mass / s.whole_mass;
  for (std::int32_t c = 0; c < scaling.n_clusters(); ++c)
    added.largest_cluster = std::max(
        added.largest_cluster, scaling.offset[static_cast<std::size_t>(c) + 1] - scaling.offset[c]);
  const auto most = std::max_element(scaling.added.begin(), scaling.added.end());
  added.heaviest_node = scaling.node[most - scaling.added.begin()];
  added.box = {};
  for (const std::int32_t node : scaling.node) added.box.add(s.mesh.X[node]);
  return added;
}

std::string sentence(const AddedMass& added, const Simulation& s) {
  return "mass scaling adds " + short_text(added.mass) + " kg, " + short_text(100 * added.share) +
         " % of the body, to " + std::to_string(added.n_nodes) + " nodes of " +
         std::to_string(added.n_elements) + " elements in " + std::to_string(added.n_clusters) +
         " clusters, most at node " + std::to_string(added.heaviest_node) + " at " +
         point_text(s.mesh.X[added.heaviest_node]) + " m";
}

}  // namespace

void plan_mass_scaling(Simulation& s) {
  const SceneSolver& solver = s.scene.solver;
  if (solver.mass_scaling_step == 0) return;
  s.mass_scaling =
      find_mass_scaling(s.mesh, s.materials, solver_options(s.scene), solver.mass_scaling_step);
  keep_clusters_whole(*s.mass_scaling, s.node_owner);
}

bool follow_mass_scaling(std::span<const std::int32_t> edited, Simulation& s) {
  if (!s.mass_scaling) return true;
  edit_mass_scaling(s.mesh, s.materials, s.model.options, edited, *s.mass_scaling);
  return are_clusters_whole(*s.mass_scaling, s.node_owner);
}

void report_mass_scaling(Simulation& s) {
  if (!s.mass_scaling) return;
  const bool is_first = !s.added_mass;
  const double before = is_first ? 0 : s.added_mass->share;
  s.added_mass = measure(*s.mass_scaling, s);
  if (s.added_mass->share > share_of_event && before <= share_of_event)
    note_event(s, s.state.time, sentence(*s.added_mass, s) + ": its motion is slowed visibly");
  else if (is_first)
    log_info(s.added_mass->n_nodes > 0
                 ? sentence(*s.added_mass, s)
                 : "mass scaling adds nothing: no element's step is below the wanted one");
}

}  // namespace trocar
