#include "engine/build.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/check.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/log.h"
#include "base/number_text.h"
#include "base/on_root.h"
#include "base/sort_unique.h"
#include "cutting/cut_hex.h"
#include "engine/archive.h"
#include "engine/body_check.h"
#include "engine/equilibrium.h"
#include "engine/frame_report.h"
#include "engine/frame_watch.h"
#include "engine/instrument_check.h"
#include "engine/owners.h"
#include "engine/pair_look.h"
#include "engine/support_forces.h"
#include "engine/tissue.h"
#include "mesh/connected_nodes.h"
#include "mesh/mesh_file.h"
#include "mesh/quality.h"

namespace trocar {

namespace {

// Depth from which on an instrument is not laid on the body but lies in it, in reaches of contact.
constexpr double buried = 0.4;

FixedMask fixed_mask(const std::string& fix) {
  FixedMask mask = 0;
  for (const int axis : axes_of(fix)) mask = static_cast<FixedMask>(mask | (1 << axis));
  return mask;
}

// Supports at rest become fixed components, moving ones prescribed nodes. A plane body stays in its
// plane.
void build_supports(Simulation& s) {
  s.fixed.assign(s.mesh.X.size(), s.mesh.dimension() == 2 ? fixed_mask("z") : FixedMask{0});
  for (std::size_t k = 0; k < s.scene.supports.size(); ++k) {
    const SceneSupport& support = s.scene.supports[k];
    s.holds.paths.emplace_back(support.path);
    const NodeSet* set = find_node_set(s.mesh, support.region);
    if (support.path.empty()) {
      const FixedMask mask = fixed_mask(support.fix);
      for (const std::int32_t node : set->node) s.fixed[node] |= mask;
      continue;
    }
    for (const std::int32_t node : set->node)
      s.holds.holds.push_back({.node = node, .support = static_cast<std::int32_t>(k)});
  }
  sort_unique_by(s.holds.holds, &Hold::node);
}

TriangleMesh load_tool_mesh(const LoadedScene& loaded, std::size_t k, Communicator& communicator) {
  const SceneInstrument& instrument = loaded.scene.instruments[k];
  if (instrument.mesh.empty()) return {};
  // Every rank reads the small file's content from rank 0.
  const auto bytes = read_on_root(communicator, [&] {
    TriangleMesh surface;
    try {
      surface = read_triangle_mesh(scene_path(loaded, instrument.mesh), instrument.scale);
      warn_of_size(instrument.mesh, item_path("instrument", k) + ".scale", surface.X);
    } catch (const InputError& trouble) {
      loaded.where.fail(item_path("instrument", k) + ".mesh", trouble.what());
    }
    return surface_to_bytes(surface);
  });
  return surface_from_bytes(bytes, instrument.mesh);
}

std::uint32_t crc_of_body(const Simulation& s) {
  std::uint32_t crc = 0;
  Saver save([&](std::span<const std::byte> bytes) { crc = crc32c(bytes, crc); });
  put_mesh(save, s.mesh);
  save.writer().flush();
  for (const Tool& tool : s.tools) {
    crc = crc32c(std::as_bytes(std::span(tool.own_mesh.X)), crc);
    crc = crc32c(std::as_bytes(std::span(tool.own_mesh.triangle)), crc);
  }
  return crc;
}

// Where no blade gets through.
void warn_of_whole_hexahedra(const Simulation& s) {
  if (s.mesh.dimension() == 2) return;
  const std::size_t n = whole_hexahedra(s.mesh).size();
  if (n > 0)
    log_warning(std::to_string(n) +
                " hexahedra can't be cut: they are bent too much to be split into tetrahedra, or "
                "tetrahedra on their facets have the other diagonal");
}

CutTetOptions tet_cut_options(const SceneCutting& cutting) {
  CutTetOptions options{.advance = cutting.advance, .split_step_ratio = cutting.split_step_ratio};
  if (!std::isnan(cutting.least_step_ratio)) options.least_step_ratio = cutting.least_step_ratio;
  return options;
}

CutPlaneOptions plane_cut_options(const SceneCutting& cutting, const Mesh& mesh) {
  const bool is_robust = cutting.mode == CutMode::robust;
  CutPlaneOptions options = is_robust ? CutPlaneOptions{} : published_options();
  options.spring = cutting.spring;
  options.particle = cutting.particle;
  const double ratio =
      std::isnan(cutting.least_step_ratio) ? plane_step_ratio : cutting.least_step_ratio;
  if (is_robust) options.least_step = ratio * least_step_bound(mesh);
  return options;
}

// For what `n` values become by the nodes and elements that cuts add.
template <class T>
void leave_room(std::size_t n, std::vector<T>& values) {
  values.reserve(n + n / 8);
}

void leave_room_in_mesh(Mesh& mesh) {
  leave_room(mesh.X.size(), mesh.X);
  for (auto* values : {&mesh.corner_offset, &mesh.corner_node, &mesh.element_region})
    leave_room(values->size(), *values);
  leave_room(mesh.element_type.size(), mesh.element_type);
  leave_room(mesh.cut_facets.size(), mesh.cut_facets);
  leave_room(mesh.density_factor.size(), mesh.density_factor);
  leave_room(mesh.fibre.size(), mesh.fibre);
}

void build_cuts(Simulation& s) {
  const SceneCutting& cutting = s.scene.cutting;
  for (std::size_t k = 0; k < s.tools.size(); ++k) {
    if (s.tools[k].edge.empty()) continue;
    s.cuts.push_back(
        CutStage{.tool = static_cast<std::int32_t>(k), .tet = TetCutter(tet_cut_options(cutting))});
    if (s.mesh.dimension() == 2) s.cuts.back().plane = plane_cut_options(cutting, s.mesh);
  }
  if (s.cuts.empty()) return;
  warn_of_whole_hexahedra(s);
}

void build_instruments(const LoadedScene& loaded, Simulation& s) {
  const double edge = s.edge_length;
  for (std::size_t k = 0; k < s.scene.instruments.size(); ++k) {
    const SceneInstrument& instrument = s.scene.instruments[k];
    s.tools.push_back(
        make_tool(instrument, load_tool_mesh(loaded, k, *s.communicator), 0.5 * edge));
  }
  s.holds.is_open.assign(s.tools.size(), 1);
  s.holds.poses.resize(s.tools.size());
  const bool has_tissue = s.scene.contact.has_tissue;
  if (s.tools.empty() && !has_tissue) return;
  std::vector<ToolShape> shapes;
  for (const Tool& tool : s.tools) shapes.push_back(tool.shape);
  s.contact = std::make_unique<ContactStage>(
      ContactStage{.detector = ContactDetector(shapes),
                   .options = {.friction = s.scene.contact.friction,
                               .release_speed = s.scene.contact.release_speed},
                   .has_tissue = has_tissue});
  s.contact->motion.resize(s.tools.size());
  s.contact_reach = 0.5 * edge;
  warn_of_short_tools(s.scene);
  warn_of_hasty_jaws(s.scene);
  warn_of_half_turns(s.scene);
  tell_of_bulges(s.tools, edge);
  build_cuts(s);
}

// One sliver makes every frame slow, and from outside that looks like a run that hangs; signals are
// heeded between frames only.
void check_slow_element(const LoadedScene& loaded, const Simulation& s) {
  constexpr double many_substeps = 10000, too_many_substeps = 1e6;
  const double n = 1 / (s.scene.time.frame_rate * s.step_factor * s.watch.stable_step);
  if (n < many_substeps) return;
  const std::string sentence =
      "a frame needs " + short_text(n) + " steps, because element " +
      std::to_string(s.watch.stable_element) + " allows only " + short_text(s.watch.stable_step) +
      " s a step: it is a sliver (\"trocar mesh\" shows the mesh's quality), or its material is "
      "too stiff, too light or too near poisson_ratio = 0.5, or solver.step_factor or "
      "time.frame_rate is too small";
  if (n > too_many_substeps) loaded.where.fail("tissue", sentence);
  log_warning(sentence);
}

std::vector<double> least_altitudes(const Simulation& s) {
  std::vector<double> altitude;
  altitude.reserve(s.part.element_global.size());
  for (const std::int32_t e : s.part.element_global)
    altitude.push_back(least_altitude(s.mesh, e, s.mesh.X));
  return altitude;
}

// So that no edit moves all that is known of the nodes and elements.
void leave_room_for_edits(Simulation& s) {
  const std::size_t n = s.mesh.X.size();
  for (auto* values : {&s.boxes.x, &s.view.x, &s.cut_state.x}) leave_room(n, *values);
  for (auto* values : {&s.cut_state.u, &s.cut_state.v, &s.state.u, &s.state.v, &s.scratch.force})
    leave_room(3 * n, *values);
  for (auto* values : {&s.node_owner, &s.corners.first, &s.part.node_local, &s.part.node_global})
    leave_room(n, *values);
  leave_room(n, s.mass);
  for (auto* values : {&s.corners.next, &s.corners.element, &s.boxes.leaf})
    leave_room(values->size(), *values);
}

// What is wrong now is so with the tissue as it was given.
void build_topology(const LoadedScene& loaded, Simulation& s) {
  try {
    rebuild_topology(s);
  } catch (const InputError& trouble) {
    loaded.where.fail("tissue.material", trouble.what());
  }
}

}  // namespace

SolverOptions solver_options(const Scene& scene) {
  const SceneSolver& solver = scene.solver;
  return {.mass_damping = solver.mass_damping,
          .hourglass = solver.hourglass,
          .thickness = scene.tissue.thickness,
          .gravity = solver.gravity,
          .precision = solver.precision,
          .tri3 = solver.triangle,
          .tet4 = solver.tetrahedron,
          .hex8 = solver.hexahedron};
}

std::vector<double> region_densities(std::span<const Material> materials) {
  std::vector<double> density;
  for (const Material& material : materials) density.push_back(material.density);
  return density;
}

void rebuild_topology(Simulation& s) {
  plan_mass_scaling(s);
  note_imbalance(s);
  s.mass = lumped_mass(s.mesh, region_densities(s.materials), s.scene.tissue.thickness);
  s.part = make_part(s.mesh, s.node_owner, s.communicator->rank());
  s.halo = make_halo(s.mesh, s.node_owner, s.part);
  on_every_rank(*s.communicator, [&] {
    s.model = build_model(s.mesh, s.part, s.materials, s.fixed, s.mass, solver_options(s.scene));
  });
  if (s.mass_scaling) scale_mass(*s.mass_scaling, s.part, s.model);
  if (s.whole_mass == 0) s.whole_mass = std::accumulate(s.mass.begin(), s.mass.end(), 0.0);
  report_mass_scaling(s);
  s.neighbours = make_neighbours(s.halo, s.model, *s.communicator);
  s.scratch = make_scratch(s.model);
  plan_local_steps(s);
  begin_sleep(s);
  if (s.energy) keep_works(s.model, s.scratch);
  s.surface = boundary_surface(s.mesh);
  find_pieces(s);
  s.altitude = least_altitudes(s);
  s.least_altitude = LeastOfMany(s.altitude);
  s.least_element_step = LeastOfMany(s.model.element_step);
  s.view = make_surface_view(s.surface, s.node_owner, s.part);
  if (s.contact) s.view.x = s.mesh.X;  // until they are gathered
  s.boxes = {};
  follow_model(s);
}

void prepare_for_cuts(Simulation& s) {
  if (s.cuts.empty()) return;
  s.corners = node_corners(s.mesh);
  s.boxes = make_element_boxes(s.mesh, s.mesh.X);
  leave_room_in_mesh(s.mesh);
  leave_room_for_edits(s);
  prepare_cutters(s);
}

void find_pieces(Simulation& s) {
  const std::vector<std::int32_t> piece = connected_nodes(s.mesh);
  s.n_pieces = count_pieces(piece);
  std::size_t n = 0;
  for (std::size_t k = 0; k < s.duplicate_node.size(); ++k) {
    if (piece[s.duplicate_node[k]] != piece[s.duplicate_parent[k]]) continue;
    s.duplicate_node[n] = s.duplicate_node[k];
    s.duplicate_parent[n++] = s.duplicate_parent[k];
  }
  s.duplicate_node.resize(n);
  s.duplicate_parent.resize(n);
}

void follow_model(Simulation& s) {
  s.rest_step = s.communicator->all_min(s.least_element_step.value());
  localise_holds(s.holds, s.part);
  if (has_metrics(s.scene)) s.markers = follow_markers(s.scene.markers, s.mesh);
  if (!s.scene.loads.empty()) {
    const LoadedAreas areas = find_loaded_areas(s.scene.loads, s.mesh, s.surface);
    localise_loads(s.scene.loads, s.mesh, areas, s.part, s.loads);
    if (!s.cuts.empty()) s.loads.border = load_borders(areas, s.mesh);
  }
  if (s.energy) localise_supports(s.scene.supports, s.mesh, s.part, s.energy->support_forces);
  // A component r of displacements strains tetrahedra by at most 4 sqrt(3) r / h, hexahedra at
  // their centre by 6 r / h, with the least altitude h.
  s.look = {.reach = unseen_strain / 7 * s.communicator->all_min(s.least_altitude.value())};
  if (!s.contact) return;
  join_masses(*s.contact, contact_body(s));
  if (s.mesh.dimension() == 3)
    s.contact->detector.set_closed_surface(s.surface);
  else
    s.contact->detector.set_surface(s.surface);
}

std::unique_ptr<Simulation> build(const LoadedScene& loaded, Communicator& communicator) {
  auto simulation = std::make_unique<Simulation>();
  Simulation& s = *simulation;
  s.communicator = &communicator;
  s.scene = loaded.scene;
  for (std::size_t k = 0; k < n_phases; ++k) s.timers.phase(phase_names[k]);
  s.mesh = load_tissue(loaded, communicator);
  s.step_factor = step_factor_of(s.scene.solver, s.mesh);
  s.materials = region_materials(s.scene.tissue, s.mesh);
  choose_owners(s);
  s.edge_length = mean_edge_length(s.mesh);
  build_supports(s);
  OptionErrors errors(loaded.where);
  if (s.scene.start.state == StartState::equilibrium) check_is_held(s, errors);
  build_instruments(loaded, s);
  s.body_crc = crc_of_body(s);
  build_topology(loaded, s);
  check_body(s, errors);
  errors.throw_if_any();
  s.state = make_state(s.model);
  if (s.contact) refresh_surface(s);
  watch_state(s);
  check_slow_element(loaded, s);
  if (s.contact && s.scene.start.state == StartState::undeformed)
    check_instruments_outside(loaded, buried * s.contact_reach,
                              "the body at time 0: let it begin outside", s);
  s.log.least_stable_step = s.log.largest_stable_step = s.watch.stable_step;
  if (has_metrics(s.scene)) open_energy_ledger(s);
  prepare_for_cuts(s);
  s.scratch.has_force = false;  // nodes may be moved before the first frame
  return simulation;
}

}  // namespace trocar
