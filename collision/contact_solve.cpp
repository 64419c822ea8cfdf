#include "collision/contact_solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "collision/contact_constraint.h"
#include "collision/contact_tissue.h"

namespace trocar {

namespace {

// A triangle whose corners lie on a tool is left to these, where it reaches into the tool by less
// than this of its own size and faces it as they do.
constexpr double flat_enough = 1e-3, as_steep = 0.99;
// Of a triangle's size: what it may move beside a hull between two looks, which take Bullet 2 us.
constexpr double same_place = 0.02;
constexpr double as_a_lip = 0.5;  // cosine at which a lip of a wound faces a blade's flank
constexpr int most_rounds = 30;
constexpr double good_enough = 1e-3;  // change in a round / deepest point at the start

ContactDetector::Corners corners_of(const ContactSet& set, const ContactSet::Item& item) {
  ContactDetector::Corners corners;
  for (std::size_t a = 0; a < 3; ++a) {
    const ContactSet::BesidePiece& b = set.beside[item.beside[a]];
    corners.x[a] = b.x;
    corners.local[a] = b.local;
  }
  return corners;
}

const ToolMotion& tool_of(const ContactStep& step, const ContactSet::Item& item) {
  return step.tools[item.contact.tool];
}

// The displacement of a tool's point in the step. arm: from the tool's origin to it.
Vec3 motion_of(const ToolMotion& tool, const Vec3& arm, const ContactStep& step) {
  return step.dt * (tool.velocity + tool.angular_velocity.cross(arm));
}

// How far the node goes from where the tool would take it, contact left out.
double own_way(const ContactSet& set, const ContactSet::BesidePiece& b) {
  return (set.x_end[b.place] - b.x).norm();
}

bool is_at_front(const ContactSet& set, const ContactSet::Item& item) {
  return std::ranges::any_of(item.beside, [&](std::int32_t b) { return set.beside[b].is_front; });
}

// Whether the conditions of its corners keep a triangle out of the tool, too.
bool is_kept_by_corners(const ContactSet& set, const ContactConstraint& c, double lack) {
  double size2 = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t i = c.place[a];
    if (c.weight[a] == 0) continue;
    const DeepestPiece& deepest = set.deepest[i];
    if (deepest.item < 0 || deepest.touch.normal.dot(c.normal) < as_steep) return false;
    const Contact &contact = set.items[deepest.item].contact, &own = set.items[c.item].contact;
    if (contact.tool != own.tool || contact.piece != own.piece) return false;
    lack += c.weight[a] * deepest.touch.gap;
    const Vec3& next = set.x_end[c.place[(a + 1) % 3]];
    size2 = std::max(size2, (set.x_end[i] - next).squaredNorm());
  }
  return lack < flat_enough * std::sqrt(size2);
}

// What of a triangle is inside a tool with a corner that supports or graspers hold there can't go:
// asked to, it would be thrown anew whenever it comes back, by a tool at rest, too.
double leeway_of(const ContactDetector& detector, const ContactSet::Item& item, const Vec3& n,
                 const ContactSet& set) {
  double least = 1;
  for (const std::int32_t k : item.beside) {
    const ContactSet::BesidePiece& b = set.beside[k];
    const double leeway = leeway_along(n, set.inverse_mass[b.place]);
    if (leeway < least && detector.is_inside(item.contact, b.local)) least = leeway;
  }
  return least;
}

struct Release {
  const ContactDetector& detector;
  double most = 0;  // in a step [m]
};

// Unless the corners do all that it asks for.
void add_point(const ManifoldPoint& touch, const ContactStep& step, const Release& release,
               std::int32_t k, ContactSet& set) {
  const ContactSet::Item& item = set.items[k];
  const ToolMotion& tool = tool_of(step, item);
  const auto& [i, j, l] = item.place;
  const auto& w = touch.weight;
  ContactConstraint c{.item = k,
                      .place = {i, j, l, l},
                      .weight = {w[0], w[1], w[2], 0},
                      .normal = tool.pose.rotation * touch.normal};
  const Vec3 arm = tool.pose.rotation * touch.point;
  const Vec3 x = with_weights({set.x_end[i], set.x_end[j], set.x_end[l]}, w).point;
  const double gap = c.normal.dot(x - (arm + tool.pose.translation));
  if (gap >= 0 || is_kept_by_corners(set, c, -gap)) return;
  add_constraint(gap, release.most * leeway_of(release.detector, item, c.normal, set),
                 motion_of(tool, arm, step), c, set);
}

void add_triangle(const ContactStep& step, const Release& release, std::int32_t k,
                  ContactSet& set) {
  const ContactSet::Item& item = set.items[k];
  if (!item.is_near || is_at_front(set, item)) return;
  const Contact& nearest = item.contact;
  add_point({.weight = nearest.weight, .point = nearest.point, .normal = nearest.normal}, step,
            release, k, set);
  for (const ManifoldPoint& touch : item.manifold) add_point(touch, step, release, k, set);
}

// At the end of the step, along the normal where the node would be that moved with the tool.
std::optional<NodeTouch> look_at_node(const ContactDetector& detector, const Contact& contact,
                                      const Pose& pose, const ContactSet::BesidePiece& beside,
                                      const ContactSet& set) {
  std::optional<NodeTouch> touch =
      detector.touch_node(contact, {beside.x, beside.facing}, pose, own_way(set, beside));
  if (touch) touch->gap += touch->normal.dot(set.x_end[beside.place] - beside.x);
  return touch;
}

Vec3 facet_of(const ContactSet& set, const ContactSet::Item& item) {
  return area_normal(corners_of(set, item).x);
}

// Out of the tissue, of an edge of a plane body, too.
Vec3 outward(const ContactSet& set, const ContactSet::Item& item) {
  if (item.place[1] != item.place[2]) return facet_of(set, item);
  const std::array<Vec3, 3> x = corners_of(set, item).x;
  return {x[1].y() - x[0].y(), x[0].x() - x[1].x(), 0};
}

// Where the tissue's surface at nodes beside blades looks, and which are the fronts of wounds.
void face_nodes(const ContactDetector& detector, const ContactStep& step, ContactSet& set) {
  for (ContactSet::BesidePiece& b : set.beside) {
    b.facing.setZero();
    b.lip = 0;
    b.is_front = false;
  }
  for (const ContactSet::Item& item : set.items) {
    if (!detector.is_blade(item.contact)) continue;
    const Vec3 facet = facet_of(set, item);
    const Vec3 flank = tool_of(step, item).pose.rotation * Vec3::UnitY();
    const double along_flank = flank.dot(facet);
    const bool is_lip = std::abs(along_flank) > as_a_lip * facet.norm();
    for (const std::int32_t k : item.beside) {
      ContactSet::BesidePiece& b = set.beside[k];
      b.facing += facet;
      if (!is_lip) continue;
      if (along_flank * b.lip < 0) b.is_front = true;
      if (b.lip == 0) b.lip = along_flank;
    }
  }
}

void find_deepest(const ContactDetector& detector, const ContactStep& step, ContactSet& set) {
  std::fill(set.deepest.begin(), set.deepest.end(), DeepestPiece{});
  face_nodes(detector, step, set);
  for (ContactSet::BesidePiece& b : set.beside) {
    const ContactSet::Item& item = set.items[b.item];
    b.touch = look_at_node(detector, item.contact, tool_of(step, item).pose, b, set);
  }
  for (std::size_t k = 0; k < set.items.size(); ++k) {
    const ContactSet::Item& item = set.items[k];
    const Vec3 facet = outward(set, item);
    for (std::size_t a = 0; a < 3; ++a) {
      const ContactSet::BesidePiece& beside = set.beside[item.beside[a]];
      const std::optional<NodeTouch>& found = beside.touch;
      if (beside.is_front) continue;
      DeepestPiece& of_node = set.deepest[item.place[a]];
      if (found && found->gap < of_node.touch.gap && found->normal.dot(facet) < 0)
        of_node = {.item = static_cast<std::int32_t>(k), .touch = *found};
    }
  }
}

void add_nodes(const ContactDetector& detector, const ContactStep& step, double release,
               ContactSet& set) {
  find_deepest(detector, step, set);
  for (std::size_t i = 0; i < set.deepest.size(); ++i) {
    if (set.deepest[i].item < 0) continue;
    const ToolMotion& tool = tool_of(step, set.items[set.deepest[i].item]);
    const NodeTouch& touch = set.deepest[i].touch;
    const auto place = static_cast<std::int32_t>(i);
    ContactConstraint c{.item = set.deepest[i].item,
                        .place = {place, place, place, place},
                        .weight = {1, 0, 0, 0},
                        .normal = touch.normal};
    const Vec3 arm = set.x_end[i] - touch.gap * touch.normal - tool.pose.translation;
    add_constraint(touch.gap, release, motion_of(tool, arm, step), c, set);
  }
}

// The moves of a constraint's nodes while it is worked on.
struct Moves {
  std::array<Vec3, 4> of;

