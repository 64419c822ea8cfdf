#include "collision/contact_solve.h"

#include <algorithm>
#include <array>
#include <vector>

namespace trocar {

namespace {

constexpr std::int64_t hull_steps = 8;    // from look to look
constexpr double hull_closing_speed = 2;  // that a look reckons with until the next one [m/s]
constexpr int most_rounds = 30;
constexpr double furthest = 4;        // that a contact moves a node, in what it lacks
constexpr double good_enough = 1e-3;  // change in a round / deepest point at the start

std::array<Vec3, 3> corners_of(const ContactSet& set, const ContactSet::Item& item) {
  return {set.x_end[to_size(item.place[0])], set.x_end[to_size(item.place[1])],
          set.x_end[to_size(item.place[2])]};
}

const ToolMotion& tool_of(const ContactStep& step, const ContactSet::Item& item) {
  return step.tools[to_size(item.contact.tool)];
}

// arm: from the tool's origin to its point y.
void set_approach(const ContactSet& set, const ContactStep& step, double release_speed, double gap,
                  const Vec3& arm, const ToolMotion& tool, ContactConstraint& c) {
  Vec3 relative = -step.dt * (tool.velocity + tool.angular_velocity.cross(arm));
  double inverse = 0, lightest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t i = to_size(c.place[a]);
    relative += c.weight[a] * (set.x_end[i] - set.x_start[i]);
    inverse += c.weight[a] * c.weight[a] * set.inverse_mass[i];
    lightest = std::max(lightest, c.weight[a] * set.inverse_mass[i]);
  }
  const double closing = c.normal.dot(relative), before = gap - closing;
  const double least = before < 0 ? std::min(0.0, before + release_speed * step.dt) : 0.0;
  c.lack = least - gap;
  c.slip = relative - closing * c.normal;
  c.felt_mass = inverse > 0 ? 1 / inverse : 0;
  c.most_push = inverse > 0 ? furthest * c.lack / lightest : 0;
}

void add_triangle(const ContactStep& step, const ContactOptions& options, std::int32_t k,
                  ContactSet& set) {
  const ContactSet::Item& item = set.items[to_size(k)];
  const ToolMotion& tool = tool_of(step, item);
  ContactConstraint c{.item = k,
                      .place = item.place,
                      .weight = item.contact.weight,
                      .normal = tool.pose.rotation * item.contact.normal};
  const Vec3 arm = tool.pose.rotation * item.contact.point;
  Vec3 x = Vec3::Zero();
  for (std::size_t a = 0; a < 3; ++a) x += c.weight[a] * set.x_end[to_size(c.place[a])];
  const double gap = c.normal.dot(x - (arm + tool.pose.translation));
  set_approach(set, step, options.release_speed, gap, arm, tool, c);
  if (c.lack > 0 && c.felt_mass > 0) set.constraints.push_back(c);
}

void find_deepest(const ContactDetector& detector, const ContactStep& step, ContactSet& set) {
  std::fill(set.deepest.begin(), set.deepest.end(), DeepestPiece{});
  for (std::size_t k = 0; k < set.items.size(); ++k) {
    const ContactSet::Item& item = set.items[k];
    const std::array<Vec3, 3> x = corners_of(set, item);
    const Vec3 facet = (x[1] - x[0]).cross(x[2] - x[0]);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto found = detector.touch_node(item.contact, x[a], tool_of(step, item).pose);
      DeepestPiece& of_node = set.deepest[to_size(item.place[a])];
      if (found && found->gap < of_node.touch.gap && found->normal.dot(facet) < 0)
        of_node = {.item = static_cast<std::int32_t>(k), .touch = *found};
    }
  }
}

