#include "collision/contact_tissue.h"

#include <algorithm>
#include <limits>

#include "base/box.h"

namespace trocar {

namespace {

// Tissue that approaches tissue is looked at before it could meet at twice its speed and this.
// [m/s]
constexpr double speedup = 0.2;

// Of the pairs of a node. Height and normal are looked for where they decide.
struct Nearest {
  const ContactSet::TissueItem* item = nullptr;
  TrianglePoint point;
  double distance = 0;
};

Triangle corners_of(const ContactSet& set, const ContactSet::TissueItem& item) {
  const auto& [i, a, b, c] = item.place;
  return {set.x_end[a], set.x_end[b], set.x_end[c]};
}

const Vec3& node_of(const ContactSet& set, const ContactSet::TissueItem& item) {
  return set.x_end[item.place[0]];
}

TissueCandidate candidate_of(const ContactSet& set, const Nearest& near) {
  return {touch_tissue(node_of(set, *near.item), corners_of(set, *near.item), near.point),
          near.item->handicap};
}

bool says_more(const ContactSet& set, const Nearest& near, const Nearest& than) {
  if (are_equally_near(near.distance, than.distance))
    return says_more(candidate_of(set, near), candidate_of(set, than));
  return near.distance + near.item->handicap < than.distance + than.item->handicap;
}

// Before they could meet.
std::int64_t steps_apart(const ContactSet& set, const Nearest& near, double dt) {
  if (near.distance < speedup * dt) return 0;
  const auto motion = [&](std::size_t a) -> Vec3 {
    const std::size_t i = near.item->place[a];
    return set.x_end[i] - set.x_start[i];
  };
  Vec3 relative = motion(0);
  for (std::size_t a = 0; a < 3; ++a) relative -= near.point.weight[a] * motion(a + 1);
  return static_cast<std::int64_t>(near.distance / (2 * relative.norm() + speedup * dt));
}

// How far two nodes of the set may come apart or together in this step.
double largest_way(const ContactSet& set) {
  Box moves;
  for (std::size_t i = 0; i < set.node.size(); ++i) moves.add(set.x_end[i] - set.x_start[i]);
  return moves.size().norm();
}

// The nearest triangle that the node may meet, of those that are looked at in this step. Where
// tissue is set in motion that rested (by a support, by other tissue), speeds of before say little
// about when it meets; the way that the fastest has come does. way: of this step [m].
Nearest find_nearest(const TissueStep& step, double way, ContactSet::TissueNode& node,
                     ContactSet& set) {
  Nearest nearest;
  node.next_look = std::numeric_limits<std::int64_t>::max();
  node.next_way = std::numeric_limits<double>::max();
  for (std::size_t k = node.first; k < node.end; ++k) {
    ContactSet::TissueItem& item = set.tissue[k];
    if (step.number >= item.next_look || set.way >= item.next_way) {
      const Vec3& x = node_of(set, item);
      Nearest here{.item = &item, .point = closest_point_triangle(x, corners_of(set, item))};
      here.distance = (x - here.point.point).norm();
      item.next_look = step.number + steps_apart(set, here, step.dt);
      item.next_way = set.way + here.distance - way;
      if (!nearest.item || says_more(set, here, nearest)) nearest = here;
    }
    node.next_look = std::min(node.next_look, item.next_look);
    node.next_way = std::min(node.next_way, item.next_way);
  }
  return nearest;
}

}  // namespace

void add_tissue(const TissueStep& step, double release, ContactSet& set) {
  if (set.tissue_node.empty()) return;
  const double way = largest_way(set);
  set.way += way;
  for (ContactSet::TissueNode& node : set.tissue_node) {
    if (step.number < node.next_look && set.way < node.next_way) continue;
    const Nearest nearest = find_nearest(step, way, node, set);
    if (!nearest.item) continue;
    const TissueTouch touch = candidate_of(set, nearest).touch;
    if (!touch.is_below) continue;
    const auto& w = touch.nearest.weight;
    ContactConstraint c{.item = -1,
                        .place = nearest.item->place,
                        .weight = {1, -w[0], -w[1], -w[2]},
                        .normal = touch.normal};
    set.found_by[c.place[0]] = static_cast<std::int32_t>(nearest.item - set.tissue.data());
    add_constraint(touch.height, release, Vec3::Zero(), c, set);
  }
}

std::vector<double> depths_in_tissue(const ContactSet& set, std::span<const Vec3> x) {
  std::vector<double> depth(set.node.size(), 0.0);
  const auto at = [&](std::int32_t place) { return x[set.node[place]]; };
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (set.found_by[i] < 0) continue;
    const auto& [node, a, b, c] = set.tissue[set.found_by[i]].place;
    const TissueTouch touch = touch_tissue(at(node), {at(a), at(b), at(c)});
    if (touch.is_below) depth[i] = -touch.height;
  }
  return depth;
}

void begin_tissue(std::int64_t step, double friction, ContactSet& set) {
  for (ContactConstraint& c : set.constraints) {
    if (c.item >= 0) continue;
    const ContactSet::TissueImpulse& last = set.impulse[c.place[0]];
    if (last.step + 1 != step) continue;
    c.push = std::min(last.push, c.most_push);
    c.drag = at_most(last.drag - c.normal.dot(last.drag) * c.normal, friction * c.push);
    apply_impulse(c, c.push * c.normal + c.drag, set);
  }
}

void end_tissue(std::int64_t step, ContactSet& set) {
  for (const ContactConstraint& c : set.constraints)
    if (c.item < 0) set.impulse[c.place[0]] = {.step = step, .push = c.push, .drag = c.drag};
}

}  // namespace trocar