  Moves(const ContactConstraint& c, std::span<const Vec3> move)
      : of{move[c.place[0]], move[c.place[1]], move[c.place[2]], move[c.place[3]]} {}
  // Last ones first: a node that stands there twice has its weight in the first place.
  void put_back(const ContactConstraint& c, std::span<Vec3> move) const {
    for (std::size_t a = 4; a-- > 0;) move[c.place[a]] = of[a];
  }
  Vec3 extra(const ContactConstraint& c) const {
    return c.weight[0] * of[0] + c.weight[1] * of[1] + c.weight[2] * of[2] + c.weight[3] * of[3];
  }
  void add(const ContactConstraint& c, const Vec3& impulse) {
    for (std::size_t a = 0; a < 4; ++a) of[a] += c.lever[a].cwiseProduct(impulse);
  }
};

// The contact point's, of a constraint that is worked on.
Vec3 move_of(const ContactConstraint& c, const Moves& moves, const ContactSet& set) {
  if (set.clusters.is_empty()) return moves.extra(c);
  return moves.extra(c) + move_of_clusters(c, set.clusters);
}

void add(const ContactConstraint& c, const Vec3& impulse, Moves& moves, ContactSet& set) {
  moves.add(c, impulse);
  if (!set.clusters.is_empty()) add_to_clusters(c, impulse, set.clusters);
}

// Returns the square of the way that the contact point went.
double project(double friction, ContactConstraint& c, ContactSet& set) {
  Moves moves(c, set.move);
  const Vec3 before = move_of(c, moves, set);
  const double push =
      std::clamp(c.push + c.felt_mass * (c.lack - c.normal.dot(before)), 0.0, c.most_push);
  if (push == 0 && c.push == 0) return 0;
  add(c, (push - c.push) * c.normal, moves, set);
  c.push = push;
  const Vec3 now = move_of(c, moves, set), along = now - c.normal.dot(now) * c.normal;
  const Vec3 drag = at_most(c.drag - c.slip_mass * (c.slip + along), friction * push);
  add(c, drag - c.drag, moves, set);
  c.drag = drag;
  moves.put_back(c, set.move);
  return (move_of(c, moves, set) - before).squaredNorm();
}

// At a hull, which then sees as far as needed until the triangle has moved.
bool has_to_look(const std::array<Vec3, 3>& corners, double& way, ContactSet::Item& item) {
  const double size = (corners[1] - corners[0]).norm(), slack = same_place * size;
  double moved = 0;
  for (std::size_t a = 0; a < 3; ++a) moved = std::max(moved, (corners[a] - item.seen[a]).norm());
  if (moved <= slack && way + moved <= item.sight) return false;
  item.seen = corners;
  item.sight = way = 2 * way + slack;
  return true;
}

// On nodes, and on tools from what they have pushed and dragged.
void sum_forces(const ContactStep& step, ContactSet& set) {
  std::ranges::fill(set.force, Vec3::Zero());
  for (const ContactConstraint& c : set.constraints) {
    const Vec3 force = (c.push * c.normal + c.drag) / step.response;
    Vec3 sum = Vec3::Zero(), point = Vec3::Zero();
    for (std::size_t a = 0; a < 4; ++a) {
      // Instruments pass through what is held; tissue bears on it.
      const bool is_held = set.inverse_mass[c.place[a]].maxCoeff() == 0;
      if (is_held && c.item >= 0) continue;
      set.force[c.place[a]] += c.weight[a] * force;
      sum += c.weight[a] * force;
      point += c.weight[a] * set.x_end[c.place[a]];
    }
    if (c.item < 0) continue;
    ContactSet::Item& item = set.items[c.item];
    item.reaction_sum -= sum;
    item.torque_sum -= point.cross(force) - tool_of(step, item).pose.translation.cross(sum);
  }
}

}  // namespace

