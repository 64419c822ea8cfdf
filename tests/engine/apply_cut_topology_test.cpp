// What an edit changes in part, model, masses and surface, against making them from the edited
// mesh.
#include "engine/apply_cut_topology.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/sort_unique.h"
#include "base/threads.h"
#include "collision/plane_contact.h"
#include "engine/apply_cut.h"
#include "engine/energy_ledger.h"
#include "engine/frame_watch.h"
#include "engine_blocks.h"
#include "engine_scene.h"
#include "engine_split.h"
#include "engine_started.h"
#include "engine_topology_equal.h"
#include "known_positions.h"
#include "mesh/surface_edit.h"
#include "mesh_split.h"
#include "solver/history.h"
#include "solver/model_edit.h"
#include "solver/step.h"
#include "solver_model_equal.h"

namespace trocar {
namespace {

constexpr int n_bands = 8;

// A slanting blade that comes in from x- and goes on from call to call until it is through.
MeshEdit next_edit(const Simulation& s, const GlobalState& global, TetCutter& cutter, int k) {
  BladeSweep sweep;
  sweep.normal = Vec3(-0.2, 0, 1).normalized();
  for (int j = 0; j <= 10; ++j) {
    const double x = -0.024 + 0.006 * k, y = 0.02 - 0.004 * j;
    sweep.before.emplace_back(x, y, 0.012 + 0.2 * (x + 0.02));
    sweep.after.emplace_back(x + 0.006, y, 0.012 + 0.2 * (x + 0.026));
  }
  CutFigures figures;
  KnownPositions positions(s.mesh, global.x);
  return cutter.advance(s.mesh, positions, {held_nodes(s.holds, s.fixed)}, sweep, k == n_bands - 1,
                        figures);
}

// Calls body(the state, the edit that it is to apply) for each; returns how many there were.
template <class Body>
int for_edits(Simulation& s, const Body& body) {
  TetCutter cutter{CutTetOptions{}};
  int n_edits = 0;
  for (int k = 0; k < n_bands; ++k) {
    GlobalState global = gather_state(s);
    const MeshEdit edit = next_edit(s, global, cutter, k);
    if (edit.is_empty()) continue;
    ++n_edits;
    body(global, edit);
  }
  return n_edits;
}

// Longer than the steps of elements beside a cut.
const std::string scaled = "mass_scaling_step = \"0.45 ms\"\n", sleepy = "sleep = \"0.1 mm\"\n";
const std::string in_local_steps = "multirate = true\n";
const std::string viscosity = "[[tissue.material.prony]]\nshare = 0.4\ntime = 0.1\n";
const std::vector<std::pair<std::string, std::string>> solved_kinds = {
    {"tet4-kuhn", ""},
    {"tet4-five", "precision = \"single\"\n"},
    {"tet4-kuhn", "tetrahedron = \"nodal-pressure\"\n"},
    {"hex8", ""},
    {"hex8", "precision = \"single\"\n"},
    {"hex8", "tetrahedron = \"nodal-pressure\"\n"},
    {"hex8", viscosity},
    {"tet4-kuhn", viscosity},
    {"tet4-kuhn", sleepy},
    {"tet4-kuhn", scaled},
    {"tet4-five", scaled + viscosity},
    {"hex8", scaled + sleepy},
    {"tet4-kuhn", in_local_steps},
    {"hex8", in_local_steps + sleepy}};

void make_half_stiffer(Simulation& s) {
  s.mesh.region_name = {"", "stiff"};
  s.materials.push_back(s.materials.front());
  s.materials.back().young_modulus *= 2;
  for (std::int32_t e = 0; e < s.mesh.n_elements(); ++e)
    s.mesh.element_region[e] = s.mesh.X[s.mesh.corners(e)[0]].y() < 0.002 ? 1 : 0;
}

// A face of one cell comes close to the opposite one, away from the blade.
void make_sliver(Simulation& s) {
  for (Vec3& X : s.mesh.X)
    if ((X - Vec3(-0.012, 0.01, 0.026)).norm() < 0.003) X.x() += 0.98 * 0.004;
}

void bend_and_move(Simulation& s) {
  for (std::size_t i = 0; i < s.mesh.X.size(); ++i) {
    const Vec3& X = s.mesh.X[i];
    Vec3::Map(&s.state.u[3 * i]) = Vec3(3 * X.z() * X.z(), 0.1 * X.x(), -4 * X.x() * X.y());
    Vec3::Map(&s.state.v[3 * i]) = Vec3(0.3 - 2 * X.y(), 40 * X.x() * X.z(), 0.2);
  }
  s.state.last_dt = 1e-4;
  compute_force(s.model, s.state, s.scratch);  // and the history
  watch_state(s);
}

std::vector<double> volumes(const Mesh& mesh) {
  std::vector<double> volume;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    volume.push_back(element_volume(mesh, e, mesh.X));
  return volume;
}

// What elements have of `copies` by the volumes that they and their parents have.
std::vector<double> history_of(const Simulation& s, std::span<const double> copies,
                               std::span<const std::int32_t> parent,
                               std::span<const double> volume_before) {
  ElementOrigins origins{.element = {}, .parent = {parent.begin(), parent.end()}, .scale = {}};
  const std::vector<double> volume = volumes(s.mesh);
  for (std::size_t e = 0; e < parent.size(); ++e) {
    origins.element.push_back(static_cast<std::int32_t>(e));
    origins.scale.push_back(volume[e] / volume_before[parent[e]]);
  }
  State state = make_state(s.model);
  restore_history(s.model, s.part, copies, origins, state);
  return state.history;
}

struct Compared {
  int n_with_local_steps = 0;
  std::vector<std::size_t> n_scaled{};  // elements, after each edit
};

void apply_and_rebuild(Simulation& s, GlobalState& global, const MeshEdit& edit,
                       Compared& compared) {
  const std::vector<std::int32_t> owner = s.node_owner;
  apply_edit_to_owners(edit, s.node_owner);
  EXPECT_TRUE(keeps_owners(s, edit));
  s.node_owner = owner;
  const std::vector<double> copies = copy_history(s.model, s.part, s.state);
  const std::vector<double> volume = volumes(s.mesh);
  const std::vector<std::int32_t> parent = wholes_of(s.mesh, edit);
  CutRecord record;
  apply_cut(s, edit, global, record);
  const Part part = s.part;
  const Model model = s.model;
  const Surface surface = s.surface;
  const std::vector<double> mass = s.mass, altitude = s.altitude;
  const double rest_step = s.rest_step, reach = s.look.reach;
  const std::int32_t n_pieces = s.n_pieces;
  const std::optional<MassScaling> scaling = s.mass_scaling;
  const std::optional<AddedMass> added = s.added_mass;
  const std::optional<Sleep> sleep = s.sleep;
  const std::optional<LocalStepPlan> local_steps = s.local_steps;
  const std::unique_ptr<MultiRate> multirate = std::move(s.multirate);
  rebuild_topology(s);
  ASSERT_EQ(s.scene.solver.is_multirate, local_steps.has_value());
  if (local_steps) {
    expect_equal(*local_steps, *s.local_steps);
    ASSERT_TRUE(!multirate || s.multirate);
    if (multirate) expect_equal(*multirate, *s.multirate);  // else it was given up
    compared.n_with_local_steps += multirate ? 1 : 0;
  }
  if (scaling) {
    expect_equal(*scaling, *s.mass_scaling);
    EXPECT_EQ(added->mass, s.added_mass->mass);
    compared.n_scaled.push_back(scaling->element.size());
  }
  if (sleep) expect_equal(*sleep, *s.sleep);
  expect_equal(part, s.part);
  expect_equal(model, s.model);
  expect_equal(surface, s.surface);
  EXPECT_TRUE(boundary_edges(s.surface).node.empty());  // closed, as follow_model takes it
  EXPECT_EQ(mass, s.mass);
  EXPECT_EQ(altitude, s.altitude);
  EXPECT_EQ(rest_step, s.rest_step);
  EXPECT_EQ(reach, s.look.reach);
  EXPECT_EQ(n_pieces, s.n_pieces);
  EXPECT_EQ(s.state.history, history_of(s, copies, parent, volume));
  EXPECT_EQ(s.model.n_history > 0, !copies.empty());
  watch_state(s);
}

TEST(Topology, after_an_edit_is_that_of_the_edited_mesh) {
  int n_with_local_steps = 0;
  for (const auto& [elements, solver] : solved_kinds)
    for (const int n_threads : {1, 2}) {
      const auto started = built(hanging_block({elements, "", solver}));
      set_thread_count(n_threads);
      Simulation& s = *started->s;
      if (n_threads == 2) make_half_stiffer(s);
      if (s.scene.solver.is_multirate) make_sliver(s);
      rebuild_topology(s);
      if (s.model.n_history > 0) bend_and_move(s);
      Compared compared;
      const int n_edits = for_edits(s, [&](GlobalState& global, const MeshEdit& edit) {
        apply_and_rebuild(s, global, edit, compared);
      });
      EXPECT_GE(n_edits, 4);
      EXPECT_EQ(s.n_pieces, 2);
      n_with_local_steps += compared.n_with_local_steps;
      const std::vector<std::size_t>& n_scaled = compared.n_scaled;
      if (s.mass_scaling) {
        EXPECT_NE(n_scaled.back(), n_scaled.front());
        std::printf("%s: %zu to %zu elements scaled, step at rest %.3g s\n", elements.c_str(),
                    n_scaled.front(), n_scaled.back(), s.rest_step);
      }
    }
  EXPECT_GE(n_with_local_steps, 10);
  set_thread_count(1);
}

// Nodes on edges, elements in place of others, then the cut.
TEST(Topology, after_elements_are_split_is_that_of_the_edited_mesh) {
  int n_with_local_steps = 0;
  for (const std::string elements : {"tet4-kuhn", "tet4-five"})
    for (const std::string& solver : {std::string(), std::string("precision = \"single\"\n"),
                                      std::string("tetrahedron = \"nodal-pressure\"\n"), viscosity,
                                      sleepy, scaled, in_local_steps, scaled + viscosity}) {
      const auto started = built(plate_of(elements, solver) + "[[support]]\nregion = \"x+\"\n");
      Simulation& s = *started->s;
      set_thread_count(elements == "tet4-five" ? 2 : 1);
      if (s.scene.solver.is_multirate)
        for (Vec3& X : s.mesh.X)
          if (X.x() < -0.025 && X.x() > -0.029) X.x() -= 0.9 * 0.06 / 13;
      rebuild_topology(s);
      for (std::size_t i = 0; i < s.mesh.X.size(); ++i)
        Vec3::Map(&s.state.u[3 * i]) = 0.03 * s.mesh.X[i].x() * Vec3::UnitX();
      if (s.model.n_history > 0) compute_force(s.model, s.state, s.scratch);
      watch_state(s);
      Compared compared;
      const PlateSplit done =
          split_plate(s, true, [&](GlobalState& global, const MeshEdit& edit, CutRecord&) {
            apply_and_rebuild(s, global, edit, compared);
          });
      EXPECT_GT(done.n_inserted, 300) << elements << " " << solver;
      EXPECT_GE(s.n_pieces, 2) << elements << " " << solver;
      n_with_local_steps += compared.n_with_local_steps;
    }
  EXPECT_GE(n_with_local_steps, 2);
  set_thread_count(1);
}

TEST(Topology, of_an_edit_changes_the_ledger_by_what_the_whole_body_gains) {
  for (const auto& [elements, solver] : solved_kinds) {
    const auto started = built(hanging_block({elements, "", "gravity = [1, 0, -9.81]\n" + solver}));
    Simulation& s = *started->s;
    open_energy_ledger(s);
    bend_and_move(s);
    const int n_edits = for_edits(s, [&](GlobalState& global, const MeshEdit& edit) {
      const EnergyState before = mechanical_energy(s);
      const double cut_before = s.energy->memory.works.cut;
      CutRecord record;
      apply_cut(s, edit, global, record);
      const double change = mechanical_energy(s).sum() - before.sum();
      EXPECT_GT(std::abs(change), 1e-6 * before.strain);
      // Rounding: of the sums of the whole energies to 1e-16 of them, of the terms in single
      // precision, which are the same numbers in both, not at all; but hexahedra in single
      // precision round positions from the least corner of the body, or of the patch.
      const double size = before.kinetic + before.strain + std::abs(before.gravity);
      const bool rounds = !s.model.position.empty();
      EXPECT_NEAR(s.energy->memory.works.cut - cut_before, change, (rounds ? 1e-8 : 1e-14) * size)
          << elements;
    });
    EXPECT_GE(n_edits, 4);
  }
}

bool is_inside(const Part& part, const Mesh& mesh, std::span<const std::int32_t> elements) {
  return !elements.empty() && std::ranges::all_of(nodes_of(mesh, elements), [&](std::int32_t i) {
    return part.owned(i) >= 0;
  });
}

// The parts and models of three ranks, all in this process.
TEST(Topology, of_each_rank_after_an_edit_is_that_of_the_edited_mesh) {
  int n_inside = 0, n_at_border = 0;  // edits
  for (std::size_t kind = 0; kind < solved_kinds.size(); ++kind) {
    const auto& [elements, solver] = solved_kinds[kind];
    const auto started = built(hanging_block({elements, "", solver}));
    set_thread_count(1 + static_cast<int>(kind % 2));
    Simulation& s = *started->s;
    s.corners = node_corners(s.mesh);
    // By METIS, or slabs across the blade's way.
    std::vector<std::int32_t> owner = partition_nodes(s.mesh, 3);
    if (kind % 3 != 0)
      for (std::size_t i = 0; i < owner.size(); ++i)
        owner[i] = s.mesh.X[i].x() < -0.006 ? 0 : s.mesh.X[i].x() < 0.006 ? 1 : 2;
    std::vector<Part> parts;
    std::vector<Halo> halos;
    std::vector<Model> models;
    for (int rank = 0; rank < 3; ++rank) {
      parts.push_back(make_part(s.mesh, owner, rank));
      halos.push_back(make_halo(s.mesh, owner, parts.back()));
      models.push_back(
          build_model(s.mesh, parts.back(), s.materials, s.fixed, s.mass, solver_options(s.scene)));
    }
    int n_edits = 0, n_splits = 0;
    for_edits(s, [&](GlobalState& global, const MeshEdit& edit) {
      apply_edit_to_owners(edit, owner);
      std::swap(owner, s.node_owner);
      const bool is_local = keeps_owners(s, edit);
      std::swap(owner, s.node_owner);
      std::vector<std::int32_t> edited = edited_elements(s.mesh, s.corners, edit);
      std::vector<std::int32_t> nodes = nodes_of(s.mesh, edited);
      edited = SplitNumbers(edit.splits, s.mesh.n_elements()).all_after(edited);
      CutRecord record;
      apply_cut(s, edit, global, record);
      for (const std::int32_t i : nodes_of(s.mesh, edited)) nodes.push_back(i);
      sort_unique(nodes);
      n_edits += is_local ? 1 : 0;
      for (std::size_t rank = 0; rank < 3; ++rank) {
        const Part part = make_part(s.mesh, owner, static_cast<int>(rank));
        const Halo halo = make_halo(s.mesh, owner, part);
        const Model model =
            build_model(s.mesh, part, s.materials, s.fixed, s.mass, solver_options(s.scene));
        if (is_local) {
          std::vector<double> history(static_cast<std::size_t>(models[rank].n_history));
          const std::vector<std::int32_t> place_before =
              split_elements(s.mesh, owner, edit.splits, parts[rank]);
          n_splits += place_before.empty() ? 0 : 1;
          update_part(s.mesh, s.corners, owner, nodes, parts[rank]);
          expect_equal(parts[rank], part);
          const std::vector<std::int32_t> touching = elements_around(s.corners, nodes);
          ++(is_inside(part, s.mesh, touching) ? n_inside : n_at_border);
          update_halo(s.mesh, s.corners, owner, touching, part, halos[rank]);
          expect_equal(halos[rank], halo);
          edit_model({.mesh = s.mesh,
                      .part = part,
                      .materials = s.materials,
                      .options = models[rank].options,
                      .fixed = s.fixed,
                      .mass = s.mass},
                     {edited, nodes, touching, place_before}, models[rank], history);
          expect_equal(models[rank], model);
        }
        parts[rank] = part;
        halos[rank] = halo;
        models[rank] = model;
      }
    });
    EXPECT_GE(n_edits, 3);
    EXPECT_GE(n_splits, elements == "hex8" ? 2 : 0);
  }
  EXPECT_GE(n_inside, 8);
  EXPECT_GE(n_at_border, 10);
  set_thread_count(1);
}

}  // namespace
}  // namespace trocar
