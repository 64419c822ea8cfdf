#include "engine/patch.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/check.h"
#include "base/exact_sum.h"
#include "base/sort_unique.h"
#include "engine/body_search.h"
#include "engine/energy_ledger.h"
#include "solver/frequency.h"
#include "solver/step.h"
#include "solver/watch.h"

namespace trocar {

namespace {

std::vector<std::int32_t> elements_around(const Simulation& s,
                                          std::span<const std::int32_t> nodes) {
  return s.corners.first.empty() ? elements_around(s.mesh, nodes)
                                 : elements_around(s.corners, nodes);
}

std::vector<std::int32_t> with_rings(const Simulation& s, std::vector<std::int32_t> nodes) {
  for (int ring = 0; ring < patch_rings; ++ring)
    nodes = nodes_of(s.mesh, elements_around(s, nodes));
  return nodes;
}

// Grows until the clusters of scaled masses that it touches are whole: their mean motion takes all
// their nodes.
MassScaling take_in_clusters(const Simulation& s, SubMesh& sub) {
  for (;;) {
    MassScaling scaling =
        find_mass_scaling(sub.mesh, s.materials, s.model.options, s.scene.solver.mass_scaling_step);
    const std::vector<std::int32_t> grown =
        united(sub.element, elements_around(s, values_of<std::int32_t>(sub.node, scaling.node)));
    if (grown.size() == sub.element.size()) return scaling;
    sub = make_sub_mesh(s.mesh, grown);
  }
}

std::vector<FixedMask> fixed_in_patch(const Simulation& s, std::span<const std::int32_t> node,
                                      std::span<const std::int32_t> free) {
  std::vector<FixedMask> fixed = values_of<FixedMask>(s.fixed, node);
  for (std::size_t i = 0; i < node.size(); ++i)
    if (!std::binary_search(free.begin(), free.end(), node[i])) fixed[i] = all_components;
  return fixed;
}

// By the elements' numbers in the patch.
ElementOrigins origins_in_patch(const ElementOrigins& all, const SubMesh& sub) {
  ElementOrigins own;
  for (const std::int32_t e : sub.element) {
    const std::int32_t k = find_in(all.element, e);
    CHECK_OP(k, >=, 0);
    own.element.push_back(static_cast<std::int32_t>(own.element.size()));
    own.parent.push_back(all.parent[k]);
    own.scale.push_back(all.scale[k]);
  }
  return own;
}

State state_at_rest(const Simulation& s, const Model& model) {
  State state = make_state(model);
  state.time = state.history_time = s.state.time;
  state.last_dt = s.state.last_dt;
  return state;
}

void set_state(const Simulation& s, const PatchState& state, Patch& patch) {
  find_nodes(s, patch.sub.node, *s.communicator, state.global);
  for (std::size_t i = 0; i < patch.sub.node.size(); ++i) {
    const std::size_t from = 3 * static_cast<std::size_t>(patch.sub.node[i]);
    std::copy_n(&state.global.u[from], 3, &patch.state.u[3 * i]);
    std::copy_n(&state.global.v[from], 3, &patch.state.v[3 * i]);
  }
  if (!state.history.empty())
    restore_history(patch.model, patch.part, state.history,
                    origins_in_patch(*state.origins, patch.sub), patch.state);
  average_volume_change(patch.model, patch.state, patch.scratch);
}

// Takes over the present displacements. Collective.
void set_present(const Simulation& s, Patch& patch) {
  const std::vector<double> motion = motion_at(s, patch.sub.node, *s.communicator);
  for (std::size_t i = 0; i < patch.sub.node.size(); ++i)
    std::copy_n(&motion[6 * i], 3, &patch.state.u[3 * i]);
  average_volume_change(patch.model, patch.state, patch.scratch);
}

// A patch with its nodes at rest.
std::unique_ptr<Patch> assemble(const Simulation& s, SubMesh sub, const MassScaling& scaling,
                                std::span<const FixedMask> fixed) {
  auto made = std::make_unique<Patch>();
  Patch& patch = *made;
  patch.sub = std::move(sub);
  const std::vector<std::int32_t>& node = patch.sub.node;
  patch.part = whole_part(patch.sub.mesh);
  patch.model = build_model(patch.sub.mesh, patch.part, s.materials, fixed,
                            values_of<double>(s.mass, node), s.model.options);
  if (!scaling.node.empty()) scale_mass(scaling, patch.part, patch.model);
  patch.scratch = make_scratch(patch.model);
  patch.state = state_at_rest(s, patch.model);
  return made;
}

// Null if these are more than `most` elements.
std::unique_ptr<Patch> make_patch_of_nodes(
    const Simulation& s, std::span<const std::int32_t> free,
    std::size_t most = std::numeric_limits<std::size_t>::max()) {
  const std::vector<std::int32_t> elements = elements_of_forces(s, free);
  if (elements.size() > most) return nullptr;
  SubMesh sub = make_sub_mesh(s.mesh, elements);
  MassScaling scaling;
  if (s.mass_scaling) scaling = take_in_clusters(s, sub);
  const std::vector<FixedMask> fixed = fixed_in_patch(s, sub.node, free);
  return assemble(s, std::move(sub), scaling, fixed);
}
std::unique_ptr<Patch> make_patch_of_nodes(const Simulation& s, std::span<const std::int32_t> free,
                                           const PatchState& state) {
  std::unique_ptr<Patch> patch = make_patch_of_nodes(s, free);
  set_state(s, state, *patch);
  return patch;
}

double sum_of(std::initializer_list<std::span<const double>> lists) {
  ExactSum sum;
  for (const std::span<const double> list : lists) sum.add(list);
  return sum.value();
}

}  // namespace

std::vector<std::int32_t> elements_of_forces(const Simulation& s,
                                             std::span<const std::int32_t> nodes) {
  std::vector<std::int32_t> elements = elements_around(s, nodes);
  if (s.model.options.tet4 == Formulation::tet4_nodal_pressure)
    elements = elements_around(s, nodes_of(s.mesh, elements));
  return elements;
}

std::unique_ptr<Patch> make_patch(const Simulation& s, std::span<const std::int32_t> edited,
                                  const PatchState& state) {
  return make_patch_of_nodes(s, with_rings(s, nodes_of(s.mesh, edited)), state);
}

std::unique_ptr<Patch> make_present_patch(const Simulation& s,
                                          std::span<const std::int32_t> elements,
                                          std::size_t most) {
  return make_present_patch_around(s, nodes_of(s.mesh, elements), most);
}

std::unique_ptr<Patch> make_present_patch_around(const Simulation& s,
                                                 std::span<const std::int32_t> nodes,
                                                 std::size_t most) {
  std::unique_ptr<Patch> patch =
      make_patch_of_nodes(s, with_rings(s, {nodes.begin(), nodes.end()}), most);
  if (patch) set_present(s, *patch);
  return patch;
}

std::vector<std::int32_t> elements_of_patch(const Simulation& s,
                                            std::span<const std::int32_t> nodes) {
  std::vector<std::int32_t> elements =
      elements_of_forces(s, with_rings(s, {nodes.begin(), nodes.end()}));
  if (!s.mass_scaling) return elements;
  SubMesh sub = make_sub_mesh(s.mesh, elements);
  take_in_clusters(s, sub);
  return sub.element;
}

std::unique_ptr<Patch> make_patch_of(const Simulation& s, std::span<const std::int32_t> elements,
                                     const PatchState& state) {
  SubMesh sub = make_sub_mesh(s.mesh, elements);
  const std::vector<FixedMask> fixed = values_of<FixedMask>(s.fixed, sub.node);
  std::unique_ptr<Patch> patch = assemble(s, std::move(sub), {}, fixed);
  set_state(s, state, *patch);
  return patch;
}

// Terms of what lies beyond the nodes are the same before and after, to the last bit.
double patch_energy(const Simulation& s, std::span<const std::int32_t> nodes,
                    const PatchState& state) {
  const std::unique_ptr<Patch> patch = make_patch_of_nodes(s, nodes, state);
  compute_force(patch->model, patch->state, patch->scratch);
  EnergyTerms terms;
  energy_terms(patch->model, patch->part, patch->state, terms);
  std::vector<double> kinetic, gravity;
  add_nodal_energies(*patch, kinetic, gravity);
  return sum_of({terms.strain, terms.volumetric, terms.hourglass, kinetic, gravity});
}

// That of the body around the patch is at least as long where the patch's is.
static double search_patch(const Simulation& s, Patch& patch) {
  const double amplitude = search_amplitude(s.model, s.edge_length);
  const double enough = s.watch.stable_step;
  const Communicator alone;
  if (!s.multirate) return search_step(patch, amplitude, alone, enough);
  const double longer = s.multirate->steps.limit / 2;
  const double step = longer * search_step(patch, amplitude, alone, enough / longer);
  for (std::size_t i = 0; i < patch.sub.node.size(); ++i)
    if (s.local_steps->plan.is_fine[patch.sub.node[i]] != 0) patch.model.fixed[i] = all_components;
  const bool is_all_fine = std::ranges::all_of(
      patch.model.fixed, [](FixedMask fixed) { return fixed == all_components; });
  return is_all_fine ? step : std::min(step, search_step(patch, amplitude, alone, enough));
}

// Least bounds of its elements and, if the scene's step is a frequency's and they are below that of
// s.watch, the step of its highest frequency; elements by their numbers in the mesh.
static Watch watch_patch(const Simulation& s, Patch& patch) {
  Watch w = watch(patch.model, patch.part, patch.state);
  const bool by_frequency = s.scene.solver.stable_step == StableStep::frequency;
  if (by_frequency && w.least_J > 0 && w.stable_step < s.watch.stable_step)
    w.stable_step = std::max(w.stable_step, search_patch(s, patch));
  for (std::int32_t* element : {&w.stable_element, &w.least_J_element})
    if (*element >= 0) *element = patch.sub.element[*element];
  return w;
}

void watch_edit(Simulation& s, std::span<const std::int32_t> edited, const PatchState& state) {
  const PhaseScope scope(s.timers, phase_watch);
  const std::unique_ptr<Patch> patch = make_patch(s, edited, state);
  const Watch w = watch_patch(s, *patch);
  if (w.stable_step < s.watch.stable_step) {
    s.watch.stable_step = w.stable_step;
    s.watch.stable_element = w.stable_element;
  }
  if (w.least_J < s.watch.least_J) {
    s.watch.least_J = w.least_J;
    s.watch.least_J_element = w.least_J_element;
  }
  follow_from_here(s, s.watch.stable_step);
  // The small elements' own limit may have changed unseen.
  s.look.of_small = s.multirate ? 2 / s.multirate->steps.limit : 1;
}

}  // namespace trocar
