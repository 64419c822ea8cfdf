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

inline std::size_t to_size(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// n·(extra displacement of x) >= lack.
struct ContactConstraint {
  std::int32_t item = 0;
  std::array<std::int32_t, 3> place{};
  std::array<double, 3> weight{};
  Vec3 normal, slip;     // n; slip of the step without contact [m]
  double lack = 0;       // [m]
  double felt_mass = 0;  // 1 / sum w^2 / m [kg]
  // Impulse times dt, along n, and its bound: a triangle with two held corners would move the third
  // one a thousand times as far as it lacks. [kg m]
  double push = 0, most_push = 0;
  Vec3 drag = Vec3::Zero();
};

// Which item says most of a node, and what.
struct DeepestPiece {
  std::int32_t item = -1;
  NodeTouch touch;
};

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
  // Of the step that is being solved; steps allocate nothing.
  std::vector<ContactConstraint> constraints;  // with room for one an item and one a node
  std::vector<DeepestPiece> deepest;           // (node.size())
  std::vector<Vec3> move;                      // (node.size()) [m]
};

// contacts: all of them, on every rank. node_owner, mass [kg], is_held (nothing moves the node):
// (n_nodes) global.
ContactSet prepare_contacts(std::span<const Contact> contacts,
                            std::span<const std::int32_t> node_owner, const Part& part, int rank,
                            std::span<const double> mass, std::span<const std::uint8_t> is_held);

}  // namespace trocar
