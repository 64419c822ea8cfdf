#include "engine/holds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cutting/cut_constraints.h"

namespace trocar {

namespace {

bool acts_within(const InstrumentKey& key, double t0, double t1) {
  return key.action != GraspAction::none && key.time > t0 && key.time <= t1;
}

GraspAct take_hold(Holds& holds, const Tool& tool, std::int32_t number, const BodyToGrasp& body) {
  const std::vector<std::uint8_t> is_immovable = immovable_nodes(holds, body.fixed);
  const Pose pose = tool.path.at(body.time);
  GraspAct act{.tool = number, .has_closed = true};
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < body.x.size(); ++i) {
    if (is_immovable[i] != 0) continue;
    const Vec3 offset = pose.apply_inverse(body.x[i]);
    nearest = std::min(nearest, offset.squaredNorm());
    if (offset.squaredNorm() > tool.grip_radius * tool.grip_radius) continue;
    holds.holds.push_back({.node = static_cast<std::int32_t>(i), .tool = number, .offset = offset});
    ++act.n_taken;
  }
  act.nearest = std::sqrt(nearest);
  std::sort(holds.holds.begin(), holds.holds.end(),
            [](const Hold& a, const Hold& b) { return a.node < b.node; });
  return act;
}

// A plane body is fixed across its plane everywhere: that holds nothing.
FixedMask holding_components(std::span<const FixedMask> fixed) {
  unsigned everywhere = all_components;
  for (const FixedMask mask : fixed) everywhere &= mask;
  return everywhere == all_components ? all_components : all_components & ~everywhere;
}

// What is between two nodes that one holder has is its, too.
bool have_one_holder(const Hold* a, const Hold* b) {
  return a != nullptr && b != nullptr && a->tool == b->tool && a->support == b->support;
}

bool is_immovable_between(const Holds& holds, std::span<const std::uint8_t> fixed,
                          const EdgeNode& node) {
  const auto [a, b] = node.end;
  return (fixed[a] & fixed[b]) == all_components ||
         have_one_holder(find_hold(holds.holds, a), find_hold(holds.holds, b));
}

}  // namespace

std::vector<std::uint8_t> held_nodes(const Holds& holds, std::span<const std::uint8_t> fixed) {
  std::vector<std::uint8_t> is_held(fixed.size());
  const FixedMask holding = holding_components(fixed);
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if ((fixed[i] & holding) != 0) is_held[i] = fixed[i] == all_components ? 1 : may_slide;
  for (const Hold& hold : holds.holds) is_held[hold.node] = 1;
  return is_held;
}

std::vector<std::uint8_t> immovable_nodes(const Holds& holds, std::span<const std::uint8_t> fixed) {
  std::vector<std::uint8_t> is_immovable(fixed.size());
  for (std::size_t i = 0; i < fixed.size(); ++i) is_immovable[i] = fixed[i] == all_components;
  for (const Hold& hold : holds.holds) is_immovable[hold.node] = 1;
  return is_immovable;
}

bool is_immovable(const Holds& holds, std::span<const std::uint8_t> fixed, std::int32_t node,
                  const MeshEdit& edit) {
  const std::int64_t n = std::ssize(fixed), n_inserted = std::ssize(edit.inserted);
  const auto parent = [&] { return edit.duplicate_parent[node - n - n_inserted]; };
  while (node >= n + n_inserted) node = parent();
  if (node >= n) return is_immovable_between(holds, fixed, edit.inserted[node - n]);
  return fixed[node] == all_components || find_hold(holds.holds, node) != nullptr;
}

int release(Holds& holds, std::int32_t tool) {
  return static_cast<int>(
      std::erase_if(holds.holds, [&](const Hold& hold) { return hold.tool == tool; }));
}

std::vector<DueAct> due_acts(std::span<const Tool> tools, double t0, double t1) {
  std::vector<DueAct> due;
  for (std::size_t k = 0; k < tools.size(); ++k)
    for (const InstrumentKey& key : tools[k].keys)
      if (acts_within(key, t0, t1)) due.push_back({&key, static_cast<std::int32_t>(k)});
  std::ranges::stable_sort(due, {}, [](const DueAct& act) {
    return std::pair(act.key->time, act.key->action == GraspAction::close);
  });
  return due;
}

bool does_grasper_close(std::span<const DueAct> due, std::span<const Tool> tools) {
  return std::ranges::any_of(due, [&](const DueAct& act) {
    return act.key->action == GraspAction::close && tools[act.tool].kind == InstrumentKind::grasper;
  });
}

double grip_travel(const Tool& tool, double t0, double t1) {
  const Vec3 grip = Vec3::Constant(tool.grip_radius);
  return tool.path.travel(t0, t1, {-grip, grip});
}

