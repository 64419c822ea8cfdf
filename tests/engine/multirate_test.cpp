// Local steps in whole scenes: what they save, what they change, and what they live together with.
// The same bits on any ranks and threads: tests/invariance; stability and order: tests/solver.
#include "solver/multirate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/body_search.h"
#include "engine/equilibrium.h"
#include "engine_checkpoint.h"
#include "engine_motion.h"
#include "engine_scene.h"
#include "engine_split.h"
#include "engine_started.h"
#include "larger_or_nan.h"
#include "mesh_fixtures.h"
#include "mesh_write.h"
#include "scene_parts.h"
#include "solver/frequency.h"

namespace trocar {
namespace {

// Hung at its left side, with thin elements at 5 mm; a probe presses them from above, a grasper
// pulls them down.
const std::string hung_text = time_table("1 s") + "[checkpoint]\nevery = 0\n" + tissue_of_kpa(6) +
                              solver_table("-2", 20) + held_left;
const std::string tools_text = probe_along(R"(
  { time = 0, position = ["40 mm", "15 mm", "34 mm"] },
  { time = 0.3, position = ["40 mm", "15 mm", "26 mm"] },
)") + grasper_along("7 mm", R"(
  { time = 0, position = ["70 mm", "-20 mm", "-20 mm"] },
  { time = 0.15, position = ["70 mm", 0, 0], action = "close" },
  { time = 0.4, position = ["72 mm", "-3 mm", "-2 mm"] },
)");
const std::string scalpel_text = scalpel_along("40 mm", R"(
  { time = 0.1, position = ["32 mm", "-6 mm", "12 mm"], forward = [0, 1, 0] },
  { time = 0.5, position = ["30 mm", "20 mm", "12 mm"], forward = [0, 1, 0] },
)");

std::unique_ptr<Started> hung(const std::string& tools, BoxElements elements,
                              const std::vector<std::string>& overrides) {
  const TestFolder folder;
  write_mesh(with_thin_layer(elements, 2), folder.file("m.msh"));
  std::vector<std::string> all = overrides;
  all.push_back("tissue.mesh='" + folder.file("m.msh") + "'");
  return built(hung_text + tools, all);
}

void run_to_frame(Started& started, std::int64_t frame) {
  while (started.s->frame < frame) run_frame(*started.s, started.outputs);
}

const std::string held_left_of_plate = R"([[region]]
name = "left"
low = ["-31 mm", "-21 mm", "-1 mm"]
high = ["-29 mm", "21 mm", "6 mm"]
[[support]]
region = "left"
)";
const std::vector<std::string> with_local_steps = {"solver.multirate=true"};

// Both differ from the exact motion by their steps' squares; the finer run is nearly exact.
TEST(MultiRate, halves_the_steps_of_a_pressed_and_pulled_body_and_keeps_its_motion) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    const auto plain = hung(tools_text, elements, {}),
               with = hung(tools_text, elements, with_local_steps),
               exact = hung(tools_text, elements, {"solver.step_factor=0.25"});
    ASSERT_TRUE(with->s->multirate);
    EXPECT_FALSE(plain->s->multirate);
    double of_plain = 0, of_with = 0;
    for (std::int64_t frame = 1; frame <= 20; ++frame) {
      for (Started* run : {plain.get(), with.get(), exact.get()}) run_to_frame(*run, frame);
      of_plain = larger_or_nan(of_plain, largest_difference(plain->s->state.u, exact->s->state.u));
      of_with = larger_or_nan(of_with, largest_difference(with->s->state.u, exact->s->state.u));
    }
    const std::vector<double> rest(exact->s->state.u.size(), 0.0);
    const double moved = largest_difference(exact->s->state.u, rest);
    EXPECT_LT(with->s->state.step, .55 * static_cast<double>(plain->s->state.step));
    EXPECT_GT(moved, 2e-3);
    EXPECT_LT(of_with, .02 * moved);
    std::printf(
        "%lld steps instead of %lld; largest error %.2g mm instead of %.2g mm, motion %.2g mm\n",
        static_cast<long long>(with->s->state.step), static_cast<long long>(plain->s->state.step),
        1e3 * of_with, 1e3 * of_plain, 1e3 * moved);
  }
}

