// What an edit changes in part, model, masses and surface, against making them from the edited
// mesh.
#include "engine/apply_cut_topology.h"

#include <gtest/gtest.h>

#include "base/threads.h"
#include "engine/apply_cut.h"
#include "engine/frame_watch.h"
#include "engine_scene.h"
#include "engine_started.h"
#include "mesh/surface_edit.h"
#include "solver/model_edit.h"
#include "solver_model_equal.h"

namespace trocar {
namespace {

// 40 x 32 x 32 mm in cells of 4 mm, hanging.
std::string scene_of(const std::string& elements, const std::string& solver) {
  return "[time]\nduration = \"1 s\"\nframe_rate = 100\n[tissue.shape]\nkind = \"box\"\n"
         "low = [-0.02, -0.016, 0]\nhigh = [0.02, 0.016, 0.032]\ncells = [10, 8, 8]\n"
         "elements = \"" +
         elements +
         "\"\n[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0.4\ndensity = 1000\n"
         "[solver]\n" +
         solver + "[[support]]\nregion = \"z+\"\nfix = \"xyz\"\n";
}

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
  return cutter.advance(s.mesh, global.x, held_nodes(s.holds, s.fixed), sweep, k == n_bands - 1,
                        figures);
}

void expect_equal(const Part& a, const Part& b) {
  EXPECT_EQ(a.rank, b.rank);
  EXPECT_EQ(a.n_owned, b.n_owned);
  EXPECT_EQ(a.node_global, b.node_global);
  EXPECT_EQ(a.element_global, b.element_global);
  EXPECT_EQ(a.node_local, b.node_local);
}

void expect_equal(const Surface& a, const Surface& b) {
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.element, b.element);
  EXPECT_EQ(a.is_cut, b.is_cut);
  EXPECT_EQ(a.is_quad_half, b.is_quad_half);
  EXPECT_EQ(a.node, b.node);
}

const std::vector<std::pair<std::string, std::string>> kinds = {
    {"tet4-kuhn", ""},
    {"tet4-five", "precision = \"single\"\n"},
    {"tet4-kuhn", "tetrahedron = \"nodal-pressure\"\n"}};

TEST(Topology, after_an_edit_is_that_of_the_edited_mesh) {
  for (const auto& [elements, solver] : kinds)
    for (const int n_threads : {1, 2}) {
      const auto started = built(scene_of(elements, solver));
      set_thread_count(n_threads);
      Simulation& s = *started->s;
      rebuild_topology(s);
      TetCutter cutter{CutTetOptions{}};
      int n_edits = 0;
      for (int k = 0; k < n_bands; ++k) {
        GlobalState global = gather_state(s);
        const MeshEdit edit = next_edit(s, global, cutter, k);
        if (edit.is_empty()) continue;
        ++n_edits;
        const std::vector<std::int32_t> owner = s.node_owner;
        apply_edit_to_owners(edit.duplicate_parent, s.node_owner);
        EXPECT_TRUE(keeps_places(s, edit));
        s.node_owner = owner;
        CutRecord record;
        apply_cut(s, edit, global, record);
        const Part part = s.part;
        const Model model = s.model;
        const Surface surface = s.surface;
        const std::vector<double> mass = s.mass, altitude = s.altitude;
        const double rest_step = s.rest_step, reach = s.look.reach;
        const std::int32_t n_pieces = s.n_pieces;
        rebuild_topology(s);
        expect_equal(part, s.part);
        expect_equal(model, s.model);
        expect_equal(surface, s.surface);
        EXPECT_EQ(mass, s.mass);
        EXPECT_EQ(altitude, s.altitude);
        EXPECT_EQ(rest_step, s.rest_step);
        EXPECT_EQ(reach, s.look.reach);
        EXPECT_EQ(n_pieces, s.n_pieces);
        watch_state(s);
      }
      EXPECT_GE(n_edits, 4);
      EXPECT_EQ(s.n_pieces, 2);
    }
  set_thread_count(1);
}

// The parts and models of three ranks, all in this process.
TEST(Topology, of_each_rank_after_an_edit_is_that_of_the_edited_mesh) {
  for (const auto& [elements, solver] : kinds) {
    const auto started = built(scene_of(elements, solver));
    Simulation& s = *started->s;
    std::vector<std::int32_t> owner = partition_nodes(s.mesh, 3);
    std::vector<Part> parts;
    std::vector<Model> models;
    for (int rank = 0; rank < 3; ++rank) {
      parts.push_back(make_part(s.mesh, owner, rank));
      models.push_back(
          build_model(s.mesh, parts.back(), s.materials, s.fixed, s.mass, solver_options(s.scene)));
    }
    TetCutter cutter{CutTetOptions{}};
    int n_edits = 0;
    for (int k = 0; k < n_bands; ++k) {
      GlobalState global = gather_state(s);
      const MeshEdit edit = next_edit(s, global, cutter, k);
      if (edit.is_empty()) continue;
      apply_edit_to_owners(edit.duplicate_parent, owner);
      std::swap(owner, s.node_owner);
      const bool is_local = keeps_places(s, edit);
      std::swap(owner, s.node_owner);
      const std::vector<std::int32_t> edited = edited_elements(s.mesh, edit);
      std::vector<std::int32_t> nodes = nodes_of(s.mesh, edited);
      CutRecord record;
      apply_cut(s, edit, global, record);
      for (const std::int32_t i : nodes_of(s.mesh, edited)) nodes.push_back(i);
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      n_edits += is_local ? 1 : 0;
      for (std::size_t rank = 0; rank < 3; ++rank) {
        const Part part = make_part(s.mesh, owner, static_cast<int>(rank));
        const Model model =
            build_model(s.mesh, part, s.materials, s.fixed, s.mass, solver_options(s.scene));
        if (is_local) {
          update_part(s.mesh, s.corners, owner, nodes, parts[rank]);
          expect_equal(parts[rank], part);
          edit_model({.mesh = s.mesh,
                      .part = part,
                      .materials = s.materials,
                      .fixed = s.fixed,
                      .mass = s.mass},
                     edited, nodes, models[rank]);
          expect_equal(models[rank], model);
        }
        parts[rank] = part;
        models[rank] = model;
      }
    }
    EXPECT_GE(n_edits, 3);
  }
}

}  // namespace
}  // namespace trocar
