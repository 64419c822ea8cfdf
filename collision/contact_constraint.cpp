#include "collision/contact_constraint.h"

#include <algorithm>
#include <cmath>

#include "collision/contact_set.h"

namespace trocar {

namespace {

constexpr double furthest = 4;  // that a contact moves a node, in what it lacks

}  // namespace

void add_constraint(double gap, double release, const Vec3& away, ContactConstraint& c,
                    ContactSet& set) {
  Vec3 relative = -away;
  double inverse = 0, lightest = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    const std::size_t i = to_size(c.place[a]);
    relative += c.weight[a] * (set.x_end[i] - set.x_start[i]);
    c.lever[a] = c.weight[a] * set.inverse_mass[i];
    inverse += c.weight[a] * c.weight[a] * set.inverse_mass[i];
    lightest = std::max(lightest, std::abs(c.weight[a]) * set.inverse_mass[i]);
  }
  const double closing = c.normal.dot(relative), before = gap - closing;
  const double least = before < 0 ? std::min(0.0, before + release) : 0.0;
  c.lack = least - gap;
  if (!(c.lack > 0 && inverse > 0)) return;
  c.slip = relative - closing * c.normal;
  c.felt_mass = 1 / inverse;
  c.most_push = furthest * c.lack / lightest;
  set.constraints.push_back(c);
}

void apply_impulse(const ContactConstraint& c, const Vec3& impulse, ContactSet& set) {
  for (std::size_t a = 0; a < 4; ++a) set.move[to_size(c.place[a])] += c.lever[a] * impulse;
}

Vec3 at_most(const Vec3& v, double most) {
  const double size = v.norm();
  return size > most ? Vec3(most / size * v) : v;
}

}  // namespace trocar