// Beside the layer: all elements take the small ones' step then, as without.
TEST(MultiRate, leaves_a_body_that_is_touched_at_small_elements_as_without) {
  const std::string pressed = probe_along(R"(
  { time = 0, position = ["12 mm", "15 mm", "34 mm"] },
  { time = 0.3, position = ["12 mm", "15 mm", "26 mm"] },
)");
  const std::string metrics = "output=[{kind='metrics',file='m.csv'}]";
  const auto plain = hung(pressed, BoxElements::hex8, {metrics}),
             with = hung(pressed, BoxElements::hex8, {metrics, with_local_steps[0]});
  for (Started* run : {plain.get(), with.get()}) run_to_frame(*run, 20);
  ASSERT_TRUE(with->s->multirate);
  EXPECT_LT(with->s->state.step, 1.1 * static_cast<double>(plain->s->state.step));
  const FrameRow &a = plain->s->log.rows.back(), &b = with->s->log.rows.back();
  EXPECT_NE(a.works.contact, 0);
  // The first steps, before the probe comes near, are local ones; their error falls with the square
  // of the step.
  EXPECT_NEAR(b.tools[0].force.z(), a.tools[0].force.z(), 0.03 * a.tools[0].force.norm());
  EXPECT_LT(std::abs(b.energy_error), 1e-3 * b.energy.strain);
}

double largest_balance_error(const Simulation& s) {
  double error = 0, turned_over = 0;
  for (const FrameRow& row : s.log.rows) {
    error = larger_or_nan(error, std::abs(row.energy_error));
    turned_over = std::max({turned_over, row.energy.strain, row.energy.kinetic,
                            std::abs(row.works.contact), std::abs(row.works.holds)});
  }
  return error / turned_over;
}

// Up to the scheme's own error, which falls with the square of the step.
TEST(MultiRate, energy_ledger_closes_with_contact_and_holds) {
  double error[2];
  for (const int k : {0, 1}) {
    const auto run = hung(tools_text, BoxElements::tet4_kuhn,
                          {"output=[{kind='metrics',file='m.csv'}]", "solver.multirate=true",
                           k == 0 ? "solver.step_factor=0.8" : "solver.step_factor=0.2"});
    run_to_frame(*run, 20);
    EXPECT_NE(run->s->log.rows.back().works.contact, 0);
    EXPECT_NE(run->s->log.rows.back().works.holds, 0);
    error[k] = largest_balance_error(*run->s);
  }
  std::printf("energy balance: %.2g of what was turned over, with a quarter of the step %.2g\n",
              error[0], error[1]);
  EXPECT_LT(error[0], .02);
  EXPECT_LT(error[1], error[0] / 8);  // 16 but for impacts
}

// Forces of loads count in the substeps, or loaded small elements would go elsewhere in them.
TEST(MultiRate, leaves_a_loaded_body_in_its_equilibrium) {
  const std::string text =
      "[start]\nstate = \"equilibrium\"\ntolerance = 1e-9\n[[region]]\nname = \"thin\"\n"
      "low = [\"4 mm\", \"-1 mm\", \"29 mm\"]\nhigh = [\"12 mm\", \"31 mm\", \"31 mm\"]\n"
      "[[load]]\nregion = \"thin\"\npressure = 300\nforce = [0.02, 0, 0]\n";
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    const auto run =
        hung(text, elements, {"solver.multirate=true", "output=[{kind='metrics',file='m.csv'}]"});
    start_in_equilibrium(run->loaded, *run->s);
    ASSERT_TRUE(run->s->multirate);
    const std::vector<double> u = run->s->state.u;
    run_to_frame(*run, 20);
    EXPECT_LT(largest_difference(run->s->state.u, u), 1e-8);
    const FrameRow& row = run->s->log.rows.back();
    EXPECT_LT(std::abs(row.energy_error), 1e-9 * row.energy.strain);
  }
}

