// Nodes that move together, as selective mass scaling joins their masses: an impulse on one of them
// moves the others of its cluster. Each alone, a plate's nodes gave way more than contact thought,
// and tissue hovered off it by 0.4 F dt^2 / m.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/contact_constraint.h"

namespace trocar {

// With impulses f the nodes move by alone_i f_i + share_i yield sum_j share_j f_j. Of the nodes of
// a contact set, whose other inverse masses say what a node alone feels; empty: no masses are
// joined.
struct ContactClusters {
  std::vector<std::int32_t> of;      // (n_nodes) -1: in none
  std::vector<Vec3> share, alone;    // (n_nodes) 0 along held components; alone: [1/kg]
  std::vector<Vec3> yield, impulse;  // (n_clusters) [1/kg]; sum share f of the step [kg m]
  bool is_empty() const { return of.empty(); }
};

// By what an impulse of 1 on the contact point moves it beside what each of its nodes moves for
// itself, by component. [1/kg]
Vec3 yield_of_clusters(const ContactConstraint& c, const ContactClusters& clusters);
// Of the contact point by all impulses so far. [m]
Vec3 move_of_clusters(const ContactConstraint& c, const ContactClusters& clusters);
void add_to_clusters(const ContactConstraint& c, const Vec3& impulse, ContactClusters& clusters);

}  // namespace trocar
