#include "engine/contact_stage.h"

#include <algorithm>
#include <cmath>

#include "base/sort_unique.h"
#include "engine/gather_items.h"

namespace trocar {

namespace {

bool can_touch(const Tool& tool, bool is_open, const Contact& contact) {
  const auto piece = static_cast<std::size_t>(contact.piece);
  if (piece < first_working_piece) return true;
  if (is_open) return piece < tool.open_end;
  return piece >= tool.closed_begin && contact.gap > -tool.caught;
}

bool is_held(const Holds& holds, const Contact& contact) {
  return std::ranges::any_of(contact.node, [&](std::int32_t node) {
    const Hold* const hold = find_hold(holds.holds, node);
    return hold != nullptr && hold->tool == contact.tool;
  });
}

// From which the next step's solution begins, of this step.
struct NodeImpulse {
  std::int32_t node = -1;
  ContactSet::TissueImpulse impulse;
};

template <class Archive>
void visit(Archive& a, NodeImpulse& i) {
  a(i.node, i.impulse.step, i.impulse.push, i.impulse.drag);
}

std::vector<NodeImpulse> gather_impulses(const ContactSet& set, const Communicator& communicator) {
  std::vector<NodeImpulse> mine;
  for (const std::int32_t place : set.owned)
    if (const auto& impulse = set.impulse[place]; impulse.step >= 0)
      mine.push_back({set.node[place], impulse});
  return all_gather_items(communicator, mine);
}

void take_impulses(std::span<const NodeImpulse> impulses, ContactSet& set) {
  for (const NodeImpulse& of_node : impulses)
    if (const std::int32_t at = find_in(set.node, of_node.node); at >= 0)
      set.impulse[at] = of_node.impulse;
}

// (n_clusters) 1 / (sum_free d m/D + sum_held d)
std::vector<Vec3> find_yields(const ContactBody& body, std::span<const FixedMask> held) {
  const MassScaling& scaling = *body.scaling;
  std::vector<Vec3> yields;
  for (std::int32_t c = 0; c < scaling.n_clusters(); ++c) {
    Vec3 whole = Vec3::Zero();
    for (std::int32_t k = scaling.offset[c]; k < scaling.offset[c + 1]; ++k) {
      const std::int32_t i = scaling.node[k];
      const double m = body.mass[i], d = scaling.added[k];
      for (int j = 0; j < 3; ++j) whole[j] += (held[i] >> j & 1) != 0 ? d : d * m / (m + d);
    }
    yields.push_back(whole.cwiseInverse());
  }
  return yields;
}

// Once a frame, if there are contacts.
void find_held(ContactStage& stage, const ContactBody& body, const Holds& holds) {
  stage.held.assign(body.fixed.begin(), body.fixed.end());
  for (const Hold& hold : holds.holds) stage.held[hold.node] = all_components;
  if (body.scaling != nullptr) stage.yield = find_yields(body, stage.held);
}

void prepare_set(ContactStage& stage, const ContactBody& body, const Holds& holds) {
  stage.set = {};
  if (stage.contacts.empty() && stage.tissue.empty()) return;
  if (stage.held.empty()) find_held(stage, body, holds);
  const JoinedMasses& joined = stage.joined;
  stage.set = prepare_contacts({stage.contacts, stage.tissue}, body.node_owner, body.part,
                               {.mass = body.scaling != nullptr ? joined.mass : body.mass,
                                .held = stage.held,
                                .cluster = joined.cluster,
                                .share = joined.share,
                                .yield = stage.yield});
  stage.u_next.resize(3 * body.part.node_global.size());
  stage.exchange.emplace(stage.set.halo, 6);
  stage.positions.resize(6 * stage.set.node.size());
}

}  // namespace

void detect_contacts(ContactStage& stage, std::span<const Tool> tools, const Holds& holds,
                     const SurfaceView& view, const FrameSpan& span, double reach_extra) {
  std::vector<Pose> poses;
  std::vector<double> margins;
  for (const Tool& tool : tools) {
    poses.push_back(tool.path.at(span.t0));
    margins.push_back(tool.path.travel(span.t0, span.t1, tool.box) + reach_extra);
  }
  stage.detector.detect(view.x, poses, margins, stage.contacts);
  std::erase_if(stage.contacts, [&](const Contact& contact) {
    const auto tool = static_cast<std::size_t>(contact.tool);
    const bool is_open = holds.is_open[tool] != 0;
    return !can_touch(tools[tool], is_open, contact) || (!is_open && is_held(holds, contact));
  });
}

void detect_tissue(ContactStage& stage, const SurfaceView& view, double time, double reach) {
  stage.ahead.resize(view.x.size());
  for (const std::int32_t node : view.node) {
    const auto i = static_cast<std::size_t>(node);
    stage.ahead[i] = view.x[i] + time * view.v[i];
  }
  stage.detector.detect_tissue(stage.ahead, reach, stage.tissue);
}

void join_masses(ContactStage& stage, const ContactBody& body) {
  if (body.scaling == nullptr) return;
  const MassScaling& scaling = *body.scaling;
  JoinedMasses& joined = stage.joined;
  joined.mass.assign(body.mass.begin(), body.mass.end());
  joined.share.assign(body.mass.size(), 0.0);
  joined.cluster.assign(body.mass.size(), -1);
  for (std::int32_t c = 0; c < scaling.n_clusters(); ++c)
    for (std::int32_t k = scaling.offset[c]; k < scaling.offset[c + 1]; ++k) {
      const std::int32_t i = scaling.node[k];
      const double m = body.mass[i], d = scaling.added[k];
      joined.mass[i] = m + d;
      joined.share[i] = d / (m + d);
      joined.cluster[i] = c;
    }
}

void prepare_frame_contacts(ContactStage& stage, const ContactBody& body, const Holds& holds) {
  stage.held.clear();
  prepare_set(stage, body, holds);
}

void renew_frame_contacts(ContactStage& stage, const ContactBody& body, const Holds& holds,
                          const Communicator& communicator) {
  const std::vector<ContactSet::Item> before = std::move(stage.set.items);
  const std::vector<NodeImpulse> impulses = gather_impulses(stage.set, communicator);
  prepare_set(stage, body, holds);
  // Ranks that had no nodes before know nothing of what tools have felt: they don't report it.
  for (std::size_t k = 0; k < std::min(before.size(), stage.set.items.size()); ++k) {
    stage.set.items[k].reaction_sum = before[k].reaction_sum;
    stage.set.items[k].torque_sum = before[k].torque_sum;
  }
  take_impulses(impulses, stage.set);
}

void share_positions(ContactStage& stage, std::span<const Vec3> X, std::span<const double> u,
                     Communicator& communicator) {
  for (std::size_t k = 0; k < stage.set.local.size(); ++k) {
    const auto from = 3 * static_cast<std::size_t>(stage.set.local[k]);
    const auto to = 6 * static_cast<std::size_t>(stage.set.owned[k]);
    Vec3::Map(&stage.positions[to]) = Vec3::Map(&u[from]);
    Vec3::Map(&stage.positions[to + 3]) = Vec3::Map(&stage.u_next[from]);
  }
  stage.exchange->exchange(stage.positions, communicator);
  for (std::size_t k = 0; k < stage.set.node.size(); ++k) {
    const Vec3& x = X[stage.set.node[k]];
    stage.set.x_start[k] = x + Vec3::Map(&stage.positions[6 * k]);
    stage.set.x_end[k] = x + Vec3::Map(&stage.positions[6 * k + 3]);
  }
}

void add_contact_force(const ContactStage& stage, std::span<double> force) {
  for (std::size_t k = 0; k < stage.set.local.size(); ++k)
    Vec3::Map(&force[3 * static_cast<std::size_t>(stage.set.local[k])]) +=
        stage.set.force[stage.set.owned[k]];
}

void move_tools(std::span<const Tool> tools, double t, double dt, std::span<ToolMotion> motion) {
  for (std::size_t k = 0; k < tools.size(); ++k) {
    const Pose now = tools[k].path.at(t), before = tools[k].path.at(t - dt);
    motion[k].pose = now;
    motion[k].velocity = (now.translation - before.translation) / dt;
    const Quat turn = now.rotation * before.rotation.conjugate();
    motion[k].angular_velocity = (turn.w() < 0 ? -2.0 : 2.0) * turn.vec() / dt;
  }
}

void sum_contact_reactions(const ContactStage& stage, std::int64_t n_substeps,
                           std::span<ToolLoad> loads) {
  if (!stage.set.is_counted_here) return;
  const auto n = static_cast<double>(n_substeps);
  for (const ContactSet::Item& item : stage.set.items)
    add(item.reaction_sum / n, item.torque_sum / n, loads[item.contact.tool]);
}

}  // namespace trocar
