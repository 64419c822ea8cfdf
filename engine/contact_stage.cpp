#include "engine/contact_stage.h"

#include <algorithm>
#include <cmath>

namespace trocar {

namespace {

bool can_touch(const Tool& tool, bool is_open, const Contact& contact) {
  const auto piece = static_cast<std::size_t>(contact.piece);
  if (piece < first_working_piece) return true;
  if (is_open) return piece < tool.open_end;
  return piece >= tool.closed_begin && contact.gap > -tool.caught;
}

bool is_held(const Holds& holds, const Contact& contact) {
  return std::any_of(contact.node.begin(), contact.node.end(), [&](std::int32_t node) {
    const auto hold = std::lower_bound(holds.holds.begin(), holds.holds.end(), node,
                                       [](const Hold& h, std::int32_t n) { return h.node < n; });
    return hold != holds.holds.end() && hold->node == node && hold->tool == contact.tool;
  });
}

// From which the next step's solution begins, of this step: 6 numbers a node.
constexpr std::size_t per_impulse = 6;

std::vector<double> gather_impulses(const ContactSet& set, const Communicator& communicator) {
  std::vector<double> mine;
  for (const std::int32_t place : set.owned) {
    const auto i = static_cast<std::size_t>(place);
    const ContactSet::TissueImpulse& impulse = set.impulse[i];
    if (impulse.step < 0) continue;
    const Vec3& drag = impulse.drag;
    mine.insert(mine.end(), {static_cast<double>(set.node[i]), static_cast<double>(impulse.step),
                             impulse.push, drag.x(), drag.y(), drag.z()});
  }
  return communicator.all_gather(mine);
}

void take_impulses(std::span<const double> impulses, ContactSet& set) {
  for (std::size_t k = 0; k < impulses.size(); k += per_impulse) {
    const auto node = static_cast<std::int32_t>(impulses[k]);
    const auto at = std::ranges::lower_bound(set.node, node);
    if (at == set.node.end() || *at != node) continue;
    set.impulse[at - set.node.begin()] = {.step = static_cast<std::int64_t>(impulses[k + 1]),
                                          .push = impulses[k + 2],
                                          .drag = Vec3::Map(&impulses[k + 3])};
  }
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
  stage.detector.detect_tissue({.ahead = stage.ahead, .extra = reach, .depth = reach},
                               stage.tissue);
}

// What a force on the node alone has to move, 1 / (M^-1)_ii with M of solver/mass_scaling.h, of
// which nothing moves held nodes: with D = m + d, 1/D + (d/D)^2 / (sum_free d m/D + sum_held d).
// With m alone pushes were too weak by m/D, and tissue crept into instruments.
std::vector<double> felt_masses(const ContactBody& body, std::span<const FixedMask> held) {
  std::vector<double> felt(body.mass.begin(), body.mass.end());
  const MassScaling& scaling = *body.scaling;
  for (std::int32_t c = 0; c < scaling.n_clusters(); ++c) {
    const auto begin = static_cast<std::size_t>(scaling.offset[c]),
               end = static_cast<std::size_t>(scaling.offset[static_cast<std::size_t>(c) + 1]);
    double whole = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(scaling.node[k]);
      const double m = body.mass[i], d = scaling.added[k];
      whole += held[i] != 0 ? d : d * m / (m + d);
    }
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(scaling.node[k]);
      const double d = scaling.added[k], D = body.mass[i] + d;
      felt[i] = 1 / (1 / D + d / D * (d / D) / whole);
    }
  }
  return felt;
}

void prepare_frame_contacts(ContactStage& stage, const ContactBody& body, const Holds& holds) {
  stage.set = {};
  if (stage.contacts.empty() && stage.tissue.empty()) return;
  std::vector<FixedMask> held(body.fixed.begin(), body.fixed.end());
  for (const Hold& hold : holds.holds) held[hold.node] = all_components;
  const std::vector<double> scaled =
      body.scaling != nullptr ? felt_masses(body, held) : std::vector<double>();
  stage.set = prepare_contacts({stage.contacts, stage.tissue}, body.node_owner, body.part,
                               body.rank, scaled.empty() ? body.mass : scaled, held);
  stage.u_next.resize(3 * body.part.node_global.size());
  stage.exchange.emplace(stage.set.halo, 6);
  stage.positions.resize(6 * stage.set.node.size());
}

void renew_frame_contacts(ContactStage& stage, const ContactBody& body, const Holds& holds,
                          const Communicator& communicator) {
  const std::vector<ContactSet::Item> before = std::move(stage.set.items);
  const std::vector<double> impulses = gather_impulses(stage.set, communicator);
  prepare_frame_contacts(stage, body, holds);
  // Ranks that had no nodes before know nothing of what tools have felt: they don't report it.
  for (std::size_t k = 0; k < std::min(before.size(), stage.set.items.size()); ++k)
    stage.set.items[k].reaction_sum = before[k].reaction_sum;
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

void sum_contact_reactions(ContactStage& stage, std::int64_t n_substeps,
                           std::span<ExactSum3> force) {
  if (!stage.set.is_counted_here) return;
  for (const ContactSet::Item& item : stage.set.items)
    add(item.reaction_sum / static_cast<double>(n_substeps), force[item.contact.tool]);
}

}  // namespace trocar
