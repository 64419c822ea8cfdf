// Contacts made by hand, on nodes that one rank owns, for the tests of the force law.
#pragma once

#include <numeric>
#include <vector>

#include "collision/contact_force.h"

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
  std::vector<double> mass, u, v, force;
  ContactOptions options{.release_speed = 1e9};  // no saturation, unless a test asks for it
  double dt = 1e-4;
  std::vector<ToolMotion> tools = std::vector<ToolMotion>(1);
  Part part;
  ContactSet set;
  std::vector<Vec3> reaction;

  ContactBench(std::vector<Vec3> X_, std::vector<double> mass_)
      : X(std::move(X_)),
        mass(std::move(mass_)),
        u(3 * X.size()),
        v(3 * X.size()),
        force(3 * X.size()),
        part(whole_part(static_cast<std::int32_t>(X.size()))) {}

  void prepare(const std::vector<Contact>& contacts) {
    set = prepare_contacts(contacts, part, mass, dt, options);
    reaction.resize(set.items.size());
  }
  void add_forces() {
    force.assign(force.size(), 0.0);
    add_contact_force(set, part, X, u, v, tools, options, force, reaction);
  }
  void step(const Vec3& gravity) {
    add_forces();
    for (std::size_t i = 0; i < u.size(); ++i) {
      v[i] += dt * (force[i] / mass[i / 3] + gravity[static_cast<Eigen::Index>(i % 3)]);
      u[i] += dt * v[i];
    }
  }
};

}  // namespace trocar
