#include "engine/apply_cut.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/sort_unique.h"
#include "engine/apply_cut_energy.h"
#include "engine/apply_cut_momentum.h"
#include "engine/apply_cut_topology.h"
#include "engine/frame_watch.h"
#include "engine/owners.h"
#include "engine/patch.h"
#include "mesh/quality.h"

namespace trocar {

namespace {

constexpr double tolerated = 0.005;  // of the edited elements' strain energy

double least_element_step(const Simulation& s, std::span<const std::int32_t> elements) {
  double least = 1e300;
  for (const std::int32_t e : elements)
    if (const std::int64_t k = s.part.place_of(e); k >= 0)
      least = std::min(least, s.model.element_step[k]);
  return s.communicator->all_min(least);
}

double mass_of(std::span<const std::int32_t> nodes, std::span<const double> mass) {
  ExactSum sum;
  for (const std::int32_t i : nodes) sum.add(mass[i]);
  return sum.value();
}

// Elements that an edit touches, before and after it: a hexahedron may have become tetrahedra.
struct EditedElements {
  std::vector<std::int32_t> before, after;  // ascending
  std::vector<double> volume;               // of `before`, before the edit [m^3]
};

EditedElements find_edited(const Mesh& mesh, const NodeCorners& corners, const MeshEdit& edit,
                           const SplitNumbers& numbers) {
  EditedElements edited{.before = edited_elements(mesh, corners, edit), .after = {}, .volume = {}};
  edited.after = numbers.all_after(edited.before);
  for (const std::int32_t e : edited.before)
    edited.volume.push_back(element_volume(mesh, e, mesh.X));
  return edited;
}

std::vector<std::int32_t> hosts_of(const MeshEdit& edit) {
  std::vector<std::int32_t> hosts;
  for (const NodeMove& move : edit.moves) hosts.push_back(move.host);
  sort_unique(hosts);
  return hosts;
}

// Whether the step is known from what is around the edit and what was known of the rest.
bool keeps_step(const Simulation& s) {
  return s.look.is_done && s.watch.is_finite && s.watch.least_J > 0;
}

// Makes all anew, for example as parts change; returns what update_topology would: ranks must not
// matter.
bool rebuild_all(std::span<const std::int32_t> nodes, Simulation& s) {
  if (!s.local_steps) {
    rebuild_topology(s);
    return true;
  }
  const MultiRatePlan before = s.local_steps->plan;
  const LocalStepVerdict verdict = local_step_verdict(s);
  rebuild_topology(s);
  return keep_local_steps(before, verdict, nodes, s);
}

// Whether an edit changes no energies but those around it.
bool keeps_energy(const Simulation& s) {
  return !s.multirate;
}

// Supports and partner pairs go with the nodes; on an edge a node is held as far as both ends are.
void inherit_by_new_nodes(Simulation& s, const MeshEdit& edit, std::int32_t n_before) {
  const auto fixed = [&](std::int32_t i) { return s.fixed[i]; };
  for (const EdgeNode& node : edit.inserted)
    s.fixed.push_back(static_cast<FixedMask>(fixed(node.end[0]) & fixed(node.end[1])));
  const auto first = n_before + static_cast<std::int32_t>(edit.inserted.size());
  for (std::size_t d = 0; d < edit.duplicate_parent.size(); ++d) {
    const std::int32_t parent = edit.duplicate_parent[d];
    s.fixed.push_back(fixed(parent));
    s.duplicate_parent.push_back(parent);
    s.duplicate_node.push_back(first + static_cast<std::int32_t>(d));
  }
}

// mesh: after the edit.
void move_positions(const MeshEdit& edit, const Mesh& mesh, GlobalState& global) {
  const std::size_t n_before = global.x.size();
  global.x.resize(mesh.X.size());
  global.is_known.resize(mesh.X.size(), 1);
  const auto place = [&](std::size_t i) { global.x[i] = mesh.X[i] + Vec3::Map(&global.u[3 * i]); };
  for (const NodeMove& move : edit.moves) place(static_cast<std::size_t>(move.node));
  for (std::size_t i = n_before; i < global.x.size(); ++i) {
    place(i);
    global.known.push_back(static_cast<std::int32_t>(i));
  }
}

// All nodes that the edited elements have before the edit, and those that they will get of them.
std::vector<std::int32_t> old_nodes(const Mesh& mesh, std::span<const std::int32_t> nodes,
                                    const MeshEdit& edit) {
  std::vector<std::int32_t> all(nodes.begin(), nodes.end());
  for (const CornerChange& change : edit.corners)
    if (change.node < mesh.n_nodes()) all.push_back(change.node);
  sort_unique(all);
  return all;
}

// Energy of the body, but for a constant that the edit leaves as it is; 0 without a ledger. [J]
// Collective.
double energy_around(Simulation& s, bool is_local, std::span<const std::int32_t> nodes,
                     GlobalState& global) {
  if (!s.energy) return 0;
  return is_local ? patch_energy(s, nodes, {.global = global}) : mechanical_energy(s).sum();
}

// An edit, and what is around it before it is made.
struct Before {
  const MeshEdit& edit;
  SplitNumbers numbers;
  EditedElements edited;
  std::vector<std::int32_t> nodes = {};         // corners of the edited elements
  std::vector<std::int32_t> with_history = {};  // elements whose history must go over
  std::vector<std::int32_t> adjustable = {};    // see adjustable_nodes
  Motion motion = {};                           // of `nodes`
  double mass = 0, least_step = 0;              // the same [kg]; of the edited elements [s]
  double strain = 0, energy = 0;                // see make_strained_patch, energy_around [J]
  bool is_energy_local = false;
  // Of the body, and what holds for most of it behind the edit, too.
  std::int32_t n_elements = 0;
  std::size_t n_owned = 0;  // nodes of this rank
  Watch watch = {};
  std::int64_t last_search = 0;  // its step
  bool is_step_known = false;    // from what is around the edit and the watch
};

// global: gets what is around the edit. Collective.
Before measure_before(Simulation& s, const MeshEdit& edit, GlobalState& global) {
  const SplitNumbers numbers(edit.splits, s.mesh.n_elements());
  Before before{edit, numbers, find_edited(s.mesh, s.corners, edit, numbers)};
  const std::vector<std::int32_t>& elements = before.edited.before;
  before.nodes = nodes_of(s.mesh, elements);
  find_nodes(s, united(before.nodes, nodes_of(s.mesh, hosts_of(edit))), *s.communicator, global);
  before.motion = motion_about_centre(before.nodes, s.mass, global);
  before.mass = mass_of(before.nodes, s.mass);
  before.least_step = least_element_step(s, elements);
  before.is_energy_local = keeps_energy(s);
  const std::vector<std::int32_t> all_nodes = old_nodes(s.mesh, before.nodes, edit);
  before.energy = energy_around(s, before.is_energy_local, all_nodes, global);
  before.strain = strain_energy(*make_strained_patch(s, edit, elements, all_nodes, global));
  if (is_viscous(s.materials)) before.with_history = elements_of_patch(s, all_nodes);
  before.adjustable = adjustable_nodes(s, edit);
  before.n_elements = s.mesh.n_elements();
  before.n_owned = static_cast<std::size_t>(s.part.n_owned);
  before.watch = s.watch;
  before.last_search = s.look.at_step;
  before.is_step_known = keeps_step(s);
  return before;
}

// All that every rank holds of the whole body; returns whether update_topology will do.
bool edit_whole(const Before& before, GlobalState& global, Simulation& s) {
  const MeshEdit& edit = before.edit;
  const std::int32_t n_before = s.mesh.n_nodes();
  apply_edit(edit, s.mesh, 3, global.u);
  apply_edit(edit, s.mesh, 3, global.v);
  inherit_by_new_nodes(s, edit, n_before);
  apply_edit_to_owners(edit, s.node_owner);
  apply_edit_to_holds(edit, n_before, s.holds);
  const bool is_local = keeps_owners(s, edit);
  apply_edit(edit, s.mesh, s.corners);
  apply_edit(edit, s.mesh);
  move_positions(edit, s.mesh, global);
  const bool has_new_owners = !edit.splits.empty() && rebalance(s);
  return is_local && !has_new_owners && follow_mass_scaling(before.edited.after, s);
}

// Copies of elements' history before an edit, none without viscosity, and where it goes.
struct CarriedHistory {
  std::vector<double> copies;
  ElementOrigins origins;
};

std::vector<std::int32_t> all_elements(std::int32_t n) {
  std::vector<std::int32_t> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// How much larger edited elements have become.
double scale_of(const Mesh& mesh, const EditedElements& edited, std::int32_t e,
                std::int32_t parent) {
  const std::int32_t at = find_in(edited.before, parent);
  return at < 0 ? 1 : element_volume(mesh, e, mesh.X) / edited.volume[at];
}

// When the mesh is edited, while part, model and state are those before it. Collective.
CarriedHistory carry_history(const Simulation& s, const Before& before, bool is_local) {
  if (!is_viscous(s.materials)) return {};
  const std::vector<std::int32_t> elements =
      is_local ? before.with_history : all_elements(before.n_elements);
  CarriedHistory history{
      .copies = s.communicator->all_gather(copy_history(s.model, s.part, s.state, elements)),
      .origins = {}};
  ElementOrigins& origins = history.origins;
  origins.element = before.numbers.all_after(elements);
  for (const std::int32_t e : origins.element) {
    origins.parent.push_back(before.numbers.whole(e));
    origins.scale.push_back(scale_of(s.mesh, before.edited, e, origins.parent.back()));
  }
  return history;
}

// Strain energy and motion around the edit, as they were. nodes: those of `before` and of after it,
// ascending. Returns what that took, with what the edit has changed of the energy if that is local.
// Collective.
TakenUp restore_energies(Simulation& s, const Before& before, std::span<const std::int32_t> nodes,
                         GlobalState& global, CutRecord& record) {
  const double tolerance = tolerated * before.strain;
  const double surplus = restore_strain_energy(
      before.adjustable, before.strain, tolerance, s.mesh,
      *make_strained_patch(s, before.edit, before.edited.after, nodes, global), global);
  restore_motion({nodes, before.adjustable, s.mass, s.fixed, s.holds.holds}, before.motion, global,
                 record);
  const double energy =
      before.is_energy_local ? energy_around(s, true, nodes, global) - before.energy : 0;
  TakenUp around = take_up_around(s, before.adjustable, surplus, tolerance, global, record);
  around.energy += energy;
  if (before.strain > 0)
    record.strain_energy_change =
        std::max(record.strain_energy_change, std::abs(around.surplus) / before.strain);
  return around;
}

void watch_around(Simulation& s, const Before& before, const CarriedHistory& history,
                  GlobalState& global) {
  s.look.at_step = before.last_search;
  s.watch = before.watch;
  watch_edit(s, before.edited.after, {global, history.copies, &history.origins});
  if (s.energy) update_volume_change(s.model, s.neighbours, s.state, s.scratch);
}

void add_to_record(const Simulation& s, const Before& before, std::span<const std::int32_t> nodes,
                   CutRecord& record) {
  const std::vector<std::int32_t>& elements = before.edited.after;
  for (const std::int32_t e : elements)
    record.least_quality = std::min(record.least_quality, element_quality(s.mesh, e, s.mesh.X));
  record.stable_step_ratio =
      std::min(record.stable_step_ratio, least_element_step(s, elements) / before.least_step);
  const double mass_change = std::abs(mass_of(nodes, s.mass) - before.mass);
  record.mass_change = std::max(record.mass_change, mass_change / s.whole_mass);
}

}  // namespace

void apply_cut(Simulation& s, const MeshEdit& edit, GlobalState& global, CutRecord& record) {
  if (s.corners.first.empty()) s.corners = node_corners(s.mesh);
  const Before before = measure_before(s, edit, global);
  const std::vector<std::int32_t>& elements = before.edited.after;
  const bool is_local = edit_whole(before, global, s);
  if (!is_local) find_all_nodes(s, global);
  const CarriedHistory history = carry_history(s, before, is_local);
  const std::vector<std::int32_t> nodes = united(before.nodes, nodes_of(s.mesh, elements));
  const bool keeps_local_steps =
      is_local ? update_topology(s, {edit.splits, elements, nodes}) : rebuild_all(nodes, s);
  const TakenUp around = restore_energies(s, before, nodes, global, record);
  const std::vector<std::int32_t> changed = united(nodes, around.nodes);
  if (!s.boxes.is_empty())
    update_element_boxes(s.mesh, global.x,
                         {edit.splits, changed, elements_around(s.corners, changed)}, s.boxes);
  if (is_local)
    scatter_edited(s, before.n_owned, changed, global);
  else
    scatter_state(s, global);
  restore_history(s.model, s.part, history.copies, history.origins, s.state);
  if (before.is_step_known && keeps_local_steps)
    watch_around(s, before, history, global);
  else
    watch_state(s);
  if (s.energy)
    s.energy->memory.works.cut += before.is_energy_local
                                      ? around.energy
                                      : energy_around(s, false, nodes, global) - before.energy;
  add_to_record(s, before, nodes, record);
  s.log.new_edits.push_back(edit);
}

}  // namespace trocar
