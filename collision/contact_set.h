// The contacts of a frame as the ranks that hold their nodes work on them: each of these ranks has
// all of them and all of their nodes, and finds the same forces.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collision/detector.h"
#include "mesh/partition.h"

namespace trocar {

struct ContactSet {
  struct Item {
    Contact contact;
    std::array<std::int32_t, 3> place{};  // of its corners in the nodes below
    bool is_near = true;                  // at the last look
    Vec3 reaction_sum = Vec3::Zero();     // on the tool, over the steps so far [N]
  };
  std::vector<Item> items;  // in the detector's order; empty on ranks without a node of theirs
  // Nodes of the items, ascending by global number.
  std::vector<std::int32_t> node;          // global numbers
  std::vector<double> inverse_mass;        // 0: nothing moves it [1/kg]
  std::vector<std::int32_t> owned, local;  // of owned ones: places here, and local numbers
  std::vector<Vec3> x_start, x_end;  // positions around the step, without contact at its end [m]
  std::vector<Vec3> force;           // of the last step [N]
  Halo halo;                         // among the ranks that hold nodes, in places
  bool is_counted_here = false;      // this rank reports the reactions
};

// contacts: all of them, on every rank. node_owner, mass [kg], is_held (nothing moves the node):
// (n_nodes) global.
ContactSet prepare_contacts(std::span<const Contact> contacts,
                            std::span<const std::int32_t> node_owner, const Part& part, int rank,
                            std::span<const double> mass, std::span<const std::uint8_t> is_held);

}  // namespace trocar
