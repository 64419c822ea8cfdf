#include "engine/contact_stage.h"

#include <algorithm>
#include <cmath>

namespace trocar {

namespace {

constexpr double blade_side =
    0.9;  // least |cosine| between a contact's normal and the blade's flat side
constexpr double blade_depth = 0.3e-3;  // tissue deeper in the blade than this is not cut yet [m]

// A blade touches with its flat sides; its edge and tip cut, and tissue that they have not reached
// passes through it.
bool is_blade_edge(const Tool& tool, const Contact& contact) {
  return tool.kind == InstrumentKind::scalpel && contact.piece >= first_working_piece &&
         (std::abs(contact.normal.y()) < blade_side || contact.gap < -blade_depth);
}

bool is_inside_jaws(const Contact& contact, const Holds& holds) {
  const bool is_closed = !holds.is_open[static_cast<std::size_t>(contact.tool)];
  if (!is_closed) return false;
  if (contact.piece >= first_working_piece) return true;
  return std::any_of(contact.node.begin(), contact.node.end(), [&](std::int32_t node) {
    const auto hold = std::lower_bound(holds.holds.begin(), holds.holds.end(), node,
                                       [](const Hold& h, std::int32_t n) { return h.node < n; });
    return hold != holds.holds.end() && hold->node == node && hold->tool == contact.tool;
  });
}

}  // namespace

void detect_contacts(ContactStage& stage, std::span<const Tool> tools, const Holds& holds,
                     const SurfaceView& view, const FrameSpan& span, double reach_extra) {
  std::vector<Pose> poses;
  std::vector<double> margins;
  for (const Tool& tool : tools) {
    poses.push_back(tool.path.at(span.t0));
    margins.push_back(tool.path.travel(span.t0, span.t1, 0.02) + reach_extra);
  }
  stage.detector.detect(view.x, poses, margins, stage.contacts);
  std::erase_if(stage.contacts, [&](const Contact& contact) {
    return is_blade_edge(tools[static_cast<std::size_t>(contact.tool)], contact) ||
           is_inside_jaws(contact, holds);
  });
}

void prepare_frame_contacts(ContactStage& stage, const Part& part, std::span<const double> mass,
                            double dt) {
  stage.set = prepare_contacts(stage.contacts, part, mass, dt, stage.options);
  stage.reaction.assign(stage.set.items.size(), Vec3::Zero());
  stage.reaction_sum.assign(stage.set.items.size(), Vec3::Zero());
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

void add_contact_reactions(ContactStage& stage) {
  for (std::size_t k = 0; k < stage.reaction.size(); ++k)
    stage.reaction_sum[k] += stage.reaction[k];
}

void sum_contact_reactions(ContactStage& stage, std::int64_t n_substeps,
                           std::span<std::array<ExactSum, 3>> force) {
  for (std::size_t k = 0; k < stage.set.items.size(); ++k) {
    const Vec3 mean = stage.reaction_sum[k] / static_cast<double>(n_substeps);
    const auto tool = static_cast<std::size_t>(stage.set.items[k].contact.tool);
    for (std::size_t i = 0; i < 3; ++i) force[tool][i].add(mean[static_cast<Eigen::Index>(i)]);
  }
}

}  // namespace trocar
