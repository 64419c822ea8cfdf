// Contacts made by hand, on nodes that one rank owns, for the tests of the force law.
#pragma once

#include <numeric>
#include <vector>

#include "collision/contact_solve.h"

namespace trocar {

inline Part whole_part(std::int32_t n_nodes) {
  Part part;
  part.node_global.resize(static_cast<std::size_t>(n_nodes));
  std::iota(part.node_global.begin(), part.node_global.end(), 0);
  part.n_owned = n_nodes;
  part.node_local = part.node_global;
  return part;
}

// A node on a tool that fills the half-space below `point`, normal n (from tool to tissue).
inline Contact node_contact(std::int32_t node, const Vec3& n, const Vec3& point = Vec3::Zero()) {
  return {.node = {node, node, node}, .weight = {1, 0, 0}, .point = point, .normal = n};
}

// Nodes with contacts on one tool, integrated by central differences (velocity half a step behind).
struct ContactBench {
  std::vector<Vec3> X;
  std::vector<double> mass, u, v, u_next, force;
  ContactOptions options;
  double dt = 1e-4;
  std::vector<ToolMotion> tools = std::vector<ToolMotion>(1);
  Part part;
  ContactDetector detector{
      std::vector<ToolShape>(3, {{{.points = {Vec3(0, 0, 1e3)}}}})};  // far off
  ContactSet set;

  ContactBench(std::vector<Vec3> X_, std::vector<double> mass_)
      : X(std::move(X_)),
        mass(std::move(mass_)),
        u(3 * X.size()),
        v(3 * X.size()),
        u_next(3 * X.size()),
        force(3 * X.size()),
        part(whole_part(static_cast<std::int32_t>(X.size()))) {}

  void prepare(const std::vector<Contact>& contacts, std::vector<std::uint8_t> is_held = {}) {
    is_held.resize(mass.size());
    set = prepare_contacts(contacts, std::vector<std::int32_t>(mass.size(), 0), part, 0, mass,
                           is_held);
  }
  ContactStep contact_step() const { return {.tools = tools, .dt = dt, .response = dt * dt}; }
  void place() {
    for (std::size_t k = 0; k < set.node.size(); ++k) {
      const auto i = static_cast<std::size_t>(set.node[k]);
      set.x_start[k] = X[i] + Vec3::Map(&u[3 * i]);
      set.x_end[k] = X[i] + Vec3::Map(&u_next[3 * i]);
    }
  }
  // Contact forces of a step from u to u_next.
  void add_forces() {
    place();
    solve_contacts(detector, contact_step(), options, set);
    force.assign(force.size(), 0.0);
    for (std::size_t k = 0; k < set.node.size(); ++k)
      Vec3::Map(&force[3 * static_cast<std::size_t>(set.node[k])]) = set.force[k];
  }
  // A step with the bodies' own forces `own` (n * 3) [N].
  void step(const std::vector<double>& own) {
    for (std::size_t i = 0; i < u.size(); ++i)
      u_next[i] = u[i] + dt * (v[i] + dt * own[i] / mass[i / 3]);
    add_forces();
    for (std::size_t i = 0; i < u.size(); ++i) {
      v[i] += dt * (force[i] + own[i]) / mass[i / 3];
      u[i] += dt * v[i];
    }
  }
  void step(const Vec3& gravity) {
    std::vector<double> own(u.size());
    for (std::size_t i = 0; i < own.size(); ++i)
      own[i] = mass[i / 3] * gravity[static_cast<Eigen::Index>(i % 3)];
    step(own);
  }
  Vec3 reaction() const {
    Vec3 sum = Vec3::Zero();
    for (const ContactSet::Item& item : set.items) sum += item.reaction_sum;
    return sum;
  }
};

}  // namespace trocar
