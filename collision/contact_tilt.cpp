#include "collision/contact_tilt.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace trocar {

namespace {

// Of the power method, from random numbers: 2 % below the frequency and less.
constexpr int rounds = 30;

// Radius over edge of a tool that is flat to a triangle: its point goes from corner to corner as
// the triangle tilts by a thousandth, and turns it no further. What may grow so stays unseen, and
// its stiffness would cost a multiple of the steps.
constexpr double flat_radius = 1000;

// Without a turn if the tool is flat.
Tilt make_tilt(const ContactSet::Item& item, double force, double radius, const ContactSet& set) {
  constexpr double flat = 1e-9;  // on plane meshes the third corner is a copy
  Tilt tilt{.place = item.place, .normal = item.reaction_sum.normalized()};
  std::array<Vec3, 3> x;
  for (std::size_t a = 0; a < 3; ++a) x[a] = set.x_start[item.place[a]];
  double longest2 = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    tilt.edge[a] = x[(a + 2) % 3] - x[(a + 1) % 3];
    longest2 = std::max(longest2, tilt.edge[a].squaredNorm());
  }
  if (radius * radius > flat_radius * flat_radius * longest2) return tilt;
  const double moment = force * radius, twice_area = tilt.edge[0].cross(tilt.edge[1]).norm();
  if (twice_area > flat * longest2) {
    tilt.turn = moment / (twice_area * twice_area);
    return tilt;
  }
  tilt.edge = {Vec3::UnitX(), -Vec3::UnitX(), Vec3::Zero()};
  tilt.turn = moment / longest2;
  return tilt;
}

}  // namespace

std::vector<Tilt> find_tilts(const ContactDetector& detector, std::int64_t n_steps,
                             const ContactSet& set) {
  std::vector<Tilt> tilts;
  if (!set.is_counted_here) return tilts;
  for (const ContactSet::Item& item : set.items) {
    const double force = item.reaction_sum.norm() / static_cast<double>(n_steps);
    if (const double radius = detector.radius(item.contact); force * radius > 0)
      if (const Tilt tilt = make_tilt(item, force, radius, set); tilt.turn > 0)
        tilts.push_back(tilt);
  }
  return tilts;
}

void add_tilt_force(const Tilt& tilt, const std::array<Vec3, 3>& u, std::array<Vec3, 3>& force) {
  Vec3 slope = Vec3::Zero();
  for (std::size_t a = 0; a < 3; ++a) slope += tilt.normal.dot(u[a]) * tilt.edge[a];
  for (std::size_t a = 0; a < 3; ++a) force[a] -= tilt.turn * tilt.edge[a].dot(slope) * tilt.normal;
}

// As if each node had its mass alone.
static double tilt_frequency2_apart(std::span<const Tilt> tilts, const ContactSet& set) {
  std::vector<double> u(set.node.size()), force(set.node.size());
  std::uint32_t noise = 1;
  for (double& of_node : u)
    of_node = static_cast<double>((noise = noise * 1664525 + 1013904223) >> 8);
  double omega2 = 0;
  for (int round = 0; round < rounds; ++round) {
    std::ranges::fill(force, 0);
    for (const Tilt& tilt : tilts) {
      Vec3 slope = Vec3::Zero();
      for (std::size_t a = 0; a < 3; ++a) slope += u[tilt.place[a]] * tilt.edge[a];
      for (std::size_t a = 0; a < 3; ++a)
        force[tilt.place[a]] += tilt.turn * tilt.edge[a].dot(slope);
    }
    // Rayleigh's quotient of M^-1 K in the metric of M, over nodes that move.
    double stored = 0, swung = 0, largest = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double by_mass = set.inverse_mass[i].maxCoeff(), a = by_mass * force[i];
      if (by_mass > 0) swung += u[i] * u[i] / by_mass;
      stored += u[i] * force[i];
      largest = std::max(largest, std::abs(a));
      u[i] = a;
    }
    if (largest == 0) return omega2;
    omega2 = stored / swung;
    for (double& of_node : u) of_node /= largest;
  }
  return omega2;
}

double tilt_frequency2(std::span<const Tilt> tilts, const ContactSet& set) {
  if (tilts.empty()) return 0;
  // Joined masses give way by up to twice as much as each node alone.
  return (set.clusters.is_empty() ? 1 : 2) * tilt_frequency2_apart(tilts, set);
}

}  // namespace trocar
