#include "collision/contact_tissue.h"

#include <algorithm>

namespace trocar {

namespace {

// Tissue that approaches tissue is looked at before it could meet at twice its speed and this.
// [m/s]
constexpr double speedup = 0.2;

struct Nearest {
  const ContactSet::TissueItem* item = nullptr;
  TissueCandidate candidate;
};

// Before they could meet.
std::int64_t steps_apart(const ContactSet& set, const ContactSet::TissueItem& item,
                         const TissueTouch& touch, double dt) {
  const auto motion = [&](std::size_t a) -> Vec3 {
    const std::size_t i = to_size(item.place[a]);
    return set.x_end[i] - set.x_start[i];
  };
  Vec3 relative = motion(0);
  for (std::size_t a = 0; a < 3; ++a) relative -= touch.nearest.weight[a] * motion(a + 1);
  return static_cast<std::int64_t>(touch.distance / (2 * relative.norm() + speedup * dt));
}

// The nearest triangle that a node may meet, of its pairs from `first` on; returns where those of
// the next node begin.
std::size_t find_nearest(std::int64_t step, double dt, ContactSet& set, std::size_t first,
                         Nearest& nearest) {
  const std::int32_t node = set.tissue[first].place[0];
  std::size_t k = first;
  for (; k < set.tissue.size() && set.tissue[k].place[0] == node; ++k) {
    ContactSet::TissueItem& item = set.tissue[k];
    if (step < item.next_look) continue;
    const auto& [i, a, b, c] = item.place;
    const TissueTouch touch =
        touch_tissue(set.x_end[to_size(i)],
                     {set.x_end[to_size(a)], set.x_end[to_size(b)], set.x_end[to_size(c)]});
    item.next_look = step + steps_apart(set, item, touch, dt);
    const TissueCandidate candidate{touch, item.handicap};
    if (!nearest.item || says_more(candidate, nearest.candidate)) nearest = {&item, candidate};
  }
  return k;
}

}  // namespace

void add_tissue(std::int64_t step, double dt, double release, ContactSet& set) {
  for (std::size_t k = 0; k < set.tissue.size();) {
    Nearest nearest;
    k = find_nearest(step, dt, set, k, nearest);
    const TissueTouch& touch = nearest.candidate.touch;
    if (!nearest.item || !touch.is_below) continue;
    const auto& w = touch.nearest.weight;
    ContactConstraint c{.item = -1,
                        .place = nearest.item->place,
                        .weight = {1, -w[0], -w[1], -w[2]},
                        .normal = touch.normal};
    add_constraint(touch.height, release, Vec3::Zero(), c, set);
  }
}

void begin_tissue(std::int64_t step, double friction, ContactSet& set) {
  for (ContactConstraint& c : set.constraints) {
    if (c.item >= 0) continue;
    const ContactSet::TissueImpulse& last = set.impulse[to_size(c.place[0])];
    if (last.step + 1 != step) continue;
    c.push = std::min(last.push, c.most_push);
    c.drag = at_most(last.drag - c.normal.dot(last.drag) * c.normal, friction * c.push);
    apply_impulse(c, c.push * c.normal + c.drag, set);
  }
}

void end_tissue(std::int64_t step, ContactSet& set) {
  for (const ContactConstraint& c : set.constraints)
    if (c.item < 0)
      set.impulse[to_size(c.place[0])] = {.step = step, .push = c.push, .drag = c.drag};
}

}  // namespace trocar
