#include "engine/local_steps.h"

#include <algorithm>
#include <utility>

#include "engine/event_log.h"
#include "engine/simulation.h"

namespace trocar {

namespace {

std::unique_ptr<MultiRate> make_body(const Simulation& s) {
  const MultiRatePlan& plan = s.local_steps->plan;
  if (plan.n_substeps == 1) return nullptr;
  return make_multirate(plan,
                        {.mesh = s.mesh,
                         .materials = s.materials,
                         .node_owner = s.node_owner,
                         .part = s.part,
                         .model = s.model},
                        *s.communicator);
}

// Nodes that an edit made are among `nodes`.
bool is_same_elsewhere(const MultiRatePlan& before, const MultiRatePlan& after,
                       std::span<const std::int32_t> nodes) {
  if (before.n_substeps != after.n_substeps) return false;
  for (std::size_t i = 0; i < before.is_fine.size(); ++i)
    if (before.is_fine[i] != after.is_fine[i] &&
        !std::binary_search(nodes.begin(), nodes.end(), static_cast<std::int32_t>(i)))
      return false;
  return true;
}

}  // namespace

void plan_local_steps(Simulation& s) {
  if (!s.scene.solver.is_multirate) return;
  LocalStepPlan& local = s.local_steps.emplace();
  local.resting = resting_elements(s.mesh, s.materials, s.model.options);
  local.plan = plan_multirate(s.mesh, s.corners.first.empty() ? node_corners(s.mesh) : s.corners,
                              local.resting);
  s.multirate = make_body(s);
}

bool follow_local_steps(std::span<const std::int32_t> elements, std::span<const std::int32_t> nodes,
                        Simulation& s) {
  if (!s.local_steps) return true;
  LocalStepPlan& local = *s.local_steps;
  edit_resting_elements(s.mesh, s.materials, s.model.options, elements, local.resting);
  MultiRatePlan plan = plan_multirate(s.mesh, s.corners, local.resting);
  const bool stays = is_same_elsewhere(local.plan, plan, nodes);
  local.plan = std::move(plan);
  const LocalStepVerdict before = local_step_verdict(s);
  const bool is_given_up = stays && before == LocalStepVerdict::given_up;
  s.multirate = is_given_up ? nullptr : make_body(s);
  if (stays) take_verdict(before, s);
  return stays;
}

bool keep_local_steps(const MultiRatePlan& before, LocalStepVerdict verdict,
                      std::span<const std::int32_t> nodes, Simulation& s) {
  const bool stays = is_same_elsewhere(before, s.local_steps->plan, nodes);
  if (stays) take_verdict(verdict, s);
  return stays;
}

LocalStepVerdict local_step_verdict(const Simulation& s) {
  if (!s.multirate) return LocalStepVerdict::given_up;
  return s.multirate->is_judged ? LocalStepVerdict::kept : LocalStepVerdict::none;
}

void take_verdict(LocalStepVerdict verdict, Simulation& s) {
  if (verdict == LocalStepVerdict::given_up) s.multirate.reset();
  if (s.multirate) s.multirate->is_judged = verdict == LocalStepVerdict::kept;
}

static bool touches_small_elements(const Simulation& s) {
  if (!s.contact) return false;
  const auto is_fine = [&](std::int32_t node) { return s.local_steps->plan.is_fine[node] != 0; };
  const auto touches = [&](const Contact& c) { return std::ranges::any_of(c.node, is_fine); };
  const auto meets = [&](const TissuePair& pair) {
    return is_fine(pair.node) || std::ranges::any_of(pair.corner, is_fine);
  };
  return std::ranges::any_of(s.contact->contacts, touches) ||
         std::ranges::any_of(s.contact->tissue, meets);
}

static bool drags_tissue(const Simulation& s) {
  const auto drags = [](const CutStage& stage) {
    return stage.is_engaged || !stage.resisted.empty();
  };
  return s.scene.cutting.resistance > 0 && std::ranges::any_of(s.cuts, drags);
}

void choose_local_steps(Simulation& s, double t) {
  s.has_local_steps = s.multirate && !touches_small_elements(s) && !drags_tissue(s);
  if (!s.multirate || s.has_local_steps) return;
  if (std::exchange(s.log.told.no_local_steps, true)) return;
  note_event(s, t,
             "small elements take no local steps (solver.multirate) while they are touched or cut: "
             "all elements take theirs meanwhile");
}

double step_share(const Simulation& s) {
  return s.has_local_steps ? 1 : s.look.of_small;
}

}  // namespace trocar