double largest_travel(const Holds& holds, std::span<const Tool> tools, double t0, double t1) {
  double most = 0;
  for (const DisplacementPath& path : holds.paths) most = std::max(most, path.travel(t0, t1));
  for (std::size_t k = 0; k < tools.size(); ++k) {
    const auto is_its = [&](const Hold& hold) { return hold.tool == static_cast<int>(k); };
    if (std::ranges::none_of(holds.holds, is_its)) continue;
    most = std::max(most, grip_travel(tools[k], t0, t1));
  }
  return most;
}

std::vector<GraspAct> act_graspers(Holds& holds, std::span<const Tool> tools,
                                   std::span<const DueAct> due, const BodyToGrasp& body) {
  std::vector<GraspAct> acts;
  for (const auto& [key, number] : due) {
    const Tool& tool = tools[number];
    holds.is_open[number] = key->action == GraspAction::open;
    if (tool.kind != InstrumentKind::grasper) continue;
    release(holds, number);
    acts.push_back(key->action == GraspAction::close ? take_hold(holds, tool, number, body)
                                                     : GraspAct{.tool = number});
  }
  return acts;
}

void localise_holds(Holds& holds, const Part& part) {
  holds.owned.clear();
  holds.prescribed.clear();
  for (std::size_t k = 0; k < holds.holds.size(); ++k) {
    const std::int32_t local = part.owned(holds.holds[k].node);
    if (local < 0) continue;
    holds.owned.push_back(static_cast<std::int32_t>(k));
    holds.prescribed.push_back({.node = local});
  }
  holds.reaction_sum.assign(holds.owned.size(), Vec3::Zero());
}

const Hold* find_hold(std::span<const Hold> holds, std::int32_t node) {
  const auto at = std::ranges::lower_bound(holds, node, {}, &Hold::node);
  return at != holds.end() && at->node == node ? &*at : nullptr;
}

static void insert_holds(std::span<const EdgeNode> inserted, std::int32_t n_nodes_before,
                         std::vector<Hold>& holds) {
  for (std::size_t k = 0; k < inserted.size(); ++k) {
    const EdgeNode& node = inserted[k];
    const Hold *const a = find_hold(holds, node.end[0]), *const b = find_hold(holds, node.end[1]);
    if (!have_one_holder(a, b)) continue;
    Hold between = *a;
    between.node = n_nodes_before + static_cast<std::int32_t>(k);
    between.offset += node.s * (b->offset - a->offset);
    holds.push_back(between);
  }
}

void apply_edit_to_holds(const MeshEdit& edit, std::int32_t n_nodes_before, Holds& holds) {
  // In the order of the new numbers, so that the list stays ascending.
  insert_holds(edit.inserted, n_nodes_before, holds.holds);
  const auto first = n_nodes_before + static_cast<std::int32_t>(edit.inserted.size());
  for (std::size_t d = 0; d < edit.duplicate_parent.size(); ++d) {
    const std::int32_t parent = edit.duplicate_parent[d];
    const Hold* const hold = find_hold(holds.holds, parent);
    if (hold == nullptr) continue;
    Hold partner = *hold;
    partner.node = first + static_cast<std::int32_t>(d);
    holds.holds.push_back(partner);
  }
}

void aim_holds(Holds& holds, std::span<const Tool> tools, std::span<const Vec3> X, double time) {
  if (holds.owned.empty()) return;
  for (std::size_t k = 0; k < tools.size(); ++k) holds.poses[k] = tools[k].path.at(time);
  for (std::size_t k = 0; k < holds.owned.size(); ++k) {
    const Hold& hold = holds.holds[holds.owned[k]];
    holds.prescribed[k].u_next =
        hold.tool >= 0 ? Vec3(holds.poses[hold.tool].apply(hold.offset) - X[hold.node])
                       : holds.paths[hold.support].at(time);
  }
}

void add_hold_reactions(Holds& holds) {
  for (std::size_t k = 0; k < holds.owned.size(); ++k)
    holds.reaction_sum[k] += holds.prescribed[k].reaction;
}

void forget_hold_reactions(Holds& holds) {
  std::fill(holds.reaction_sum.begin(), holds.reaction_sum.end(), Vec3::Zero());
}

void sum_hold_reactions(Holds& holds, std::int64_t n_substeps, std::span<ToolLoad> on_tool,
                        std::span<ExactSum3> on_support) {
  for (std::size_t k = 0; k < holds.owned.size(); ++k) {
    const Hold& hold = holds.holds[holds.owned[k]];
    const Vec3 mean = holds.reaction_sum[k] / static_cast<double>(n_substeps);
    holds.reaction_sum[k] = Vec3::Zero();
    // The tissue pulls back on what holds it.
    if (hold.tool >= 0) {
      ToolLoad& load = on_tool[hold.tool];
      add(-mean, mean.cross(holds.poses[hold.tool].rotation * hold.offset), load);
      add(-mean, load.pull);
    } else {
      add(-mean, on_support[hold.support]);
    }
  }
}

}  // namespace trocar
