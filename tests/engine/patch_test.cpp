// The highest frequency that is looked for around an edit alone, against that of the whole body.
#include "engine/patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/digest.h"
#include "engine/body_search.h"
#include "engine/cut_stage.h"
#include "engine/frame_report.h"
#include "engine/frame_watch.h"
#include "engine_blocks.h"
#include "engine_scene.h"
#include "engine_started.h"
#include "solver/frequency.h"
#include "solver/history.h"

namespace trocar {
namespace {

const std::vector<BodyKind> kinds_to_cut = {
    {"tet4-kuhn", "", ""},
    {"tet4-five", "", ""},
    {"tet4-kuhn", "prony = [ { share = 0.4, time = 0.5 } ]\n",
     "tetrahedron = \"nodal-pressure\"\n"},
    {"hex8", "", ""},
    {"tet4-kuhn", "", "mass_scaling_step = \"0.16 ms\"\n"}};

// Cut from one side to beyond the middle.
std::string cut_scene_of(const BodyKind& kind) {
  const std::string solver = "gravity = [0, 0, -9.81]\n" + kind.solver;
  return hanging_block({kind.elements, kind.material, solver}) +
         "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.02\npath = [\n"
         "{ time = 0.01, position = [-0.03, 0.02, 0.01], direction = [0, 1, 0], "
         "forward = [1, 0, 0.2] },\n"
         "{ time = 0.10, position = [0.01, 0.02, 0.018], direction = [0, 1, 0], "
         "forward = [1, 0, 0.2] } ]\n";
}

double highest_frequency(RankBody& body, double amplitude, double tolerance) {
  State probe = body.state;
  const auto forces = [&](std::vector<double>& u, std::vector<double>& force) {
    probe.u = u;
    find_force(body.model, body.neighbours, probe, body.scratch);
    force = body.scratch.force;
  };
  const HighestFrequency found = find_highest_frequency(
      body.model, body.part, body.state, forces,
      {.amplitude = amplitude, .tolerance = tolerance, .most_iterations = 1000}, Communicator());
  EXPECT_TRUE(found.is_converged);
  return found.omega;
}

// Nodes that a frame's edit moved or added.
std::vector<std::int32_t> edited_nodes(const std::vector<Vec3>& X_before, const Mesh& mesh) {
  std::vector<std::int32_t> edited;
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (i >= std::ssize(X_before) || mesh.X[i] != X_before[i]) edited.push_back(i);
  return edited;
}

// The body as it is, around these nodes, in n_rings, patch_rings at least.
std::unique_ptr<Patch> patch_of(Simulation& s, std::span<const std::int32_t> edited, int n_rings) {
  GlobalState global = gather_state(s);
  const std::vector<double> history = copy_history(s.model, s.part, s.state);
  const ElementOrigins origins = unedited_elements(s.mesh.n_elements());
  std::vector<std::int32_t> elements = elements_around(s.corners, edited);
  for (int ring = patch_rings; ring < n_rings; ++ring)
    elements = elements_around(s.corners, nodes_of(s.mesh, elements));
  return make_patch(s, elements, {.global = global, .history = history, .origins = &origins});
}

// Bent, and shaken by `noise` [m]; watched.
void deform(Simulation& s, double shear, double noise) {
  for (std::size_t i = 0; i < s.part.node_global.size(); ++i) {
    const auto global = static_cast<std::uint64_t>(s.part.node_global[i]);
    const Vec3 X = s.mesh.X[global];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto bits = mix64(3 * global + k) >> 11;
      s.state.u[3 * i + k] = noise * (static_cast<double>(bits) * 0x1p-52 - 1);
    }
    s.state.u[3 * i] += shear * (0.032 - X[2]) + 10 * shear * X[1] * X[1];
  }
  s.look.is_done = false;
  watch_state(s);
}

struct ShearAndNoise {
  double shear, noise;
};
constexpr ShearAndNoise deformations[] = {{0, 0}, {0.15, 0}, {0, 4e-4}, {-0.1, 2e-4}};

// A frame's cut, in the body as it stands. False if there was nothing to cut.
bool cut_at_rest(Simulation& s) {
  const double rate = s.scene.time.frame_rate, t0 = static_cast<double>(s.frame++) / rate;
  s.log.new_edits.clear();
  cut_along_blades(s, {.t0 = t0, .t1 = t0 + 1 / rate});
  refresh_surface(s);
  return !s.log.new_edits.empty();
}

void expect_modes_in_patch(Simulation& s, const std::vector<Vec3>& X_before, double before) {
  const double h = search_amplitude(s.model, s.edge_length), after = highest_frequency(s, h, 1e-3);
  const std::vector<std::int32_t> edited = edited_nodes(X_before, s.mesh);
  for (int n_rings = patch_rings; n_rings <= 3; ++n_rings) {
    const auto patch = patch_of(s, edited, n_rings);
    const double omega = highest_frequency(*patch, h, 1e-3);
    std::printf("%d rings: %d of %d elements, %.4f of the body's, before %.4f\n", n_rings,
                patch->sub.mesh.n_elements(), s.mesh.n_elements(), omega / after, before / after);
    // A body with more held is never faster; differences and the search leave 1e-3.
    EXPECT_LT(omega, 1.001 * after);
    // Half of what the step's margin is: the rest is for searches that stop early.
    if (n_rings != patch_rings) continue;
    EXPECT_GT(std::max(before, omega) / after, 1 - (frequency_margin - 1) / 2);
  }
  EXPECT_LT(s.watch.stable_step, 2 / after);
}

// Modes that an edit made faster are in the patch: the faster of what was and what it has is the
// body's highest frequency, up to what a search leaves out. The body stands still, so that all that
// changes is the edit.
TEST(Patch, has_the_mode_that_an_edit_made_the_fastest) {
  for (const BodyKind& kind : kinds_to_cut)
    for (const auto& [shear, noise] : deformations) {
      const auto started = built(cut_scene_of(kind));
      Simulation& s = *started->s;
      deform(s, shear, noise);
      refresh_surface(s);
      int n_edits = 0;
      std::printf("%s, shear %.2f, noise %.1e m\n", kind.elements.c_str(), shear, noise);
      while (s.frame < 12) {
        const std::vector<Vec3> X_before = s.mesh.X;
        const double before = highest_frequency(s, search_amplitude(s.model, s.edge_length), 1e-3);
        if (!cut_at_rest(s)) continue;
        ++n_edits;
        expect_modes_in_patch(s, X_before, before);
      }
      EXPECT_GE(n_edits, 3);
    }
}

// Where nothing else sets the step, the one taken after an edit is that of a search through the
// body, from nothing: never longer by more than either search's margin.
TEST(Patch, never_gives_a_longer_step_than_a_search_of_the_whole_body) {
  for (const BodyKind& kind : kinds_to_cut) {
    const auto started = built(cut_scene_of(kind));
    Simulation& s = *started->s;
    Outputs outputs;
    std::int64_t n_edits = 0;
    while (s.frame < 12) {
      run_frame(s, outputs);
      if (s.cuts[0].strokes.empty() || s.cuts[0].strokes[0].n_edits == n_edits) continue;
      n_edits = s.cuts[0].strokes[0].n_edits;
      const double whole = search_step(s, search_amplitude(s.model, s.edge_length), Communicator());
      ASSERT_GT(whole, 0);
      EXPECT_LT(s.watch.stable_step / whole, frequency_margin) << kind.elements;
    }
    EXPECT_GE(n_edits, 3);
  }
}

}  // namespace
}  // namespace trocar
