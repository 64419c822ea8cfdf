// A run that goes on from a checkpoint has the bits of one that never stopped: each frame's
// checkpoint, restored into a new simulation, gives the next frame's checkpoint byte by byte.
#include "engine/checkpoint.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/digest.h"
#include "base/threads.h"
#include "engine/build.h"
#include "engine/bytes.h"
#include "engine/checkpoint_file.h"
#include "engine/checkpoint_output.h"
#include "engine/equilibrium.h"
#include "engine/event_log.h"
#include "engine/frame.h"
#include "engine/output.h"
#include "engine_checkpoint.h"
#include "engine_resume.h"
#include "engine_split.h"
#include "engine_started.h"
#include "mesh_fixtures.h"
#include "mesh_write.h"
#include "scene_parts.h"

namespace trocar {
namespace {

LoadedScene loaded_text(const std::string& text) {
  set_thread_count(1);  // bodies so small that threads would only wait for each other
  const TestFolder folder;
  return load_scene(write_text(folder.file("s.toml"), text), {"checkpoint.every=0"});
}

// Checkpoints of all frames of a run that is not stopped, from time zero on.
std::vector<std::vector<std::byte>> uninterrupted(const LoadedScene& scene) {
  Communicator alone;
  const auto s = build(scene, alone);
  Outputs outputs;
  const auto n = std::llround(scene.scene.time.duration * scene.scene.time.frame_rate);
  std::vector<std::vector<std::byte>> checkpoints = {bytes_of(*s)};
  while (s->frame < n) {
    run_frame(*s, outputs);
    checkpoints.push_back(bytes_of(*s));
  }
  return checkpoints;
}

void expect_same_next_frames(const LoadedScene& scene,
                             const std::vector<std::vector<std::byte>>& checkpoints) {
  Communicator alone;
  for (std::size_t k = 0; k + 1 < checkpoints.size(); ++k) {
    const auto s = build(scene, alone);
    restore_checkpoint(checkpoint_from_bytes(checkpoints[k], "c"), *s);
    EXPECT_EQ(bytes_of(*s), checkpoints[k]) << "restored at frame " << k;
    Outputs outputs;
    run_frame(*s, outputs);
    EXPECT_EQ(bytes_of(*s), checkpoints[k + 1]) << "one frame after frame " << k;
  }
}

TEST(Checkpoint, of_each_frame_of_a_cut_grasped_and_pressed_block_leads_to_the_next_one) {
  const LoadedScene scene = loaded_text(resume_block_text);
  const auto checkpoints = uninterrupted(scene);
  expect_same_next_frames(scene, checkpoints);

  // All that a checkpoint has to keep did happen.
  bool is_in_stroke = false, has_engaged = false;
  for (const auto& bytes : checkpoints) {
    const Checkpoint c = checkpoint_from_bytes(bytes, "c");
    is_in_stroke = is_in_stroke || (c.cuts[0].is_in_stroke && !c.cuts[0].stroke.opened.empty());
    has_engaged = has_engaged || c.cuts[0].is_engaged;
  }
  const Checkpoint last = checkpoint_from_bytes(checkpoints.back(), "c");
  std::int64_t most_contacts = 0, most_held = 0;
  for (const FrameRow& row : *last.rows) {
    most_contacts = std::max(most_contacts, row.n_contacts);
    most_held = std::max(most_held, row.n_held);
  }
  EXPECT_TRUE(is_in_stroke);
  EXPECT_TRUE(has_engaged);
  EXPECT_GT(last.duplicate_node.size(), 5u);
  EXPECT_GT(most_contacts, 0);
  EXPECT_GT(most_held, static_cast<std::int64_t>(last.holds.size()));  // opened again
  EXPECT_GT(last.holds.size(), 0u);                                    // the moving support
  EXPECT_EQ(last.tally.events.size(), 2u);                             // closes, opens
}

TEST(Checkpoint, of_each_frame_of_a_plate_in_use_that_is_split_leads_to_the_next_one) {
  const LoadedScene scene =
      loaded_text(plate_of("tet4-five", viscous) + plate_in_use + plate_blade);
  const auto checkpoints = uninterrupted(scene);
  const std::size_t n = checkpoints.size();
  expect_same_next_frames(scene, {checkpoints.begin() + 10, checkpoints.end()});
  const Checkpoint first = checkpoint_from_bytes(checkpoints[0], "c"),
                   last = checkpoint_from_bytes(checkpoints[n - 1], "c");
  const CutRecord& stroke = last.cuts[0].strokes.at(0);
  EXPECT_GT(stroke.figures.n_inserted, 300);
  EXPECT_EQ(stroke.n_pieces, 2);
  EXPECT_GT(last.mesh->n_elements(), first.mesh->n_elements() + 1000);
  EXPECT_LT(stroke.end, 0.5);  // frames behind it
  EXPECT_EQ(last.tally.n_roll_backs, 0);
}

TEST(Checkpoint, of_each_frame_of_a_plane_cut_leads_to_the_next_one) {
  const LoadedScene scene = loaded_text(resume_plane_text);
  const auto checkpoints = uninterrupted(scene);
  expect_same_next_frames(scene, checkpoints);
  std::size_t longest_path = 0;
  for (const auto& bytes : checkpoints)
    longest_path =
        std::max(longest_path, checkpoint_from_bytes(bytes, "c").cuts[0].plane_path.size());
  EXPECT_GT(longest_path, 2u);
  EXPECT_GT(checkpoint_from_bytes(checkpoints.back(), "c").duplicate_node.size(), 2u);
}

std::string with_solver(std::string text, const std::string& line) {
  return text.insert(text.find("mass_damping"), line + "\n");
}

// Kinds that the scenes above don't have, in frames with a cut.
TEST(Checkpoint, of_frames_of_nodal_pressures_and_of_plane_stress_lead_to_the_next_one) {
  for (const std::string& text :
       {with_solver(resume_block_text, "tetrahedron = \"nodal-pressure\""),
        with_solver(resume_plane_text, "triangle = \"plane-stress\"")}) {
    const LoadedScene scene = loaded_text(text);
    const auto checkpoints = uninterrupted(scene);
    expect_same_next_frames(scene, {checkpoints.begin() + 8, checkpoints.begin() + 18});
    EXPECT_GT(checkpoint_from_bytes(checkpoints[18], "c").duplicate_node.size(), 1U);
  }
}

TEST(Checkpoint, of_each_frame_of_a_cut_by_scissors_leads_to_the_next_one) {
  const LoadedScene scene = loaded_text(resume_snip_text);
  const auto checkpoints = uninterrupted(scene);
  expect_same_next_frames(scene, {checkpoints.begin() + 4, checkpoints.end()});
  const Checkpoint last = checkpoint_from_bytes(checkpoints.back(), "c");
  EXPECT_GT(last.duplicate_node.size(), 5U);
  const auto is_of_tissue_beside = [](const std::string& e) {
    return contains(e, "beside its open");
  };
  EXPECT_EQ(std::ranges::count_if(last.tally.events, is_of_tissue_beside), 1);
}

TEST(Checkpoint, of_a_frame_that_failed_behind_its_cut_is_not_written) {
  const auto c = built(resume_block_text);
  Simulation& s = *c->s;
  FrameStart start;
  const std::int32_t n = s.mesh.n_nodes();
  while (s.mesh.n_nodes() == n) {
    start = start_of_frame(s);
    run_frame(s, c->outputs);
  }
  write_checkpoint(s, c->outputs, &start);
  EXPECT_FALSE(std::filesystem::exists(c->folder.file(checkpoint_name)));
  write_checkpoint(s, c->outputs);
  EXPECT_TRUE(std::filesystem::exists(c->folder.file(checkpoint_name)));
}

using Forget = void (*)(CutMemory&);

// Whether the run leads elsewhere within a few frames if a checkpoint has lost something.
bool leads_elsewhere(const LoadedScene& scene,
                     const std::vector<std::vector<std::byte>>& checkpoints, std::size_t k,
                     Forget forget) {
  Communicator alone;
  const auto s = build(scene, alone);
  Checkpoint c = checkpoint_from_bytes(checkpoints[k], "c");
  forget(c.cuts[0]);
  restore_checkpoint(c, *s);
  Outputs outputs;
  for (std::size_t j = k + 1; j < std::min(k + 6, checkpoints.size()); ++j) {
    run_frame(*s, outputs);
    if (bytes_of(*s) != checkpoints[j]) return true;
  }
  return false;
}

// The round trips above have power over these only if the scenes need them.
void expect_each_is_needed(const LoadedScene& scene,
                           const std::vector<std::pair<const char*, Forget>>& parts) {
  const auto checkpoints = uninterrupted(scene);
  for (const auto& [name, forget] : parts) {
    bool is_needed = false;
    for (std::size_t k = 0; k + 1 < checkpoints.size() && !is_needed; ++k)
      is_needed = checkpoint_from_bytes(checkpoints[k], "c").cuts[0].is_in_stroke &&
                  leads_elsewhere(scene, checkpoints, k, forget);
    EXPECT_TRUE(is_needed) << name;
  }
}

TEST(Checkpoint, needs_each_part_of_a_stroke_through_tetrahedra) {
  expect_each_is_needed(
      loaded_text(resume_block_text),
      {{"hit", [](CutMemory& m) { m.stroke.hit.clear(); }},
       {"side", [](CutMemory& m) { m.stroke.side.clear(); }},
       {"opened", [](CutMemory& m) { m.stroke.opened.clear(); }},
       {"step", [](CutMemory& m) { m.stroke.step.clear(); }},
       {"surface_node", [](CutMemory& m) { m.stroke.surface_node.clear(); }},
       {"parted_node", [](CutMemory& m) { m.stroke.parted_node.clear(); }},
       {"fresh", [](CutMemory& m) { m.stroke.fresh.clear(); }},
       {"unfinished", [](CutMemory& m) { m.stroke.unfinished.clear(); }},
       {"edge", [](CutMemory& m) { m.stroke.edge.clear(); }},
       {"mean_edge", [](CutMemory& m) { m.stroke.mean_edge = 0; }},
       {"swept", [](CutMemory& m) { m.stroke.swept = 0; }},
       {"is_in_stroke", [](CutMemory& m) { m.is_in_stroke = false; }},
       {"n_idle_frames", [](CutMemory& m) { m.n_idle_frames = 0; }},
       {"push", [](CutMemory& m) { m.push = {}; }},
       {"swept places", [](CutMemory& m) { m.CutProgress::swept.clear(); }},
       {"strokes", [](CutMemory& m) { m.strokes.insert(m.strokes.begin(), {.tool = "other"}); }},
       {"tissue_velocity", [](CutMemory& m) { m.tissue_velocity.setConstant(1); }}});
}

// Or it would be told of again.
TEST(Checkpoint, needs_that_tissue_beside_jaws_was_told_of) {
  expect_each_is_needed(loaded_text(resume_snip_text),
                        {{"has_told_beside", [](CutMemory& m) { m.has_told_beside = false; }}});
}

// With resistance it is known before how the tissue comes.
TEST(Checkpoint, needs_where_the_edge_was_without_resistance) {
  std::string text = resume_block_text;
  text.replace(text.find("resistance = "), 13, "resistance = 0 # ");
  expect_each_is_needed(loaded_text(text),
                        {{"engaged", [](CutMemory& m) { m.is_engaged = false; }}});
}

// A tip that is lost or another one is found again at the slit's end.
TEST(Checkpoint, needs_the_path_of_a_plane_cut) {
  expect_each_is_needed(loaded_text(resume_plane_text),
                        {{"plane_path", [](CutMemory& m) { m.plane_path.clear(); }}});
}

TEST(Checkpoint, keeps_a_step_that_roll_backs_have_halved) {
  Communicator alone;
  const LoadedScene scene = loaded_text(resume_plane_text);
  const auto s = build(scene, alone), t = build(scene, alone);
  Outputs outputs;
  s->step_scale = 0.5;
  s->log.n_roll_backs = 1;
  restore_checkpoint(checkpoint_from_bytes(bytes_of(*s), "c"), *t);
  run_frame(*s, outputs);
  run_frame(*t, outputs);
  EXPECT_EQ(bytes_of(*t), bytes_of(*s));
  EXPECT_GT(t->step_scale, 0.5);  // it rises
  EXPECT_LT(t->step_scale, 0.51);
  EXPECT_EQ(t->log.n_roll_backs, 1);
}

TEST(Checkpoint, keeps_a_step_that_is_still_rising) {
  Communicator alone;
  const LoadedScene scene = loaded_text(resume_plane_text);
  const auto s = build(scene, alone), t = build(scene, alone);
  Outputs outputs;
  s->held_step = 0.5 * s->watch.stable_step;
  s->held_by_contact = 0.4 * s->watch.stable_step;
  restore_checkpoint(checkpoint_from_bytes(bytes_of(*s), "c"), *t);
  run_frame(*s, outputs);
  run_frame(*t, outputs);
  EXPECT_EQ(bytes_of(*t), bytes_of(*s));
  EXPECT_EQ(t->held_step, s->held_step);
  EXPECT_EQ(t->held_by_contact, s->held_by_contact);
  EXPECT_LT(t->held_step, t->watch.stable_step);
}

// Among them that in which the grasper closes.
TEST(Checkpoint, of_a_frame_that_failed_is_that_of_its_beginning) {
  Communicator alone;
  const LoadedScene scene = loaded_text(resume_block_text);
  const auto s = build(scene, alone);
  Outputs outputs;
  for (int k = 0; k < 5; ++k) run_frame(*s, outputs);
  for (int k = 5; k < 9; ++k) {
    const std::vector<std::byte> before = bytes_of(*s);
    const auto failing = build(scene, alone), resumed = build(scene, alone);
    restore_checkpoint(checkpoint_from_bytes(before, "c"), *failing);
    const FrameStart start = start_of_frame(*failing);
    failing->scene.solver.gravity = Vec3(0, 0, -1e300);  // no step is small enough
    rebuild_topology(*failing);
    EXPECT_THROW(run_frame(*failing, outputs), SimulationError);
    failing->scene.solver.gravity = Vec3(0, 0, -9.81);
    const Checkpoint after = take_checkpoint_of_start(*failing, start);
    EXPECT_EQ(checkpoint_to_bytes(without_wall_times(after)), before) << "frame " << k;
    EXPECT_NO_THROW(restore_checkpoint(after, *resumed)) << "frame " << k;
    run_frame(*s, outputs);
  }
}

// A bar that sleeps on a table until a grasper closes on its end, in the 45th frame.
const std::string grasped_bar =
    time_table("3 s") + bar_on_table() +
    instrument("grasper", "radius = \"2 mm\"\ngrip_radius = \"18 mm\"", R"(
  { time = 0, position = ["72 mm", 0, "10 mm"], forward = [0, 1, 0], action = "open" },
  { time = "1.49 s", position = ["72 mm", 0, "10 mm"], forward = [0, 1, 0], action = "close" },
)");

TEST(Checkpoint, of_a_frame_that_woke_what_slept_and_failed_is_that_of_its_beginning) {
  const auto run = built(grasped_bar, {"solver.sleep='0.1 mm'"});
  Simulation& s = *run->s;
  start_in_equilibrium(run->loaded, s);
  while (s.frame < 45) run_frame(s, run->outputs);
  ASSERT_EQ(s.sleep->share, 1);
  const std::vector<std::byte> before = bytes_of(s);
  const FrameStart start = start_of_frame(s);
  s.model.options.gravity = Vec3(0, 0, -1e300);  // no step is small enough
  EXPECT_THROW(run_frame(s, run->outputs), SimulationError);
  EXPECT_EQ(s.sleep->share, 0);
  EXPECT_EQ(checkpoint_to_bytes(without_wall_times(take_checkpoint_of_start(s, start))), before);
}

// Hung at its left side, with thin elements at 5 mm.
std::unique_ptr<Started> asleep_with_local_steps() {
  const TestFolder folder;
  write_mesh(with_thin_layer(BoxElements::hex8, 2), folder.file("m.msh"));
  auto run = built(time_table("3 s") + "[checkpoint]\nevery = 0\n" + tissue_of_kpa(6) +
                       solver_table("-2", 20) + held_left + "[start]\nstate = \"equilibrium\"\n",
                   {"tissue.mesh='" + folder.file("m.msh") + "'", "solver.multirate=true",
                    "solver.sleep='1 mm'"});
  start_in_equilibrium(run->loaded, *run->s);
  while (run->s->sleep->share < 1 && run->s->frame < 60) run_frame(*run->s, run->outputs);
  return run;
}

// All that a frame may change before it fails: it wakes, is rolled back, searches the body anew and
// finds that local steps don't pay.
TEST(Checkpoint, of_a_frame_that_failed_has_nothing_that_the_frame_changed) {
  const auto run = asleep_with_local_steps();
  Simulation& s = *run->s;
  ASSERT_EQ(s.sleep->share, 1);
  ASSERT_TRUE(s.multirate);
  const std::vector<std::byte> before = bytes_of(s);
  const FrameStart start = start_of_frame(s);
  using Change = void (*)(Simulation&);
  for (const auto& [name, change] : std::vector<std::pair<const char*, Change>>{
           {"sleep", [](Simulation& t) { wake_all(t); }},
           {"watch", [](Simulation& t) { t.watch.stable_step /= 2; }},
           {"step scale", [](Simulation& t) { t.step_scale /= 2; }},
           {"roll-backs", [](Simulation& t) { ++t.log.n_roll_backs; }},
           {"events", [](Simulation& t) { note_event(t, 0, "rolled back"); }},
           {"search", [](Simulation& t) { ++t.log.searches.n_of_body; }},
           {"search of a part", [](Simulation& t) { ++t.log.searches.n_of_parts; }},
           {"look", [](Simulation& t) { t.look.of_small /= 2; }},
           {"holds", [](Simulation& t) { t.holds.holds.push_back({.node = 1}); }},
           {"local steps", [](Simulation& t) { t.multirate.reset(); }}}) {
    const std::vector<std::byte> unchanged = bytes_of(s);
    change(s);
    EXPECT_NE(bytes_of(s), unchanged) << name;
    EXPECT_EQ(checkpoint_to_bytes(without_wall_times(take_checkpoint_of_start(s, start))), before)
        << name;
  }
}

TEST(Checkpoint, of_another_body_is_refused) {
  Communicator alone;
  const auto s = build(loaded_text(resume_plane_text), alone);
  Checkpoint c = take_checkpoint(*s);
  c.body_crc ^= 1;
  EXPECT_TRUE(contains(error_of([&] { restore_checkpoint(c, *s); }), "mesh file has changed"));
}

// A pyramid whose base has one diagonal or the other.
TEST(Checkpoint, of_an_instrument_with_other_triangles_between_the_same_points_is_refused) {
  const TestFolder folder;
  Communicator alone;
  const auto with_base = [&](const std::string& base) {
    const std::string file = write_text(
        folder.file("tip.obj"),
        "v -0.005 -0.005 0\nv 0.005 -0.005 0\nv 0.005 0.005 0\nv -0.005 0.005 0\nv 0 0 0.01\n"
        "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n" +
            base);
    const std::string tool = "[[instrument]]\nkind = \"probe\"\nname = \"pyramid\"\nmesh = \"" +
                             file + "\"\npath = [{ time = 0, position = [0, 0, 0.1] }]\n";
    return build(loaded_text(resume_block_text + tool), alone);
  };
  const auto s = with_base("f 1 4 3\nf 1 3 2\n");
  const Checkpoint c = take_checkpoint(*s);
  restore_checkpoint(c, *s);
  const auto other = with_base("f 1 4 2\nf 4 3 2\n");
  EXPECT_EQ(other->tools.back().own_mesh.X, s->tools.back().own_mesh.X);
  EXPECT_TRUE(contains(error_of([&] { restore_checkpoint(c, *other); }), "mesh file has changed"));
}

TEST(Checkpoint, that_gives_another_state_than_it_was_made_of_is_refused) {
  Communicator alone;
  const auto s = build(loaded_text(resume_plane_text), alone);
  Checkpoint c = take_checkpoint(*s);
  c.v[3] += 1e-300;
  EXPECT_TRUE(contains(error_of([&] { restore_checkpoint(c, *s); }), "its digest is"));
}

}  // namespace
}  // namespace trocar
