#include "collision/contact_constraint.h"

#include <algorithm>
#include <cmath>

#include "collision/contact_clusters.h"
#include "collision/contact_set.h"

namespace trocar {

namespace {

constexpr double furthest = 4;  // that a contact moves a node, in what it lacks

// Of the square of n, 1 where nothing is supported.
double free_part(const Vec3& n, const Vec3& inverse_mass) {
  double held = 0;
  for (int j = 0; j < 3; ++j)
    if (inverse_mass[j] == 0) held += n[j] * n[j];
  return std::max(0.0, 1 - held);
}

// n·M^-1 n, by the bits 1 / m where nothing is supported.
double yield_along(const Vec3& n, const Vec3& inverse_mass) {
  return inverse_mass.maxCoeff() * free_part(n, inverse_mass);
}

}  // namespace

double leeway_along(const Vec3& n, const Vec3& inverse_mass) {
  return inverse_mass.maxCoeff() == 0 ? 0 : std::min(1.0, furthest * free_part(n, inverse_mass));
}

void add_constraint(double gap, double release, const Vec3& away, ContactConstraint& c,
                    ContactSet& set) {
  Vec3 relative = -away;
  double inverse = 0, along_n = 0, lightest = 0, yielding = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    const std::size_t i = c.place[a];
    relative += c.weight[a] * (set.x_end[i] - set.x_start[i]);
    const Vec3& by_mass = set.inverse_mass[i];
    c.lever[a] = c.weight[a] * (set.clusters.is_empty() ? by_mass : set.clusters.alone[i]);
    inverse += c.weight[a] * c.weight[a] * by_mass.maxCoeff();
    along_n += c.weight[a] * c.weight[a] * yield_along(c.normal, by_mass);
    if (by_mass.maxCoeff() > 0) yielding = std::max(yielding, std::abs(c.weight[a]));
    lightest = std::max(lightest, std::abs(c.weight[a]) * by_mass.maxCoeff());
  }
  if (!set.clusters.is_empty()) {
    const Vec3 joined = yield_of_clusters(c, set.clusters);
    inverse += joined.maxCoeff();
    along_n += c.normal.dot(joined.cwiseProduct(c.normal));
  }
  const double closing = c.normal.dot(relative), before = gap - closing;
  const double least = before < 0 ? std::min(0.0, before + release) : 0.0;
  c.lack = least - gap;
  if (!(c.lack > 0 && along_n > 0)) return;
  c.slip = relative - closing * c.normal;
  c.felt_mass = 1 / along_n;
  c.slip_mass = 1 / inverse;
  // Towards a normal along which supports hold all nodes it fades to the nothing of held ones.
  c.most_push = furthest * c.lack / lightest * std::min(1.0, furthest * along_n / inverse) *
                std::min(1.0, furthest * yielding);
  set.constraints.push_back(c);
}

void apply_impulse(const ContactConstraint& c, const Vec3& impulse, ContactSet& set) {
  for (std::size_t a = 0; a < 4; ++a) set.move[c.place[a]] += c.lever[a].cwiseProduct(impulse);
  if (!set.clusters.is_empty()) add_to_clusters(c, impulse, set.clusters);
}

Vec3 at_most(const Vec3& v, double most) {
  const double size = v.norm();
  return size > most ? Vec3(most / size * v) : v;
}

}  // namespace trocar
