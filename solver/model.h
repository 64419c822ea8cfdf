// What is constant between cuts: element blocks with reference gradients, lumped masses, supports.
// Built from the mesh and this rank's part of it; only owned nodes are integrated, halo nodes are
// read.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/aligned_vector.h"
#include "base/sort_unique.h"
#include "mesh/partition.h"
#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/material.h"
#include "solver/viscous_step.h"

namespace trocar {

// Components of a node that a support holds: bit 0 x, bit 1 y, bit 2 z.
using FixedMask = std::uint8_t;
constexpr FixedMask all_components = 7;

struct SolverOptions {
  double mass_damping = 0;      // alpha of C = alpha M [1/s]
  double hourglass = 0.15;      // c_mu of k = c_mu mu V sum|B|^2 / 8 (hourglass.h), hex8
  double thickness = 1e-3;      // of plane meshes [m]
  Vec3 gravity = Vec3::Zero();  // [m/s^2]
  Precision precision = Precision::in_double;
  // Stiffness of an element's own volume change over mu, of viscoelastic tissue over what is left
  // of it, tet4_nodal_pressure: its share s in the pressure is this over K / mu, at most 1. A share
  // that did not fall with mu / K would lock nearly incompressible tissue. Free cubes show no low
  // modes even without it.
  double own_volume_stiffness = 0.2;
  // How triangles, tetrahedra and hexahedra are computed.
  Formulation tri3 = Formulation::tri3_plane_strain;
  Formulation tet4 = Formulation::tet4;
  Formulation hex8 = Formulation::hex8_one_point;
};

// All elements of one formulation and region on this rank, ascending global number, padded to whole
// blocks with the corners of the last one and constants of zero (which make no force).
struct ElementBlocks {
  Formulation formulation = Formulation::tet4;
  Precision precision = Precision::in_double;
  std::int32_t region = 0;  // index of its material
  MaterialModel material = MaterialModel::neo_hookean;
  double stiffening_at_rest = 1;  // in element_step already (material_setup.h)
  std::int32_t n_elements = 0;
  std::int32_t n_blocks = 0;
  int lanes = 0;                            // of a block, 64 bytes' worth of the precision
  std::vector<std::int32_t> element_local;  // (n_blocks * lanes) position in Part::element_global
  std::vector<std::int32_t> corner;         // [block][corner][lane] local node
  // Where corner forces are added in Scratch::sum if not all of a block's are at their nodes:
  // [such block][corner][lane], and (n_blocks) which one a block is, -1: none; empty: none is one.
  std::vector<std::int32_t> target, target_block;
  std::vector<std::uint32_t> row;  // (n_blocks * lanes / row_lanes) of row_order.h
  // (n_blocks) where nodal fields lie by component, see node_layout.h; else empty
  std::vector<std::uint32_t> row_break;
  std::int32_t n_aligned = 0;  // blocks there that are boxes along the axes
  // [block][corner] of blocks in such rows: the first lane's node, and its target (empty: its node)
  std::vector<std::int32_t> row_start, row_target;
  // [block][value][lane], see block_data.h; the one of the list's precision, the other is empty.
  AlignedVector<double> data;
  AlignedVector<float> data_single;
  std::vector<PronyBranch> prony;  // of the material; empty: no viscosity
  std::int64_t first_history = 0;  // history of these blocks starts here in State::history
  // Elements that average volume changes: their field of VolumeAverages, and where the lanes of
  // these blocks start in Scratch::volume_change.
  std::int32_t field = 0;
  std::int64_t first_lane = 0;
};

// Volume changes averaged around nodes (element_tet4_nodal_pressure.h), one field for each region
// with elements that do so; no fields if the model has none. Item i * n_fields + field is node i's.
struct VolumeAverages {
  std::int32_t n_fields = 0;         // the same on all ranks
  std::int64_t n_lanes = 0;          // of the lists concerned
  std::vector<std::int64_t> offset;  // (n_owned * n_fields + 1) into lane
  std::vector<std::int32_t> lane;    // of Scratch::volume_change, ascending global element number
  std::vector<double> stiffness;     // (n_owned * n_fields) sum of K V [J]; 0: no such element
  std::vector<double> share;         // (n_fields) s of element_tet4_nodal_pressure.h
};

// Blocks that a run (SumOrder) takes between two looks at the nodes: a stride.
inline constexpr std::int64_t stride_blocks = 32;

// What a stride reads of displacements by component; `halo` is empty where it would lie behind
// `own`, which has it then.
struct StrideNodes {
  NodeRange own, halo;
  bool operator==(const StrideNodes&) const = default;
};

// Where a run's displacements by component begin in Scratch::u_by_component, and the node that they
// begin with, if they are of all its nodes and don't slide.
struct ComponentWindow {
  static constexpr std::int32_t slides = -1;
  std::int64_t at = 0;
  std::int32_t first_node = slides;
  bool operator==(const ComponentWindow&) const = default;
};

struct BlockPlace {
  std::size_t list = 0;
  std::int32_t block = 0;  // of the list
  auto operator<=>(const BlockPlace&) const = default;
};

// Where corner forces are added up: at their node in the order of the elements. Threads take runs
// of blocks (counted through all lists). At a node that several runs meet, the first corners of the
// order are added at the node as long as they are of one run; the others get a place each behind
// the nodes, and are added up afterwards, in the same order. So the bits don't depend on the number
// of runs.
struct SumOrder {
  std::int32_t n_runs = 0;
  std::vector<std::int64_t> run_block;   // (n_runs + 1) first block of each run
  std::vector<std::int32_t> run_stride;  // (n_runs + 1) first stride of each run
  // Blocks that read halo nodes, ascending; and strides of a single run before the first of them.
  std::vector<BlockPlace> halo_block;
  std::int32_t n_strides_before_halo = 0;
  std::int64_t n_places = 0;  // of Scratch::sum, nodes first
  // Owned nodes that one run alone meets and reads, ascending by the stride that finishes them,
  // then by number: the last one that touches them, or the run's last one (sum_order.cpp).
  std::vector<std::int32_t> node;
  std::vector<std::int32_t> stride_first;  // (n_strides + 1) into node
  // Owned nodes that several runs meet or, by component, read; ascending.
  std::vector<std::int32_t> shared_node;
  // (n_places - n_local) nodes of the places behind the nodes, in slots that are added up one after
  // the other: n_slots of owned nodes, then those of halo nodes, ascending in each. Nodes that
  // follow each other so have places that do, for the rows of row_order.h.
  std::vector<std::int32_t> place_node;
  std::int32_t n_slots = 0;
  std::vector<std::int32_t> slot_first;  // into place_node, and its end
  std::vector<BlockPlace> place_block;   // with corners that have places; ascending
  // Where sums lie component by component: of each stride, and of each run and the end.
  std::vector<StrideNodes> stride_nodes;
  std::vector<ComponentWindow> window;
};

// Nodes of elements whose mass is scaled, in groups that hang together (mass_scaling.h). Each group
// has one owner; empty where no mass is scaled.
struct MassClusters {
  std::vector<std::int32_t> offset = {0};  // (n_clusters + 1) into node
  std::vector<std::int32_t> node;          // local, ascending in each cluster
  std::vector<double> added;               // (node.size()) d [kg]
  std::vector<double> total;               // (n_clusters) sum of d [kg]
  std::vector<std::int32_t> of_node;       // (n_owned) cluster or -1; empty without clusters
};

// The lane of an element (position in Part::element_global), counted through all blocks of a list;
// -1 if it is of another one.
inline std::int32_t lane_of(const ElementBlocks& blocks, std::int64_t element) {
  const std::span lanes(blocks.element_local);
  return find_in(lanes.first(static_cast<std::size_t>(blocks.n_elements)),
                 static_cast<std::int32_t>(element));
}

// Where a lane's numbers begin in an array [block][number][lane] of n numbers a lane; the next ones
// follow at a distance of `lanes`.
constexpr std::int64_t first_of_lane(std::int64_t lane, std::int64_t lanes, std::int64_t n) {
  return lane / lanes * lanes * n + lane % lanes;
}

struct Model {
  std::int32_t n_local = 0, n_owned = 0;
  std::vector<double> mass;     // (n_owned) what gravity acts on [kg]
  std::vector<double> inertia;  // (n_owned) mass and d of clusters; empty without, see inertia_of
  MassClusters clusters;
  std::vector<FixedMask> fixed;  // (n_owned)
  // Whether what kernels add to and take from nodes lies component by component, and not node by
  // node: where most hexahedra stand in rows, whole registers are added and loaded so.
  bool is_by_component = false;
  // Reference positions less the least of the mesh, (n_local * 4) with a zero, or (3 x
  // component_stride(n_local)) by component, for elements that make their gradients of them
  // (element_hex8.h); empty if there are none. [m]
  AlignedVector<float> position;
  // One a (region, formulation), in this order, which is that of the sums.
  std::vector<ElementBlocks> blocks;
  SumOrder sums;
  // (n local elements) stable step of the undeformed element (element_setup.h) [s]
  std::vector<double> element_step;
  std::int64_t n_history = 0;  // numbers of State::history
  VolumeAverages averages;
  SolverOptions options;
};

// From component to component of n numbers: a row that begins among them may be read whole.
constexpr std::int64_t component_stride(std::int64_t n) {
  constexpr std::int64_t line = 8;
  return (n + 2 * line - 1) / line * line;
}

inline bool is_fixed(const Model& model, std::int64_t owned, int direction) {
  return (model.fixed[owned] >> direction & 1) != 0;
}

// (n_owned) what a node resists acceleration with [kg]
inline const std::vector<double>& inertia_of(const Model& model) {
  return model.inertia.empty() ? model.mass : model.inertia;
}

// materials (n_regions of the mesh); fixed (n_nodes, global); mass (n_nodes, global) from
// lumped_mass.
Model build_model(const Mesh& mesh, const Part& part, std::span<const Material> materials,
                  std::span<const FixedMask> fixed, std::span<const double> mass,
                  const SolverOptions& options);

// An element of the undeformed mesh.
struct RestingElement {
  std::int32_t number = 0;
  double step = 0;  // element_step; 0 where the element is broken [s]
  double mass = 0;  // [kg]
};
RestingElement resting_element(const Mesh& mesh, std::span<const Material> materials,
                               const SolverOptions& options, std::int32_t number);
// All elements of the mesh, in parallel.
std::vector<RestingElement> resting_elements(const Mesh& mesh, std::span<const Material> materials,
                                             const SolverOptions& options);
// `resting` of all elements, to what it is after an edit of `elements`, those that it added among
// them.
void edit_resting_elements(const Mesh& mesh, std::span<const Material> materials,
                           const SolverOptions& options, std::span<const std::int32_t> elements,
                           std::vector<RestingElement>& resting);

// A node whose acceleration is given: something holds it.
struct GivenAcceleration {
  std::int32_t node = 0;  // local, owned
  Vec3 a = Vec3::Zero();  // [m/s^2]
};

// What a step changes. Halo nodes hold what their owners sent. [m], [m/s], [s]
struct State {
  std::vector<double> u;  // (n_local * 3) displacement at `time`
  std::vector<double> v;  // (n_local * 3) velocity half a step earlier
  // (n_local * n_fields) averaged J - 1 of VolumeAverages, see average_volume_change
  std::vector<double> theta;
  double time = 0;
  double last_dt = 0;  // length of the last step, 0 before the first
  std::int64_t step = 0;
  // [block][number][lane] of each viscoelastic list: of all points (viscosity.h) [J], then of
  // hourglass displacements (hourglass_history.h) [m]; at history_time [s]
  std::vector<double> history;
  double history_time = 0;
};
State make_state(const Model& model);

// Neither saved nor shown. Allocated once a model.
struct Scratch {
  // (n_places * 4) corner forces of each place of SumOrder, or (3 x component_stride(n_places)) by
  // component, all zero between steps; the one of the model's precision, the other is empty. [N]
  AlignedVector<double> sum;
  AlignedVector<float> sum_single;
  // Displacements by component, of a window of the nodes of each run, run after run [m]
  AlignedVector<double> u_by_component;
  std::vector<double> volume_change;  // K V (J - 1) of lanes, see VolumeAverages [J]
  std::vector<double> force;          // (n_owned * 3) external - internal force [N]
  // Whether `force` is known to be find_force's of the present displacement, so that the next step
  // need not compute it; whoever moves nodes or adds to `force` says no.
  bool has_force = false;
  // Of keep_works, (n_owned * 3) and added up by integrate; without it, and what a model has no use
  // for, empty.
  bool keeps_works = false;
  std::vector<double> swept;          // squared velocity times time [m^2/s], for find_damping_work
  std::vector<double> viscous_work;   // of `viscous_force` [J]
  std::vector<double> viscous_force;  // of find_viscous_force [N]
  std::vector<double> middle;         // velocities in the middle of the last step [m/s]
  std::vector<double> cluster_work;   // (n_owned) taken by damping of what clusters add [J]
  // Of held nodes in clusters, and room for sums of clusters; used by integrate.
  std::vector<GivenAcceleration> given;
  std::vector<double> cluster_sums;
  bool is_beyond_cache = false;      // see prefetch.h
  std::vector<double> uncoupled;     // force, while predict couples clusters
  std::vector<ViscousStep> viscous;  // (block lists) of the step that is being computed
  bool is_elastic = false;           // leaves relaxation out and the history alone
  // Empty, or (blocks through all lists) 1: all its nodes have zero velocity and nobody asks for
  // their forces, so that it is left out.
  std::vector<std::uint8_t> is_asleep;
};
Scratch make_scratch(const Model& model);

// Owned nodes on which more than elements and supports at rest acts in a step.
struct WaitingNodes {
  std::vector<std::int32_t> node;  // ascending
  std::vector<std::uint8_t> mask;  // (n_owned) NodeMotion::fixed with them; empty without any
};
// From now on integrate adds up what mass damping takes from each owned node, and what relaxation
// does if there is any.
void keep_works(const Model& model, Scratch& scratch);
// After an edit: what the next step reads of places that are new is zero.
void fit_scratch(const Model& model, Scratch& scratch);

}  // namespace trocar
