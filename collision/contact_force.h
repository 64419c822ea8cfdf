// Penalty force with Coulomb friction of the contacts found by the detector, evaluated in every
// substep from the stored points and normals.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/detector.h"
#include "mesh/partition.h"

namespace trocar {

struct ContactOptions {
  // kappa: no node's contact stiffness exceeds kappa m / dt^2 (stable: numerics 1.10)
  double stiffness = 0.2;
  double friction = 0.2;  // Coulomb's mu
  // The force saturates at the depth release_speed dt / sqrt(kappa), where the spring holds the
  // energy m release_speed^2 / 2: without it tissue that a tool appears inside of by 3 mm (jaws
  // that open, a fresh cut) was thrown out at 10 m/s, whatever dt, and inverted its elements. [m/s]
  double release_speed = 5;
};

// Contacts as this rank evaluates them in a frame: those that touch a node it owns.
struct ContactSet {
  struct Item {
    Contact contact;
    std::array<std::int32_t, 3> local{};  // local node numbers (owned or halo)
    double stiffness = 0;                 // [N/m]
    double depth = 0;                     // at which the force saturates [m]
    double damping = 0;                   // tangential [N s/m], for the regularised Coulomb law
    bool is_counted_here =
        false;  // this rank owns the contact's first node: it reports the reaction
  };
  std::vector<Item> items;  // in the detector's order
};

// stiffness: k_c = kappa / dt^2 min over its nodes of m_i / W_i, where W_i is the sum of the
// weights of all contacts at node i. Contact c adds k_c w_i w_j n n^T to the stiffness matrix; its
// weights sum to 1, so row i sums to at most sum_c k_c w_i <= kappa m_i / dt^2, and by Gershgorin
// no eigenvalue of M^-1 K dt^2 exceeds kappa.
// damping: c_c = 0.2 / dt min m_i / W_i. By the same argument no eigenvalue of M^-1 C dt exceeds
// 0.2: sticking velocity decays monotonically. Central differences with lagged damping are stable
// while omega^2 dt^2 + 2 c dt / m <= 4; with elements at 0.9 of their stable step and kappa = 0.2
// the sum is 3.24 + 0.2 + 0.4.
// contacts: all of them, on every rank. mass (n_nodes) global [kg].
ContactSet prepare_contacts(std::span<const Contact> contacts, const Part& part,
                            std::span<const double> mass, double dt, const ContactOptions& options);

struct ToolMotion {
  Pose pose;
  Vec3 velocity = Vec3::Zero();          // of the frame's origin [m/s]
  Vec3 angular_velocity = Vec3::Zero();  // [rad/s]
};

// Adds the forces of one substep to `force` (n_owned * 3), in the set's order. X (n_nodes, global
// reference), u, v (n_local * 3). tools: pose and twist of each at this time. reaction[k]
// (n_items): force of the tissue on the tool, zero where not counted here [N].
//   gap = n·(x_c - p), x_c = sum w (X + u), p and n carried by the tool
//   f_n = k min(max(0, -gap), depth), f_t = -min(mu f_n, c |v_t|) v_t / |v_t|, v_t the tangential
//   velocity of tissue relative to the tool. A contact that sticks creeps with f_t / c: this law
//   has no memory.
void add_contact_force(const ContactSet& set, const Part& part, std::span<const Vec3> X,
                       std::span<const double> u, std::span<const double> v,
                       std::span<const ToolMotion> tools, const ContactOptions& options,
                       std::span<double> force, std::span<Vec3> reaction);

}  // namespace trocar