void add_nodes(const ContactDetector& detector, const ContactStep& step,
               const ContactOptions& options, ContactSet& set) {
  find_deepest(detector, step, set);
  for (std::size_t i = 0; i < set.deepest.size(); ++i) {
    if (set.deepest[i].item < 0) continue;
    const ToolMotion& tool = tool_of(step, set.items[to_size(set.deepest[i].item)]);
    const NodeTouch& touch = set.deepest[i].touch;
    const auto place = static_cast<std::int32_t>(i);
    ContactConstraint c{.item = set.deepest[i].item,
                        .place = {place, place, place},
                        .weight = {1, 0, 0},
                        .normal = touch.normal};
    const Vec3 arm = set.x_end[i] - touch.gap * touch.normal - tool.pose.translation;
    set_approach(set, step, options.release_speed, touch.gap, arm, tool, c);
    if (c.lack > 0 && c.felt_mass > 0) set.constraints.push_back(c);
  }
}

Vec3 extra(const ContactConstraint& c, std::span<const Vec3> move) {
  return c.weight[0] * move[to_size(c.place[0])] + c.weight[1] * move[to_size(c.place[1])] +
         c.weight[2] * move[to_size(c.place[2])];
}

void apply(const ContactConstraint& c, const Vec3& impulse, ContactSet& set) {
  for (std::size_t a = 0; a < 3; ++a)
    set.move[to_size(c.place[a])] += c.weight[a] * set.inverse_mass[to_size(c.place[a])] * impulse;
}

// Returns by how much the contact point went.
double project(double friction, ContactConstraint& c, ContactSet& set) {
  const Vec3 before = extra(c, set.move);
  const double push =
      std::clamp(c.push + c.felt_mass * (c.lack - c.normal.dot(before)), 0.0, c.most_push);
  apply(c, (push - c.push) * c.normal, set);
  c.push = push;
  const Vec3 now = extra(c, set.move), along = now - c.normal.dot(now) * c.normal;
  Vec3 drag = c.drag - c.felt_mass * (c.slip + along);
  const double size = drag.norm(), most = friction * push;
  if (size > most) drag *= most / size;
  apply(c, drag - c.drag, set);
  c.drag = drag;
  return (extra(c, set.move) - before).norm();
}

}  // namespace

void look_again(const ContactDetector& detector, const ContactStep& step, ContactSet& set) {
  for (ContactSet::Item& item : set.items) {
    const bool is_hull = detector.is_hull(item.contact);
    if (is_hull && step.number % hull_steps != 0) continue;
    const double margin = is_hull ? hull_closing_speed * hull_steps * step.dt : 0;
    item.is_near =
        detector.update(corners_of(set, item), tool_of(step, item).pose, margin, item.contact);
  }
}

void solve_contacts(const ContactDetector& detector, const ContactStep& step,
                    const ContactOptions& options, ContactSet& set) {
  std::vector<ContactConstraint>& constraints = set.constraints;
  constraints.clear();
  add_nodes(detector, step, options, set);
  for (std::size_t k = 0; k < set.items.size(); ++k)
    if (set.items[k].is_near) add_triangle(step, options, static_cast<std::int32_t>(k), set);
  double deepest = 0;
  for (const ContactConstraint& c : constraints) deepest = std::max(deepest, c.lack);
  std::fill(set.move.begin(), set.move.end(), Vec3::Zero());
  double change = deepest;
  for (int round = 0; round < most_rounds && change > good_enough * deepest; ++round) {
    change = 0;
    for (ContactConstraint& c : constraints)
      change = std::max(change, project(options.friction, c, set));
  }
  std::fill(set.force.begin(), set.force.end(), Vec3::Zero());
  for (const ContactConstraint& c : constraints) {
    const Vec3 force = (c.push * c.normal + c.drag) / step.response;
    Vec3& reaction = set.items[to_size(c.item)].reaction_sum;
    for (std::size_t a = 0; a < 3; ++a) {
      if (set.inverse_mass[to_size(c.place[a])] == 0) continue;
      set.force[to_size(c.place[a])] += c.weight[a] * force;
      reaction -= c.weight[a] * force;
    }
  }
}

}  // namespace trocar
