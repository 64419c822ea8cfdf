#include "collision/contact_force.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace trocar {

namespace {

constexpr double stick_rate = 0.2;  // c dt / m at most, see prepare_contacts

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// The sum of the weights of all contacts at each node.
std::vector<double> weight_sums(std::span<const Contact> contacts, std::size_t n_nodes) {
  std::vector<double> W(n_nodes, 0.0);
  for (const Contact& c : contacts)
    for (std::size_t a = 0; a < 3; ++a) W[index(c.node[a])] += c.weight[a];
  return W;
}

// The mass with which a contact may be as stiff as kappa m / dt^2. Nodes without weight take no
// part.
double contact_mass(const Contact& c, std::span<const double> W, std::span<const double> mass) {
  double least = 0;
  bool is_first = true;
  for (std::size_t a = 0; a < 3; ++a) {
    if (c.weight[a] <= 0) continue;
    const double m = mass[index(c.node[a])] / W[index(c.node[a])];
    least = is_first ? m : std::min(least, m);
    is_first = false;
  }
  return least;
}

Vec3 weighted(const ContactSet::Item& item, std::span<const double> field) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t i = 3 * index(item.local[a]);
    sum += item.contact.weight[a] * Vec3(field[i], field[i + 1], field[i + 2]);
  }
  return sum;
}

Vec3 reference_point(const Contact& contact, std::span<const Vec3> X) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < 3; ++a) sum += contact.weight[a] * X[index(contact.node[a])];
  return sum;
}

// Force of the tool on the tissue. x, v: of the contact's point of tissue.
Vec3 force_on_tissue(const ContactSet::Item& item, const Vec3& x, const Vec3& v,
                     const ToolMotion& tool, double friction) {
  const Vec3 n = tool.pose.rotation * item.contact.normal;
  const Vec3 arm = tool.pose.rotation * item.contact.point;
  const double gap = n.dot(x - (arm + tool.pose.translation));
  if (!(gap < 0)) return Vec3::Zero();
  const double f_n = item.stiffness * std::min(-gap, item.depth);
  const Vec3 v_rel = v - (tool.velocity + tool.angular_velocity.cross(arm));
  const Vec3 v_t = v_rel - n.dot(v_rel) * n;
  const double speed = v_t.norm();
  // min(mu f_n, c |v_t|) / |v_t|, without the division where it sticks.
  const double slip_force = friction * f_n;
  const double drag = item.damping * speed <= slip_force ? item.damping : slip_force / speed;
  return f_n * n - drag * v_t;
}

}  // namespace

ContactSet prepare_contacts(std::span<const Contact> contacts, const Part& part,
                            std::span<const double> mass, double dt,
                            const ContactOptions& options) {
  CHECK(dt > 0);
  ContactSet set;
  const std::vector<double> W = weight_sums(contacts, mass.size());
  for (const Contact& contact : contacts) {
    ContactSet::Item item{.contact = contact};
    for (std::size_t a = 0; a < 3; ++a) item.local[a] = part.node_local[index(contact.node[a])];
    const auto is_owned = [&](std::int32_t i) { return i >= 0 && i < part.n_owned; };
    if (std::none_of(item.local.begin(), item.local.end(), is_owned)) continue;
    // A rank holds all nodes of each element that touches a node it owns.
    for (const std::int32_t i : item.local) CHECK_OP(i, >=, 0);
    const double m = contact_mass(contact, W, mass);
    item.stiffness = options.stiffness * m / (dt * dt);
    item.depth = options.release_speed * dt / std::sqrt(options.stiffness);
    item.damping = stick_rate * m / dt;
    item.is_counted_here = is_owned(item.local[0]);
    set.items.push_back(item);
  }
  return set;
}

void add_contact_force(const ContactSet& set, const Part& part, std::span<const Vec3> X,
                       std::span<const double> u, std::span<const double> v,
                       std::span<const ToolMotion> tools, const ContactOptions& options,
                       std::span<double> force, std::span<Vec3> reaction) {
  CHECK_OP(reaction.size(), ==, set.items.size());
  for (std::size_t k = 0; k < set.items.size(); ++k) {
    const ContactSet::Item& item = set.items[k];
    const Vec3 x = reference_point(item.contact, X) + weighted(item, u);
    const Vec3 f = force_on_tissue(item, x, weighted(item, v), tools[index(item.contact.tool)],
                                   options.friction);
    for (std::size_t a = 0; a < 3; ++a) {
      if (item.local[a] >= part.n_owned) continue;
      for (std::size_t i = 0; i < 3; ++i)
        force[3 * index(item.local[a]) + i] +=
            item.contact.weight[a] * f[static_cast<Eigen::Index>(i)];
    }
    reaction[k] = item.is_counted_here ? Vec3(-f) : Vec3::Zero();
  }
}

}  // namespace trocar
