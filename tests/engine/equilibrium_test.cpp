// The body before the first frame: closed forms, where long damped motion ends, and what is
// refused.
#include "engine/equilibrium.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine_motion.h"
#include "engine_scene.h"
#include "engine_started.h"

namespace trocar {
namespace {

// A column of 2 x 2 x 5 cm on its lower side, 9.81 m/s^2 downwards.
std::string column_text(const std::string& elements, const std::string& material,
                        const std::string& more = "") {
  return "[time]\nduration = \"1 s\"\n[start]\nstate = \"equilibrium\"\n"
         "[tissue.shape]\nkind = \"box\"\nlow = [0, 0, 0]\nhigh = [0.02, 0.02, 0.05]\n"
         "cells = [2, 2, 5]\nelements = \"" +
         elements + "\"\n[tissue.material]\n" + material +
         "[[support]]\nregion = \"z-\"\n[checkpoint]\nevery = 0\n" + more;
}

const std::string downwards = "[solver]\ngravity = [0, 0, -9.81]\n";
const std::string soft_tissue = "young_modulus = 6000\npoisson_ratio = 0.4\ndensity = 1000\n";
const std::string viscous_tissue =
    soft_tissue + "prony = [ { share = 0.4, time = 0.02 }, { share = 0.1, time = 0.1 } ]\n";
// A plane body that hangs from its left side.
const std::string plane_text =
    "[time]\nduration = \"1 s\"\n[start]\nstate = \"equilibrium\"\n"
    "[tissue]\nthickness = 0.005\n[tissue.shape]\nkind = \"triangular-rectangle\"\n"
    "high = [0.04, 0.02, 0]\ncells = [9, 5, 1]\n[tissue.material]\n" +
    soft_tissue + "[[support]]\nregion = \"x-\"\n[checkpoint]\nevery = 0\n" +
    "[solver]\ngravity = [0, -9.81, 0]\n";

std::unique_ptr<Started> started_at_rest(const std::string& text,
                                         const std::vector<std::string>& overrides = {}) {
  auto result = built(text, overrides);
  start_in_equilibrium(result->loaded, *result->s);
  return result;
}

TEST(Equilibrium, of_a_linear_column_under_its_own_weight_is_the_closed_form) {
  // nu = 0: E u'' = rho g with u(0) = 0 and u'(H) = 0 gives u = -rho g / E (H z - z^2/2), which
  // lumped masses and linear elements meet at their nodes.
  const auto column = started_at_rest(
      column_text("hex8",
                  "model = \"linear\"\nyoung_modulus = 6000\npoisson_ratio = 0\ndensity = 1000\n",
                  downwards),
      {"start.tolerance=1e-10"});
  const Simulation& s = *column->s;
  const double H = 0.05, scale = 1000 * 9.81 / 6000;
  for (std::size_t i = 0; i < s.mesh.X.size(); ++i) {
    const double z = s.mesh.X[i].z();
    // The residual of 1e-10, and the rounding of the supports' forces.
    EXPECT_NEAR(s.state.u[3 * i + 2], -scale * (H * z - z * z / 2), 1e-7 * scale * H * H);
  }
  EXPECT_EQ(s.state.time, 0);
  EXPECT_EQ(s.state.step, 0);
  EXPECT_EQ(largest(s.state.v), 0);
  EXPECT_GT(s.log.equilibrium.iterations, 0);
  EXPECT_LE(s.log.equilibrium.residual, 1e-10);
}

// Frames until time, from the undeformed body, with damping near that of its slowest mode.
void settle(Simulation& s, double time) {
  Outputs outputs;
  while (static_cast<double>(s.frame) < time * s.scene.time.frame_rate) run_frame(s, outputs);
}

TEST(Equilibrium, is_where_long_damped_motion_ends) {
  // The slowest mode of all has more than 2 pi / s, so that 3 s with 60 / s leave less than 1e-4.
  const struct {
    std::string text, override;
  } bodies[] = {
      {column_text("hex8", soft_tissue, downwards), "solver.precision='double'"},
      {column_text("hex8", soft_tissue, downwards), "solver.precision='single'"},
      {column_text("tet4-five", soft_tissue, downwards), "solver.tetrahedron='nodal-pressure'"},
      {column_text("tet4-kuhn", viscous_tissue, downwards), "solver.tetrahedron='linear'"},
      {column_text("hex8", viscous_tissue, downwards), "solver.hexahedron='full'"},
      {plane_text, "solver.triangle='plane-strain'"}};
  for (const auto& body : bodies) {
    const auto found = started_at_rest(body.text, {body.override});
    const auto moved = built(body.text, {body.override, "solver.mass_damping=60"});
    settle(*moved->s, 3);
    const std::vector<double>& u = found->s->state.u;
    // Residuals of 3e-5 act on the slowest mode some ten times as much.
    EXPECT_LT(largest_difference(moved->s->state.u, u), 1e-3 * largest(u)) << body.override;
    EXPECT_GT(largest(u), 1e-3);
  }
}

TEST(Equilibrium, keeps_the_first_frames_at_rest) {
  for (const std::string& material : {soft_tissue, viscous_tissue}) {
    const std::string text = column_text("hex8", material, downwards) +
                             "[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\n";
    const auto rest = started_at_rest(text, {"start.tolerance=1e-7"}), fall = built(text);
    EXPECT_EQ(rest->s->energy->memory.works.sum(), 0);
    const std::vector<double> u = rest->s->state.u;
    settle(*rest->s, 0.2);
    settle(*fall->s, 0.2);
    const FrameRow &calm = rest->s->log.rows.back(), &wild = fall->s->log.rows.back();
    // Kinetic energy goes with the square of what is out of balance: 1e-14, and mode by mode more.
    EXPECT_LT(calm.energy.kinetic, 1e-10 * calm.energy.strain);
    EXPECT_GT(wild.energy.kinetic + wild.energy.strain, 0.1 * calm.energy.strain);
    EXPECT_LT(largest_difference(rest->s->state.u, u), 1e-5 * largest(u));
    EXPECT_LT(std::abs(calm.energy_error), 1e-6 * calm.energy.strain);
  }
}

TEST(Equilibrium, has_moving_supports_where_they_are_at_the_beginning) {
  // Without gravity the free body follows its one support as a whole.
  const auto moved =
      started_at_rest(column_text("hex8", soft_tissue), {"support=[{region='z+', path=[{time=0.5, "
                                                         "displacement=[1e-3, 0, 2e-3]}]}]"});
  for (std::size_t i = 0; i < moved->s->mesh.X.size(); ++i)
    EXPECT_LT((Vec3::Map(&moved->s->state.u[3 * i]) - Vec3(1e-3, 0, 2e-3)).norm(), 1e-6) << i;
}

// Steps until the body, let go undeformed, stays as near to u as `error` for ten frames.
std::int64_t steps_to_settle(Simulation& s, const std::vector<double>& u, double error) {
  Outputs outputs;
  std::int64_t n_steps = 0;
  for (int n_near = 0; n_near < 10 && s.frame < 600; ++n_near) {
    run_frame(s, outputs);
    if (largest_difference(s.state.u, u) <= error) continue;
    n_near = -1;
    n_steps = s.state.step;
  }
  return n_steps;
}

TEST(Equilibrium, takes_less_work_than_waiting_until_the_body_has_settled) {
  // A cylinder of tetrahedra, squeezed where its square mesh was made round; to the accuracy that
  // relaxing has with its default tolerance.
  const std::string text = column_text("tet4-kuhn", soft_tissue, downwards);
  const std::vector<std::string> shape = {"tissue.shape.kind='cylinder'",
                                          "tissue.shape.radius=0.02", "tissue.shape.height=0.06",
                                          "tissue.shape.cells=[6,6,9]"};
  std::vector<std::string> settings = shape;
  const auto found = started_at_rest(text, settings);
  settings.push_back("start.tolerance=1e-9");
  const auto exact = started_at_rest(text, settings);
  const std::vector<double>& u = exact->s->state.u;
  const double error = largest_difference(found->s->state.u, u);
  // The bundled scenes have 15 to 20 / s. Damping tuned by trial to the slowest mode of this body,
  // 60 / s, would settle in half the steps that relaxing takes without being told anything.
  for (const char* damping : {"solver.mass_damping=5", "solver.mass_damping=15"}) {
    settings = shape;
    settings.emplace_back(damping);
    const auto moved = built(text, settings);
    const std::int64_t n_steps = steps_to_settle(*moved->s, u, error);
    std::printf("%s: %lld steps until %.1e of the largest displacement, relaxing %lld iterations\n",
                damping, static_cast<long long>(n_steps), error / largest(u),
                static_cast<long long>(found->s->log.equilibrium.iterations));
    EXPECT_LT(found->s->log.equilibrium.iterations, n_steps) << damping;
  }
}

TEST(Equilibrium, does_not_exist_for_a_body_that_nothing_holds_against_gravity) {
  const auto sentence = [](const std::string& text, const std::string& override) {
    return error_of([&] { built(text, {override}); });
  };
  const std::string text = column_text("hex8", soft_tissue, downwards);
  EXPECT_TRUE(contains(sentence(text, "support=[]"), "along z")) << sentence(text, "support=[]");
  EXPECT_TRUE(contains(sentence(text, "support=[{region='z-', fix='xy'}]"), "node 0 along z"));
  EXPECT_EQ(sentence(text, "support=[{region='z-', fix='z'}]"), "");
  EXPECT_EQ(sentence(column_text("hex8", soft_tissue), "support=[]"), "");
  EXPECT_TRUE(contains(sentence(plane_text, "support=[]"), "along y"));
}

TEST(Equilibrium, does_not_exist_for_a_body_that_nothing_holds_against_loads) {
  const auto sentence = [](const std::string& loads) {
    return error_of([&] { built(column_text("hex8", soft_tissue) + loads, {"support=[]"}); });
  };
  const std::string up = "[[load]]\nregion = \"z+\"\nforce = [0, 0, 0.01]\n",
                    down = "[[load]]\nregion = \"z-\"\nforce = [0, 0, -0.01]\n";
  EXPECT_TRUE(contains(sentence(up), "no support holds the body along z, and loads move it there"))
      << sentence(up);
  EXPECT_EQ(sentence(up + down), "");
}

TEST(Equilibrium, that_is_not_found_is_named_and_leaves_the_body_undeformed) {
  const auto few = built(column_text("hex8", soft_tissue, downwards), {"start.max_iterations=50"});
  const std::string sentence =
      error_of<SimulationError>([&] { start_in_equilibrium(few->loaded, *few->s); });
  EXPECT_TRUE(contains(sentence, "after 50 iterations (start.max_iterations)")) << sentence;
  EXPECT_EQ(largest(few->s->state.u), 0);
}

TEST(Equilibrium, is_not_sought_on_after_a_signal) {
  const auto column = built(column_text("hex8", soft_tissue, downwards));
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(start_in_equilibrium(column->loaded, *column->s, &stop));
  EXPECT_EQ(column->s->log.equilibrium.iterations, 0);
  EXPECT_EQ(largest(column->s->state.u), 0);
}

TEST(Equilibrium, is_refused_with_an_instrument_inside_the_body) {
  const auto sentence = [](const std::string& height) {
    return error_of([&] {
      started_at_rest(
          column_text("hex8", soft_tissue, downwards) +
          instrument_text("probe", "{ time = 0, position = [0.01, 0.01, " + height + "] }"));
    });
  };
  EXPECT_TRUE(contains(sentence("0.03"), "\"probe\" reaches")) << sentence("0.03");
  EXPECT_TRUE(contains(sentence("0.03"), "instrument[0].path[0].position"));
  EXPECT_EQ(sentence("0.2"), "");
}

TEST(Equilibrium, in_single_precision_is_not_asked_for_closer_than_its_rounding) {
  const std::string text = scene_text("[solver]\nprecision = \"single\"\n[start]\n");
  EXPECT_TRUE(
      contains(scene_error(text + "state = \"equilibrium\"\ntolerance = 1e-6\n"), "3e-5 or more"));
  EXPECT_EQ(scene_error(text + "state = \"equilibrium\"\n"), "");
  EXPECT_EQ(scene_error(text + "tolerance = 1e-6\n"), "");
  EXPECT_NE(scene_error(text + "state = \"resting\"\n"), "");
}

}  // namespace
}  // namespace trocar