TEST(MultiRate, goes_on_after_a_cut_and_after_a_restart_with_the_same_bits) {
  const auto cut = [] { return hung(scalpel_text, BoxElements::tet4_kuhn, with_local_steps); };
  const auto whole = cut();
  const std::int32_t n_before = whole->s->mesh.n_nodes();
  run_to_frame(*whole, 20);
  EXPECT_GT(whole->s->mesh.n_nodes(), n_before);
  ASSERT_TRUE(whole->s->multirate);
  EXPECT_EQ(whole->s->multirate->of_whole.size(),
            static_cast<std::size_t>(whole->s->mesh.n_nodes()));
  for (const std::int64_t frame : {4, 12}) {
    const auto first = cut();
    run_to_frame(*first, frame);
    const std::vector<std::byte> bytes = checkpoint_to_bytes(take_checkpoint(*first->s));
    const auto second = cut();
    restore_checkpoint(checkpoint_from_bytes(bytes, "c"), *second->s);
    run_to_frame(*second, 20);
    EXPECT_EQ(second->s->state.u, whole->s->state.u) << frame;
    EXPECT_EQ(second->s->state.v, whole->s->state.v) << frame;
  }
}

// A later search would find that these don't pay: steps that an earlier one has kept stay, others
// are given up.
TEST(MultiRate, is_judged_once_through_cuts_and_a_restart) {
  for (const bool is_judged : {true, false}) {
    const auto whole = hung(scalpel_text, BoxElements::tet4_kuhn, with_local_steps),
               resumed = hung(scalpel_text, BoxElements::tet4_kuhn, with_local_steps);
    Simulation& s = *whole->s;
    const std::int32_t n_before = s.mesh.n_nodes();
    run_to_frame(*whole, 12);
    EXPECT_GT(s.mesh.n_nodes(), n_before);
    ASSERT_TRUE(s.multirate);
    EXPECT_TRUE(s.multirate->is_judged);  // at time 0
    s.multirate->is_judged = is_judged;   // or that search had not ended
    s.look.at_step = s.state.step - most_steps_of_search;
    const std::vector<std::byte> bytes = checkpoint_to_bytes(take_checkpoint(s));
    restore_checkpoint(checkpoint_from_bytes(bytes, "c"), *resumed->s);
    ASSERT_TRUE(resumed->s->multirate);
    EXPECT_EQ(resumed->s->multirate->is_judged, is_judged);
    const std::int64_t n_searches = s.log.searches.n_of_body;
    for (Started* run : {whole.get(), resumed.get()}) {
      run->s->multirate->share = 100;
      run_to_frame(*run, 14);
      EXPECT_EQ(run->s->multirate != nullptr, is_judged);
    }
    EXPECT_GT(s.log.searches.n_of_body, n_searches);
    EXPECT_EQ(resumed->s->state.u, s.state.u);
    EXPECT_EQ(resumed->s->state.v, s.state.v);
  }
}

// From the frame on in which it comes to the tissue.
TEST(MultiRate, leaves_a_body_to_a_blade_that_meets_resistance_as_without) {
  const auto run = hung(scalpel_text, BoxElements::tet4_kuhn,
                        {"solver.multirate=true", "cutting.resistance='20 N/m'"});
  Simulation& s = *run->s;
  int n_before = 0, n_dragged = 0;
  while (s.frame < 14) {
    run_frame(s, run->outputs);
    const bool is_dragged = !s.cuts[0].resisted.empty();
    n_dragged += is_dragged ? 1 : 0;
    n_before += n_dragged == 0 && s.has_local_steps ? 1 : 0;
    EXPECT_FALSE(is_dragged && s.has_local_steps) << s.frame;
  }
  EXPECT_GT(n_before, 2);
  EXPECT_GT(n_dragged, 2);
}

