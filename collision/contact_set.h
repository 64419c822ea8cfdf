// The contacts of a frame as the ranks that hold their nodes work on them: each of these ranks has
// all of them and all of their nodes, and finds the same forces.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collision/contact_clusters.h"
#include "collision/contact_constraint.h"
#include "collision/detector.h"
#include "collision/hull_manifold.h"
#include "collision/tissue_pairs.h"
#include "mesh/partition.h"

namespace trocar {

// Which item says most of a node, and what.
struct DeepestPiece {
  std::int32_t item = -1;
  NodeTouch touch;
};

// What may touch in a frame, on every rank, in the order of the detector.
struct FoundContacts {
  std::span<const Contact> with_tools;
  std::span<const TissuePair> with_tissue = {};
};

// What moves by an impulse on a node, (n_nodes) of the whole mesh.
struct ContactInertia {
  std::span<const double> mass;        // [kg]
  std::span<const std::uint8_t> held;  // components in which nothing moves it, bit 0 for x
  // Where masses are joined by selective scaling, the nodes of a cluster move together, too: with
  // impulses f, u_i = f_i / mass_i + share_i yield sum_j share_j f_j. Empty: none are.
  std::span<const std::int32_t> cluster;  // -1: in none
  std::span<const double> share;
  std::span<const Vec3> yield;  // (n_clusters) by component [1/kg]
};

struct ContactSet {
  struct Item {
    Contact contact;
    std::array<std::int32_t, 3> place{};   // of its corners in the nodes below
    std::array<std::int32_t, 3> beside{};  // of its corners in `beside`
    bool is_near = true;                   // at the last look
    // Of a hull's last look: the corners in the tool's frame, and how far it saw [m].
    std::array<Vec3, 3> seen{};
    double sight = -1;
    Manifold manifold;
    // On the tool and about its tip, over the steps so far. [N], [N m]
    Vec3 reaction_sum = Vec3::Zero(), torque_sum = Vec3::Zero();
  };
  struct TissueItem {
    std::array<std::int32_t, 4> place{};  // of the node and the corners of the triangle
    double handicap = 0;                  // TissuePair
    // Step of the frame and way of the set's nodes (`way`) before which they cannot meet.
    std::int64_t next_look = 0;
    double next_way = 0;  // [m]
  };
  // A corner of items of one piece of a tool: six or so of them have it.
  struct BesidePiece {
    std::int32_t item = 0;  // the first
    std::int32_t place = 0;
    // Where it would be at the end of the step if it moved with the tool, also in the tool's frame:
    // what presses against a tool lies on it there. [m]
    Vec3 x = Vec3::Zero(), local = Vec3::Zero();
    // At a blade, out of the tissue: area normals of the items that have it. Of those that face a
    // blade's flank, the first one's part along its normal; where others have the opposite sign,
    // the node is the front of a wound, and the blade thicker than that is wide. [m^2]
    Vec3 facing = Vec3::Zero();
    double lip = 0;
    bool is_front = false;
    std::optional<NodeTouch> touch;
  };
  // The pairs of one node: a run of `tissue`.
  struct TissueNode {
    std::size_t first = 0, end = 0;
    std::int64_t next_look = 0;  // the first of theirs
    double next_way = 0;         // the least of theirs [m]
  };
  // Between a node and the tissue that it lies on, of the last step of the frame: where the next
  // one begins.
  struct TissueImpulse {
    std::int64_t step = -1;
    double push = 0;           // as of ContactConstraint [kg m]
    Vec3 drag = Vec3::Zero();  // [kg m]
  };
  // In the detector's order; empty on ranks without a node of theirs.
  std::vector<Item> items;
  std::vector<TissueItem> tissue;
  std::vector<BesidePiece> beside;  // in the order of items
  std::vector<TissueNode> tissue_node;
  double way = 0;  // sum over the steps of the largest by which two nodes moved apart [m]
  // Nodes of the items, ascending by global number.
  std::vector<std::int32_t> node;  // global numbers
  std::vector<Vec3> inverse_mass;  // by component, 0: nothing moves it so [1/kg]
  ContactClusters clusters;
  std::vector<std::int32_t> owned, local;  // of owned ones: places here, and local numbers
  std::vector<Vec3> x_start, x_end;  // positions around the step, without contact at its end [m]
  std::vector<Vec3> force;           // of the last step [N]
  Halo halo;                         // among the ranks that hold nodes, in places
  bool is_counted_here = false;      // this rank reports the reactions on tools
  // Of the step that is being solved; steps allocate nothing.
  // With room for two a node, and of an item for its nearest point and its manifold.
  std::vector<ContactConstraint> constraints;
  std::vector<DeepestPiece> deepest;   // (node.size())
  std::vector<TissueImpulse> impulse;  // (node.size())
  // (node.size()) Of `tissue`, the pair by which a step has found the node in other tissue, the
  // last one; -1: none has.
  std::vector<std::int32_t> found_by;
  std::vector<Vec3> move;  // (node.size()) [m]
};

// node_owner: (n_nodes) global.
ContactSet prepare_contacts(const FoundContacts& contacts, std::span<const std::int32_t> node_owner,
                            const Part& part, const ContactInertia& inertia);

}  // namespace trocar