void place_beside(const ContactStep& step, ContactSet& set) {
  for (ContactSet::BesidePiece& b : set.beside) {
    const ToolMotion& tool = tool_of(step, set.items[b.item]);
    const Vec3& x = set.x_start[b.place];
    b.x = x + motion_of(tool, x - tool.pose.translation, step);
    b.local = tool.pose.apply_inverse(b.x);
  }
}

void look_again(const ContactDetector& detector, const ContactStep& step, ContactSet& set) {
  place_beside(step, set);
  for (ContactSet::Item& item : set.items) {
    double way = 0;
    for (const std::int32_t b : item.beside) way = std::max(way, own_way(set, set.beside[b]));
    const ContactDetector::Corners corners = corners_of(set, item);
    if (detector.is_hull(item.contact) && !has_to_look(corners.local, way, item)) continue;
    item.is_near = detector.update(corners, tool_of(step, item).pose, way, item.contact);
    if (detector.is_hull(item.contact)) {
      item.manifold = item.is_near ? detector.manifold(corners, way, item.contact) : Manifold{};
    }
  }
}

void solve_contacts(const ContactDetector& detector, const ContactStep& step,
                    const ContactOptions& options, ContactSet& set) {
  std::vector<ContactConstraint>& constraints = set.constraints;
  constraints.clear();
  const double release = options.release_speed * step.dt;
  add_nodes(detector, step, release, set);
  for (std::size_t k = 0; k < set.items.size(); ++k)
    add_triangle(step, {.detector = detector, .most = release}, static_cast<std::int32_t>(k), set);
  add_tissue({.number = step.number, .dt = step.dt}, release, set);
  double deepest = 0;
  for (const ContactConstraint& c : constraints) deepest = std::max(deepest, c.lack);
  std::ranges::fill(set.move, Vec3::Zero());
  std::ranges::fill(set.clusters.impulse, Vec3::Zero());
  begin_tissue(step.number, options.friction, set);
  double change = deepest;
  for (int round = 0; round < most_rounds && change > good_enough * deepest; ++round) {
    double change2 = 0;
    for (ContactConstraint& c : constraints)
      change2 = std::max(change2, project(options.friction, c, set));
    change = std::sqrt(change2);
  }
  end_tissue(step.number, set);
  sum_forces(step, set);
}

}  // namespace trocar
