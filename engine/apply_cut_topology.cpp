#include "engine/apply_cut_topology.h"

#include <algorithm>

#include "base/on_root.h"
#include "engine/build.h"
#include "mesh/connected_nodes.h"
#include "mesh/quality.h"
#include "mesh/surface_edit.h"
#include "solver/model_edit.h"
#include "solver/model_lists.h"

namespace trocar {

namespace {

// Sums go over elements in ascending order, as in the whole mesh: the same bits.
void update_mass(const SubMesh& around, std::span<const std::int32_t> nodes, Simulation& s) {
  const std::vector<double> mass =
      lumped_mass(around.mesh, region_densities(s.materials), s.scene.tissue.thickness);
  s.mass.resize(s.mesh.X.size());
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (std::binary_search(nodes.begin(), nodes.end(), around.node[i]))
      s.mass[around.node[i]] = mass[i];
}

// Pieces join nowhere, and part only where the elements around an edit part.
void update_pieces(const SubMesh& around, Simulation& s) {
  if (count_pieces(around.mesh) > 1) find_pieces(s);
}

void update_least(Simulation& s, const ModelEdit& edit) {
  move_to_places(edit.place_before, s.altitude);
  std::vector<std::int64_t> places;
  for (const std::int32_t e : edit.elements)
    if (const std::int64_t k = s.part.place_of(e); k >= 0) {
      s.altitude[k] = least_altitude(s.mesh, e, s.mesh.X);
      places.push_back(k);
    }
  if (edit.place_before.empty()) {
    s.least_altitude.change(s.altitude, places);
    s.least_element_step.change(s.model.element_step, places);
  } else {
    s.least_altitude = LeastOfMany(s.altitude);
    s.least_element_step = LeastOfMany(s.model.element_step);
  }
}

void update_part_and_model(Simulation& s, const ModelEdit& edit) {
  update_part(s.mesh, s.corners, s.node_owner, edit.nodes, s.part);
  update_halo(s.mesh, s.corners, s.node_owner, edit.touching, s.part, s.halo);
  unscale_mass(s.model);
  edit_model({s.mesh, s.part, s.materials, s.model.options, s.fixed, s.mass}, edit, s.model,
             s.state.history);
  if (s.mass_scaling) scale_mass(*s.mass_scaling, s.part, s.model);
  s.neighbours = make_neighbours(s.halo, s.model, *s.communicator);
  fit_scratch(s.model, s.scratch);
  update_least(s, edit);
}

// Where no element of the part is edited.
void follow_elsewhere(Simulation& s) {
  s.part.node_local.resize(s.mesh.X.size(), -1);
  take_positions({s.mesh, s.part, s.materials, s.model.options}, s.model);
}

bool holds_one(const Part& part, std::span<const std::int32_t> elements) {
  return std::any_of(elements.begin(), elements.end(),
                     [&](std::int32_t e) { return part.place_of(e) >= 0; });
}

// The first tetrahedra of a region bring a field of averages with them, on all ranks.
bool changes_averages(const Simulation& s, const TopologyEdit& edit) {
  return !edit.splits.empty() && s.model.options.tet4 == Formulation::tet4_nodal_pressure;
}

}  // namespace

bool keeps_owners(const Simulation& s, const MeshEdit& edit) {
  const auto owner = [&](std::int32_t i) { return s.node_owner[i]; };
  const SplitNumbers numbers(edit.splits, s.mesh.n_elements());
  return std::all_of(edit.corners.begin(), edit.corners.end(), [&](const CornerChange& change) {
    return owner(change.node) == owner(node_before(numbers, s.mesh, change));
  });
}

bool update_topology(Simulation& s, const TopologyEdit& edit) {
  if (s.sleep) wake_all(s);
  const std::vector<std::int32_t> touching = elements_around(s.corners, edit.nodes);
  const SubMesh around =
      make_sub_mesh(s.mesh, elements_around(s.corners, nodes_of(s.mesh, touching)));
  update_mass(around, edit.nodes, s);
  update_surface(s.mesh, {edit.nodes, touching, around}, s.surface);
  update_pieces(around, s);
  const std::vector<std::int32_t> place_before =
      split_elements(s.mesh, s.node_owner, edit.splits, s.part);
  on_every_rank(*s.communicator, [&] {
    if (holds_one(s.part, edit.elements) || changes_averages(s, edit))
      update_part_and_model(s, {edit.elements, edit.nodes, touching, place_before});
    else
      follow_elsewhere(s);
  });
  if (s.sleep) fit_sleep(s);
  report_mass_scaling(s);
  const bool keeps_steps = follow_local_steps(edit.elements, edit.nodes, s);
  update_surface_view(s.surface, s.node_owner, s.part, s.view);
  follow_model(s);
  return keeps_steps;
}

}  // namespace trocar
