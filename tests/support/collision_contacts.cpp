#include "collision_contacts.h"

#include <numeric>

namespace trocar {

Part whole_part(std::int32_t n_nodes) {
  Part part;
  part.node_global.resize(static_cast<std::size_t>(n_nodes));
  std::iota(part.node_global.begin(), part.node_global.end(), 0);
  part.n_owned = n_nodes;
  part.node_local = part.node_global;
  return part;
}

Vec3 node_of(const std::vector<double>& field, std::size_t i) {
  return {field[3 * i], field[3 * i + 1], field[3 * i + 2]};
}

Contact node_contact(std::int32_t node, const Vec3& n, const Vec3& point) {
  return {.node = {node, node, node}, .weight = {1, 0, 0}, .point = point, .normal = n};
}

ContactBench::ContactBench(std::vector<Vec3> X_, std::vector<double> mass_)
    : X(std::move(X_)),
      mass(std::move(mass_)),
      u(3 * X.size()),
      v(3 * X.size()),
      u_next(3 * X.size()),
      force(3 * X.size()),
      part(whole_part(static_cast<std::int32_t>(X.size()))) {}

void ContactBench::prepare(const std::vector<Contact>& contacts, std::vector<std::uint8_t> held,
                           const std::vector<TissuePair>& tissue) {
  held.resize(mass.size());
  set = prepare_contacts({contacts, tissue}, std::vector<std::int32_t>(mass.size(), 0), part,
                         {.mass = mass, .held = held});
}

void ContactBench::place() {
  for (std::size_t k = 0; k < set.node.size(); ++k) {
    const auto i = static_cast<std::size_t>(set.node[k]);
    set.x_start[k] = X[i] + Vec3::Map(&u[3 * i]);
    set.x_end[k] = X[i] + Vec3::Map(&u_next[3 * i]);
  }
}

void ContactBench::add_forces() {
  place();
  place_beside(contact_step(), set);
  solve_contacts(detector, contact_step(), options, set);
  force.assign(force.size(), 0.0);
  for (std::size_t k = 0; k < set.node.size(); ++k)
    Vec3::Map(&force[3 * static_cast<std::size_t>(set.node[k])]) = set.force[k];
}

void ContactBench::step(const std::vector<double>& own) {
  for (std::size_t i = 0; i < u.size(); ++i)
    u_next[i] = u[i] + dt * (v[i] + dt * own[i] / mass[i / 3]);
  add_forces();
  for (std::size_t i = 0; i < u.size(); ++i) {
    v[i] += dt * (force[i] + own[i]) / mass[i / 3];
    u[i] += dt * v[i];
  }
}

void ContactBench::step(const Vec3& gravity) {
  std::vector<double> own(u.size());
  for (std::size_t i = 0; i < own.size(); ++i)
    own[i] = mass[i / 3] * gravity[static_cast<Eigen::Index>(i % 3)];
  step(own);
}

Vec3 ContactBench::reaction() const {
  Vec3 sum = Vec3::Zero();
  for (const ContactSet::Item& item : set.items) sum += item.reaction_sum;
  return sum;
}

}  // namespace trocar