// The plate with a row of thin cells.
TEST(MultiRate, goes_on_after_a_split_and_after_a_restart_with_the_same_bits) {
  const TestFolder folder;
  const auto plain = built(plate_of("tet4-five"));
  Mesh mesh = plain->s->mesh;
  for (Vec3& X : mesh.X)
    if (std::abs(X.x() - mesh.X[5].x()) < 1e-9) X.x() += 0.8 * 0.06 / 13;
  write_mesh(mesh, folder.file("m.msh"));
  std::string text = plate_of("tet4-five") + held_left_of_plate + plate_blade;
  const std::size_t from = text.find("[tissue.shape]"), to = text.find("[tissue.material]");
  text.replace(from, to - from, "[tissue]\nmesh = \"" + folder.file("m.msh") + "\"\n");
  const auto whole = built(text, with_local_steps);
  ASSERT_TRUE(whole->s->multirate);
  const std::int32_t n_before = whole->s->mesh.n_elements();
  run_to_frame(*whole, 24);
  EXPECT_GT(whole->s->mesh.n_elements(), n_before + 1000);
  for (const std::int64_t frame : {8, 12, 13, 14, 18}) {
    const auto first = built(text, with_local_steps), second = built(text, with_local_steps);
    run_to_frame(*first, frame);
    const std::vector<std::byte> bytes = checkpoint_to_bytes(take_checkpoint(*first->s));
    restore_checkpoint(checkpoint_from_bytes(bytes, "c"), *second->s);
    run_to_frame(*second, 24);
    EXPECT_EQ(second->s->state.u, whole->s->state.u) << frame;
    EXPECT_EQ(second->s->state.v, whole->s->state.v) << frame;
  }
}

double step_by_searches(Simulation& s) {
  const double amplitude = search_amplitude(s.model, s.edge_length);
  s.model.fixed.swap(s.multirate->coarse_fixed);
  const double coarse = search_step(s, amplitude, *s.communicator);
  s.model.fixed.swap(s.multirate->coarse_fixed);
  const double whole = search_step(s, amplitude, *s.communicator);
  EXPECT_GT(std::min(coarse, whole), 0);
  return std::min(coarse, whole * s.multirate->steps.limit / 2);
}

// An edit looks for the step around it alone; a search through the whole body would find no less.
TEST(MultiRate, keeps_a_stable_step_behind_each_edit) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    const auto run = hung(scalpel_text, elements, with_local_steps);
    Simulation& s = *run->s;
    int n_edits = 0;
    while (s.frame < 20) {
      const std::int32_t n_before = s.mesh.n_nodes();
      run_frame(s, run->outputs);
      if (s.mesh.n_nodes() == n_before) continue;
      ++n_edits;
      ASSERT_TRUE(s.multirate);
      EXPECT_LT(s.watch.stable_step / step_by_searches(s), frequency_margin);
      // Nor without local steps.
      const double whole = search_step(s, search_amplitude(s.model, s.edge_length), Communicator());
      EXPECT_LT(s.watch.stable_step * s.look.of_small / whole, frequency_margin);
    }
    EXPECT_GE(n_edits, 3);
  }
}

TEST(MultiRate, leaves_a_body_that_sleeps_where_it_is) {
  const auto run = hung("[start]\nstate = \"equilibrium\"\n", BoxElements::hex8,
                        {"solver.multirate=true", "solver.sleep='1 mm'"});
  start_in_equilibrium(run->loaded, *run->s);
  while (run->s->sleep->share < 1 && run->s->frame < 60) run_frame(*run->s, run->outputs);
  ASSERT_TRUE(run->s->multirate);
  EXPECT_EQ(run->s->sleep->share, 1);
  const std::vector<double> u = run->s->state.u;
  run_to_frame(*run, run->s->frame + 3);
  EXPECT_EQ(run->s->state.u, u);
}

TEST(MultiRate, is_built_only_where_it_is_asked_for_and_saves_work) {
  const std::string even = scene_text("[solver]\n");
  EXPECT_FALSE(built(even)->s->multirate);
  EXPECT_FALSE(built(even + "multirate = true\n")->s->multirate);
}

TEST(MultiRate, is_refused_with_what_it_cannot_compute) {
  for (const char* const other :
       {"[tissue.material]\nprony = [ { share = 0.4, time = 0.02 } ]\n[solver]\n",
        "[solver]\ntetrahedron = \"nodal-pressure\"\n",
        "[solver]\nstable_step = \"element-bound\"\n", "[solver]\nmass_scaling_step = 0.001\n"}) {
    EXPECT_TRUE(contains(scene_error(scene_text(std::string(other) + "multirate = true\n")),
                         "solver.multirate"));
    EXPECT_EQ(scene_error(scene_text(other)), "");
  }
}

}  // namespace
}  // namespace trocar
