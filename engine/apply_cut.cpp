#include "engine/apply_cut.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "base/log.h"
#include "engine/apply_cut_patch.h"
#include "engine/apply_cut_topology.h"
#include "engine/frame_watch.h"
#include "engine/mesh_measures.h"
#include "mesh/quality.h"
#include "solver/history.h"

namespace trocar {

namespace {

// Mass, momentum and angular momentum about `centre` of some nodes.
struct Motion {
  double mass = 0, scale = 0, kinetic = 0;  // scale = sum |m v|
  Vec3 centre = Vec3::Zero(), momentum = Vec3::Zero(), angular = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
};

Motion motion_of(std::span<const std::int32_t> nodes, std::span<const double> mass,
                 const GlobalState& state, const Vec3& about) {
  Motion motion;
  for (const std::int32_t node : nodes) {
    const auto i = static_cast<std::size_t>(node);
    const Vec3 v(state.v[3 * i], state.v[3 * i + 1], state.v[3 * i + 2]);
    const Vec3 r = state.x[i] - about;
    motion.mass += mass[i];
    motion.centre += mass[i] * state.x[i];
    motion.momentum += mass[i] * v;
    motion.angular += mass[i] * r.cross(v);
    motion.scale += mass[i] * std::sqrt(v.dot(v));
    motion.kinetic += 0.5 * mass[i] * v.dot(v);
    motion.inertia += mass[i] * (r.dot(r) * Mat3::Identity() - r * r.transpose());
  }
  if (motion.mass > 0) motion.centre /= motion.mass;
  return motion;
}

// Gives the nodes the rigid increment a + w x (x - centre) that makes momentum and angular momentum
// what they were.
void restore_momentum(std::span<const std::int32_t> nodes, std::span<const double> mass,
                      const Motion& before, GlobalState& state, CutRecord& record) {
  const Vec3 about = before.centre;
  Motion after = motion_of(nodes, mass, state, about);
  const double kinetic_before = before.kinetic;
  // Two unknown vectors: m a + w x m d = dP and m d x a + I w = dL with d = centre after - about.
  const Vec3 d = after.centre - about;
  Mat3 cross;
  cross << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
  Eigen::Matrix<double, 6, 6> A;
  A.block<3, 3>(0, 0) = after.mass * Mat3::Identity();
  A.block<3, 3>(0, 3) = -after.mass * cross;
  A.block<3, 3>(3, 0) = after.mass * cross;
  A.block<3, 3>(3, 3) = after.inertia;
  Eigen::Matrix<double, 6, 1> b;
  b << before.momentum - after.momentum, before.angular - after.angular;
  const Eigen::Matrix<double, 6, 1> increment = A.partialPivLu().solve(b);
  const Vec3 a = increment.head<3>(), w = increment.tail<3>();
  if (!increment.allFinite()) return;
  for (const std::int32_t node : nodes) {
    const auto i = static_cast<std::size_t>(node);
    const Vec3 dv = a + w.cross(state.x[i] - about);
    for (std::size_t k = 0; k < 3; ++k) state.v[3 * i + k] += dv[static_cast<Eigen::Index>(k)];
  }
  after = motion_of(nodes, mass, state, about);
  const double scale = std::max(before.scale, 1e-300);
  record.momentum_change =
      std::max(record.momentum_change, (after.momentum - before.momentum).norm() / scale);
  record.kinetic_energy_change += after.kinetic - kinetic_before;
}

double least_element_step(const Simulation& s, std::span<const std::int32_t> elements) {
  double least = 1e300;
  for (const std::int32_t e : elements)
    if (const std::int64_t k = s.part.place_of(e); k >= 0)
      least = std::min(least, s.model.element_step[static_cast<std::size_t>(k)]);
  return s.communicator->all_min(least);
}

double mass_of(std::span<const std::int32_t> nodes, std::span<const double> mass) {
  ExactSum sum;
  for (const std::int32_t i : nodes) sum.add(mass[static_cast<std::size_t>(i)]);
  return sum.value();
}

std::vector<std::int32_t> united(std::span<const std::int32_t> a, std::span<const std::int32_t> b) {
  std::vector<std::int32_t> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

// Elements that an edit touches, before and after it: a hexahedron may have become tetrahedra.
struct EditedElements {
  std::vector<std::int32_t> before, after;  // ascending
  std::vector<double> volume;               // of `before`, before the edit [m^3]
  std::vector<std::int32_t> parent;         // (n_elements after); empty: no element was split
};

EditedElements find_edited(const Mesh& mesh, const NodeCorners& corners, const MeshEdit& edit) {
  EditedElements edited;
  if (edit.splits.empty()) {
    edited.before = edited.after = edited_elements(corners, edit);
  } else {
    edited.before = edited_elements(mesh, edit);
    edited.parent = element_parents(mesh, edit);
    for (std::size_t e = 0; e < edited.parent.size(); ++e)
      if (std::binary_search(edited.before.begin(), edited.before.end(), edited.parent[e]))
        edited.after.push_back(static_cast<std::int32_t>(e));
  }
  for (const std::int32_t e : edited.before)
    edited.volume.push_back(element_volume(mesh, e, mesh.X));
  return edited;
}

// What an element's history comes from, behind the edit.
struct HistorySource {
  std::vector<double> copies;        // of all elements before the edit; empty without viscosity
  std::vector<std::int32_t> parent;  // (n_elements)
  // (n_elements) Volumes over those of the elements that they were or were parts of; 1 where the
  // edit left them.
  std::vector<double> scale;
};

void find_parents(const Mesh& after, const EditedElements& edited, HistorySource& history) {
  if (history.copies.empty()) return;
  history.parent = edited.parent;
  if (history.parent.empty()) {
    history.parent.resize(after.element_type.size());
    std::iota(history.parent.begin(), history.parent.end(), 0);
  }
  history.scale.assign(after.element_type.size(), 1.0);
  for (const std::int32_t e : edited.after) {
    const auto k = static_cast<std::size_t>(e);
    const auto at = std::lower_bound(edited.before.begin(), edited.before.end(), history.parent[k]);
    history.scale[k] = element_volume(after, e, after.X) /
                       edited.volume[static_cast<std::size_t>(at - edited.before.begin())];
  }
}

// What is known of the body before an edit and holds for most of it behind it.
struct Known {
  Watch watch;
  bool is_looked_at = false;
  std::int64_t at_step = 0;
};

void restore_known(std::span<const std::int32_t> element_parent, const Known& known,
                   Simulation& s) {
  s.look.is_done = known.is_looked_at;
  s.look.at_step = known.at_step;
  s.watch = known.watch;
  for (std::int32_t* element : {&s.watch.stable_element, &s.watch.least_J_element})
    if (*element >= 0 && !element_parent.empty())
      *element = static_cast<std::int32_t>(
          std::lower_bound(element_parent.begin(), element_parent.end(), *element) -
          element_parent.begin());
}

// Whether the step is known from what is around the edit and what was known of the rest.
bool keeps_step(const Simulation& s) {
  return s.look.is_done && s.watch.is_finite && s.watch.least_J > 0 && !s.scene.solver.is_multirate;
}

// Supports and partner pairs go with the nodes.
void inherit_by_duplicates(Simulation& s, const MeshEdit& edit, std::int32_t n_before) {
  for (std::size_t d = 0; d < edit.duplicate_parent.size(); ++d) {
    const std::int32_t parent = edit.duplicate_parent[d];
    s.fixed.push_back(s.fixed[static_cast<std::size_t>(parent)]);
    s.duplicate_parent.push_back(parent);
    s.duplicate_node.push_back(n_before + static_cast<std::int32_t>(d));
  }
}

// Hexahedra that became tetrahedra take longer: beyond this, owners are chosen anew. METIS takes
// about as long as 100 steps; a tenth of the steps that follow is more within half a second.
constexpr double tolerated_imbalance = 1.1;

void rebalance(Simulation& s) {
  const double now = imbalance(s.mesh, s.node_owner, s.communicator->size());
  if (now <= tolerated_imbalance) return;
  s.node_owner = partition_nodes(s.mesh, *s.communicator);
  log_info("after a cut the busiest rank has " + std::to_string(std::lround(100 * (now - 1))) +
           " % more work than the mean: parts are chosen anew");
}

// All that every rank holds of the whole body; returns keeps_places.
bool edit_whole(const MeshEdit& edit, GlobalState& global, Simulation& s) {
  const std::int32_t n_before = s.mesh.n_nodes();
  apply_edit(edit, s.mesh, 3, global.u);
  apply_edit(edit, s.mesh, 3, global.v);
  inherit_by_duplicates(s, edit, n_before);
  apply_edit_to_owners(edit.duplicate_parent, s.node_owner);
  apply_edit_to_holds(edit, n_before, s.holds);
  const bool is_local = keeps_places(s, edit);
  if (edit.splits.empty()) apply_edit(edit, s.mesh, s.corners);
  apply_edit(edit, s.mesh);
  if (!edit.splits.empty()) {
    s.corners = node_corners(s.mesh);
    rebalance(s);
  }
  global.x = present_positions(s.mesh.X, global.u);
  return is_local;
}

// Of the edited elements and their nodes; the energy is the body's.
struct Before {
  Motion motion;
  double least_step = 0, mass = 0, energy = 0;
};

Before measure_before(Simulation& s, std::span<const std::int32_t> elements,
                      std::span<const std::int32_t> nodes, const GlobalState& global) {
  const Vec3 centre = motion_of(nodes, s.mass, global, Vec3::Zero()).centre;
  return {.motion = motion_of(nodes, s.mass, global, centre),
          .least_step = least_element_step(s, elements),
          .mass = mass_of(nodes, s.mass),
          .energy = s.energy ? mechanical_energy(s).sum() : 0};
}

void add_to_record(Simulation& s, const Before& before, std::span<const std::int32_t> elements,
                   std::span<const std::int32_t> nodes, CutRecord& record) {
  if (s.energy) s.energy->memory.works.cut += mechanical_energy(s).sum() - before.energy;
  for (const std::int32_t e : elements)
    record.least_quality = std::min(record.least_quality, element_quality(s.mesh, e, s.mesh.X));
  record.stable_step_ratio =
      std::min(record.stable_step_ratio, least_element_step(s, elements) / before.least_step);
  const double mass_change = std::abs(mass_of(nodes, s.mass) - before.mass);
  record.mass_change = std::max(record.mass_change,
                                mass_change / std::accumulate(s.mass.begin(), s.mass.end(), 0.0));
}

}  // namespace

std::vector<double> gather_owned(const Simulation& s, std::span<const double> owned) {
  if (s.communicator->all_max(owned.empty() ? 0 : 1) == 0) return {};
  return all_gather_field(s.part, s.mesh.n_nodes(), 3, owned, *s.communicator);
}

std::vector<double> of_owned(std::span<const double> field, const Part& part) {
  std::vector<double> mine;
  for (std::int32_t i = 0; i < part.n_owned && !field.empty(); ++i) {
    const auto at = field.subspan(3 * static_cast<std::size_t>(part.node_global[i]), 3);
    mine.insert(mine.end(), at.begin(), at.end());
  }
  return mine;
}

GlobalState gather_state(Simulation& s) {
  const PhaseScope scope(s.timers, phase_gather);
  GlobalState global;
  global.u = all_gather_field(s.part, s.mesh.n_nodes(), 3, s.state.u, *s.communicator);
  global.v = all_gather_field(s.part, s.mesh.n_nodes(), 3, s.state.v, *s.communicator);
  global.x = present_positions(s.mesh.X, global.u);
  return global;
}

void scatter_state(Simulation& s, const GlobalState& global) {
  State state = make_state(s.model);
  state.time = s.state.time;
  state.last_dt = s.state.last_dt;
  state.step = s.state.step;
  state.history_time = s.state.history_time;
  for (std::size_t i = 0; i < s.part.node_global.size(); ++i) {
    const auto g = static_cast<std::size_t>(s.part.node_global[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      state.u[3 * i + k] = global.u[3 * g + k];
      state.v[3 * i + k] = global.v[3 * g + k];
    }
  }
  s.state = std::move(state);
}

void apply_cut(Simulation& s, const MeshEdit& edit, GlobalState& global, CutRecord& record) {
  if (s.corners.first.empty()) s.corners = node_corners(s.mesh);
  const EditedElements edited = find_edited(s.mesh, s.corners, edit);
  std::vector<std::int32_t> nodes = nodes_of(s.mesh, edited.before);
  const Before before = measure_before(s, edited.before, nodes, global);
  HistorySource history{.copies =
                            s.communicator->all_gather(copy_history(s.model, s.part, s.state))};
  const Known known{s.watch, s.look.is_done, s.look.at_step};
  const bool is_step_local = keeps_step(s);

  const bool is_local = edit_whole(edit, global, s);
  nodes = united(nodes, nodes_of(s.mesh, edited.after));
  if (is_local)
    update_topology(s, edited.after, nodes);
  else
    rebuild_topology(s);
  restore_momentum(nodes, s.mass, before.motion, global, record);
  scatter_state(s, global);
  find_parents(s.mesh, edited, history);
  restore_history(s.model, s.part, history.copies, history.parent, history.scale, s.state);
  if (is_step_local) {
    restore_known(edited.parent, known, s);
    watch_edit(s, edited.after, {global, history.copies, history.parent, history.scale});
    if (s.energy) update_volume_change(s.model, s.neighbours, s.state, s.scratch);
  } else {
    watch_state(s);
  }
  add_to_record(s, before, edited.after, nodes, record);
  s.log.new_edits.push_back({.frame = s.frame, .edit = edit});
}

}  // namespace trocar
