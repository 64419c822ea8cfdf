#include "engine/apply_cut.h"

#include <algorithm>
#include <cmath>

#include "engine/frame_watch.h"
#include "engine/mesh_measures.h"
#include "mesh/quality.h"
#include "solver/frequency.h"
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

std::vector<std::int32_t> nodes_of(const Mesh& mesh, std::span<const std::int32_t> elements) {
  std::vector<std::int32_t> nodes;
  for (const std::int32_t e : elements)
    nodes.insert(nodes.end(), mesh.corners(e).begin(), mesh.corners(e).end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

double least_element_step(const Simulation& s, std::span<const std::int32_t> elements) {
  const std::vector<std::int32_t>& mine = s.part.element_global;
  double least = 1e300;
  for (const std::int32_t e : elements) {
    const auto at = std::lower_bound(mine.begin(), mine.end(), e);
    if (at != mine.end() && *at == e)
      least = std::min(least, s.model.element_step[static_cast<std::size_t>(at - mine.begin())]);
  }
  return s.communicator->all_min(least);
}

double total(std::span<const double> values) {
  ExactSum sum;
  for (const double value : values) sum.add(value);
  return sum.value();
}

// Elements that an edit touches, before and after it: a hexahedron may have become tetrahedra.
struct EditedElements {
  std::vector<std::int32_t> before, after;  // ascending
  std::vector<std::int32_t> parent;         // (n_elements after)
  std::vector<double> volume;               // of `before`, before the edit [m^3]
};

EditedElements find_edited(const Mesh& mesh, const MeshEdit& edit) {
  EditedElements edited{.before = edited_elements(mesh, edit),
                        .parent = element_parents(mesh, edit)};
  for (std::size_t e = 0; e < edited.parent.size(); ++e)
    if (std::binary_search(edited.before.begin(), edited.before.end(), edited.parent[e]))
      edited.after.push_back(static_cast<std::int32_t>(e));
  for (const std::int32_t e : edited.before)
    edited.volume.push_back(element_volume(mesh, e, mesh.X));
  return edited;
}

// Volumes of the elements after the edit over those of the elements that they were or were parts
// of; 1 where the edit left them.
std::vector<double> volume_ratios(const Mesh& after, const EditedElements& edited) {
  std::vector<double> ratio(after.element_type.size(), 1.0);
  for (const std::int32_t e : edited.after) {
    const auto k = static_cast<std::size_t>(e);
    const auto at = std::lower_bound(edited.before.begin(), edited.before.end(), edited.parent[k]);
    ratio[k] = element_volume(after, e, after.X) /
               edited.volume[static_cast<std::size_t>(at - edited.before.begin())];
  }
  return ratio;
}

// Where the next search starts: the mode known (of all nodes before the edit, empty if none was
// searched for), with duplicates like their parents, and noise at the edited elements, so that a
// faster mode that is new there has a share.
void carry_mode(std::span<const double> known, const MeshEdit& edit, std::int32_t n_before,
                std::span<const std::int32_t> edited_nodes, Simulation& s) {
  // With scaled masses the search from a known mode differed between ranks in its last digits: from
  // nothing it does not.
  if (known.empty() || s.added_mass) return;
  s.fastest_mode.resize(3 * static_cast<std::size_t>(s.model.n_owned));
  for (std::int64_t i = 0; i < s.model.n_owned; ++i) {
    const std::int32_t node = s.part.node_global[i];
    const std::int32_t from = node < n_before ? node : edit.duplicate_parent[node - n_before];
    std::copy_n(&known[3 * std::size_t(from)], 3, &s.fastest_mode[3 * i]);
  }
  double largest = 0;
  for (const double value : known) largest = std::max(largest, std::abs(value));
  for (const std::int32_t node : edited_nodes) {
    const std::int32_t i = s.part.node_local[node];
    if (i >= 0 && i < s.model.n_owned) add_noise(s.model, s.part, i, 0.3 * largest, s.fastest_mode);
  }
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

}  // namespace

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
  const EditedElements edited = find_edited(s.mesh, edit);
  const std::int32_t n_before = s.mesh.n_nodes();
  const std::vector<std::int32_t> nodes_before = nodes_of(s.mesh, edited.before);
  const double step_before = least_element_step(s, edited.before);
  const double mass_before = total(s.mass);
  const double energy_before = s.energy ? mechanical_energy(s).sum() : 0;
  Motion before = motion_of(nodes_before, s.mass, global, Vec3::Zero());
  before = motion_of(nodes_before, s.mass, global, before.centre);

  const std::vector<double> history =
      s.communicator->all_gather(copy_history(s.model, s.part, s.state));

  apply_edit(edit, s.mesh, 3, global.u);
  apply_edit(edit, s.mesh, 3, global.v);
  apply_edit(edit, s.mesh);
  global.x = present_positions(s.mesh.X, global.u);
  inherit_by_duplicates(s, edit, n_before);
  apply_edit_to_owners(edit.duplicate_parent, s.node_owner);
  apply_edit_to_holds(edit, n_before, s.holds);
  std::vector<double> known_mode;
  if (s.communicator->all_max(s.fastest_mode.empty() ? 0 : 1) > 0)
    known_mode = all_gather_field(s.part, n_before, 3, s.fastest_mode, *s.communicator);
  rebuild_topology(s);
  const std::vector<std::int32_t> nodes_after = nodes_of(s.mesh, edited.after);
  carry_mode(known_mode, edit, n_before, nodes_after, s);
  restore_momentum(nodes_after, s.mass, before, global, record);
  scatter_state(s, global);
  restore_history(s.model, s.part, history, edited.parent, volume_ratios(s.mesh, edited), s.state);
  watch_state(s);
  if (s.energy) s.energy->memory.works.cut += mechanical_energy(s).sum() - energy_before;

  for (const std::int32_t e : edited.after)
    record.least_quality = std::min(record.least_quality, element_quality(s.mesh, e, s.mesh.X));
  record.stable_step_ratio =
      std::min(record.stable_step_ratio, least_element_step(s, edited.after) / step_before);
  record.mass_change =
      std::max(record.mass_change, std::abs(total(s.mass) - mass_before) / mass_before);
  s.log.new_edits.push_back({.frame = s.frame, .edit = edit});
}

}  // namespace trocar
