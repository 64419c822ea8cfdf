// A run that was stopped and resumed has the bits of one that never stopped: digests of all
// recorded frames, cut ledger, events and metrics, also on other ranks and threads than before.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine_resume.h"
#include "program_start.h"
#include "scene_plate.h"
#include "small_scenes.h"

namespace trocar {
namespace {

struct Machine {
  int ranks = 1, threads = 1;
};

std::vector<std::string> run_arguments(const std::string& scene, const std::string& folder,
                                       const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"run",
                                        scene,
                                        "-o",
                                        folder + "/out",
                                        "-q",
                                        "--set",
                                        "output=[{kind='recording',file='r.trocar'},"
                                        "{kind='metrics',file='m.csv'}]"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void run(const std::string& scene, const std::string& folder, const Machine& machine,
         std::vector<std::string> more) {
  more.insert(more.end(), {"--threads", std::to_string(machine.threads)});
  const std::vector<std::string> arguments = run_arguments(scene, folder, more);
  // mpirun's environment keeps waiting threads from spinning, so one rank with threads needs it
  // too.
  const bool is_plain = machine.ranks == 1 && machine.threads == 1;
  const Finished finished =
      is_plain ? run_trocar(arguments, folder) : run_trocar_on(machine.ranks, arguments, folder);
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
}

// Everything that a run leaves and that a second run must leave too.
std::string result_of(const std::string& folder) {
  const nlohmann::json summary = read_summary(folder + "/out");
  if (summary.is_discarded()) return "no summary";
  std::string result;
  const nlohmann::json same = result_in(summary);
  for (const auto& [key, value] : same.items()) result += key + " " + value.dump() + "\n";
  result += metrics_without_times(folder + "/out/m.csv");
  const Finished list = run_trocar({"replay", folder + "/out/r.trocar", "--list"}, folder);
  EXPECT_EQ(list.exit_code, 0) << list.err;
  return result + list.out;
}

std::string scene_file(const std::string& folder, const std::string& text) {
  std::ofstream(folder + "/scene.toml") << text;
  return folder + "/scene.toml";
}

struct Change {
  Machine from, to;
};

struct Halves {
  std::string name, scene, half, end;  // durations of the first run and of both
  std::vector<std::string> more = {};
  std::vector<Change> changes = {{{1, 1}, {2, 1}}, {{2, 2}, {1, 1}}, {{3, 1}, {1, 2}}};
};

// Stops at `half` on one machine and goes on to `end` on others.
void expect_resumes(const Halves& h) {
  std::vector<std::string> to_half = {"--set", "time.duration='" + h.half + "'"},
                           to_end = {"--set", "time.duration='" + h.end + "'"};
  for (std::vector<std::string>* settings : {&to_half, &to_end})
    settings->insert(settings->end(), h.more.begin(), h.more.end());
  std::vector<std::string> go_on = to_end;
  go_on.push_back("--resume");
  const std::string whole = test_folder(h.name + "-whole");
  run(h.scene, whole, {1, 1}, to_end);
  const std::string expected = result_of(whole);
  for (const auto& [from, to] : h.changes) {
    const std::string parts = test_folder(h.name + "-parts");
    run(h.scene, parts, from, to_half);
    run(h.scene, parts, to, go_on);
    EXPECT_EQ(result_of(parts), expected) << "from " << from.ranks << " x " << from.threads
                                          << " to " << to.ranks << " x " << to.threads;
  }
}

const std::vector<Change> one_change = {{{3, 1}, {1, 2}}};

TEST(Resume, in_the_middle_of_a_stroke_through_tetrahedra_gives_the_same_bits_on_other_ranks) {
  const std::string folder = test_folder("block-scene");
  expect_resumes({"block", scene_file(folder, resume_block_text), "0.5 s", "1.2 s"});
}

TEST(Resume, in_the_middle_of_a_plane_cut_gives_the_same_bits_on_other_ranks) {
  expect_resumes({"plane", config("plane_cut.toml"), "1.4 s", "2.2 s"});
}

TEST(Resume,
     in_the_middle_of_a_cut_through_a_ball_of_hexahedra_gives_the_same_bits_on_other_ranks) {
  const std::string folder = test_folder("ball-scene");
  const std::string text =
      "[time]\nduration = 0.5\nframe_rate = 60\n[tissue.shape]\nkind = \"ball\"\nradius = 0.02\n"
      "cells = [8, 8, 8]\n[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0.4\n"
      "[solver]\nmass_damping = 20\n[[region]]\nname = \"foot\"\nlow = [-1, -1, -1]\n"
      "high = [1, 1, -0.012]\n[[support]]\nregion = \"foot\"\n[[instrument]]\nkind = \"scalpel\"\n"
      "blade_length = 0.06\npath = [\n"
      "{ time = 0.05, position = [-0.05, 0.03, -0.004], direction = [0, 1, 0], "
      "forward = [1, 0, 0.2] },\n"
      "{ time = 0.45, position = [0.05, 0.03, 0.016], direction = [0, 1, 0], "
      "forward = [1, 0, 0.2] } ]\n";
  expect_resumes({"ball", scene_file(folder, text), "0.27 s", "0.4 s"});
}

TEST(Resume, of_the_grasped_hexahedral_block_gives_the_same_bits_on_other_ranks) {
  // Enough elements for two threads on each of two ranks.
  expect_resumes({"hexahedra",
                  config("block_hex.toml"),
                  "1.6 s",
                  "1.8 s",
                  {"--set", "tissue.shape.cells=[14, 12, 12]"}});
  expect_resumes({"cut-hexahedra", config("block_hex_cut.toml"), "0.5 s", "0.8 s"});
}

TEST(Resume, of_a_run_that_began_in_equilibrium_gives_the_same_bits_on_other_ranks) {
  const std::string folder = test_folder("equilibrium-scene");
  std::string text = resume_plane_text + "[start]\nstate = \"equilibrium\"\n";
  text.replace(text.find("mass_damping"), 0, "gravity = [0, -2, 0]\n");
  expect_resumes({"equilibrium", scene_file(folder, text), "0.5 s", "0.8 s"});
}

TEST(Resume, of_a_body_with_nodal_pressures_asleep_gives_the_same_bits_on_other_ranks) {
  const std::string folder = test_folder("asleep-scene");
  const std::string scene = scene_file(folder, small_scene("tet4 asleep, cut"));
  expect_resumes({"asleep",
                  scene,
                  "0.62 s",
                  "0.8 s",
                  {"--set", "solver.tetrahedron='nodal-pressure'"},
                  one_change});
}

TEST(Resume, of_a_run_that_was_rolled_back_gives_the_same_bits_on_other_ranks) {
  const std::string folder = test_folder("rolled-back-scene");
  const std::string name = "hex8, pulled so fast that frames are rolled back";
  expect_resumes(
      {"rolled-back", scene_file(folder, small_scene(name)), "0.16 s", "0.24 s", {}, one_change});
}

TEST(Resume, in_the_middle_of_a_cut_by_scissors_gives_the_same_bits_on_other_ranks) {
  const std::string folder = test_folder("scissors-scene");
  expect_resumes({"scissors",
                  scene_file(folder, small_scene("duct, cut by scissors")),
                  "0.3 s",
                  "0.42 s",
                  {},
                  one_change});
}

TEST(Resume, goes_on_with_pictures_and_begins_a_film_and_a_sheet_of_its_own) {
  const std::string whole = test_folder("pictures-whole"), parts = test_folder("pictures-parts");
  const std::string outputs =
      "output=[{kind='frames',file='png',size=[64,48],every='0.2 s'},"
      "{kind='contact-sheet',file='sheet.png',size=[64,48]}]";
  const std::vector<std::string> pictures = {
      "--set", "camera=[{eye=[0.03,0.02,0.15],target=[0.03,0.02,0],up=[0,1,0]}]", "--set", outputs};
  const std::string scene = scene_file(whole, resume_plane_text);
  run(scene, whole, {}, pictures);
  std::vector<std::string> half = pictures, go_on = pictures;
  half.insert(half.end(), {"--set", "time.duration='0.7 s'"});
  go_on.push_back("--resume");
  run(scene, parts, {}, half);
  run(scene, parts, {}, go_on);
  for (const char* name : {"000006", "000012", "000018", "000024", "000030", "000036"}) {
    const std::string picture = std::string("/out/png/") + name + ".png";
    EXPECT_FALSE(read_text(whole + picture).empty()) << picture;
    EXPECT_EQ(read_text(parts + picture), read_text(whole + picture)) << picture;
  }
  EXPECT_TRUE(std::filesystem::exists(parts + "/out/sheet.png"));
  EXPECT_TRUE(std::filesystem::exists(parts + "/out/sheet.from-frame-21.png"));
}

TEST(Resume, of_a_finished_run_leaves_its_result_as_it_is) {
  const std::string folder = test_folder("finished");
  const std::string scene = scene_file(folder, resume_plane_text);
  run(scene, folder, {}, {});
  const std::string before = result_of(folder);
  run(scene, folder, {}, {"--resume"});
  EXPECT_EQ(result_of(folder), before);
}

// Frames that the metrics of the run tell of so far.
std::ptrdiff_t n_frames_of(const std::string& folder) {
  return std::ranges::count(read_text(folder + "/out/m.csv"), '\n') - 1;
}

// Starts the run with the end half a minute away, sends the signal when there is a checkpoint and
// so many frames are done; the exit code, -1 if the signal killed it.
int run_until_signal(std::vector<std::string> words, const std::string& folder, int signal,
                     std::ptrdiff_t n_frames) {
  words.insert(words.end(), {"--set", "checkpoint.every='0.1 s'", "--set", "time.pace='real-time'",
                             "--set", "time.duration='30 s'"});
  const pid_t child = start(words, folder);
  wait_for(folder + "/out/checkpoint.bin");
  wait_until([&] { return n_frames_of(folder) >= n_frames; });
  kill(child, signal);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Most of a second behind the last signal: who sends one late, by some 30 ms on a loaded machine,
// still finds the run before this end.
const std::vector<std::string> to_the_end = {"--set", "time.duration='1.6 s'"};

std::string uninterrupted(const std::string& scene) {
  const std::string folder = test_folder("uninterrupted");
  run(scene, folder, {}, to_the_end);
  return result_of(folder);
}

// As fast as it goes.
void resume_and_compare(const std::string& scene, const std::string& folder, const Machine& machine,
                        const std::string& expected) {
  std::vector<std::string> go_on = to_the_end;
  go_on.push_back("--resume");
  run(scene, folder, machine, go_on);
  EXPECT_EQ(result_of(folder), expected);
  EXPECT_GT(read_summary(folder + "/out")["resumed_at_s"], 0.0);
  EXPECT_FALSE(std::filesystem::exists(folder + "/out/checkpoint.bin.new"));
}

TEST(Resume, after_a_kill_at_some_moment_gives_the_same_bits) {
  const std::string folder = test_folder("killed");
  const std::string scene = scene_file(folder, resume_block_text);
  const std::string expected = uninterrupted(scene);
  for (const std::ptrdiff_t n_frames : {0, 4, 8, 14, 20}) {
    std::filesystem::remove_all(folder + "/out");
    std::vector<std::string> words = run_arguments(scene, folder, {});
    words.insert(words.begin(), TROCAR_PROGRAM);
    EXPECT_EQ(run_until_signal(words, folder, SIGKILL, n_frames), -1);
    resume_and_compare(scene, folder, {1, 2}, expected);
  }
}

// In the frames around the cut's split, or behind it.
TEST(Resume, after_a_kill_behind_a_cut_that_split_elements_gives_the_same_bits) {
  const std::string folder = test_folder("killed-split");
  const std::string scene =
      scene_file(folder, plate_of("tet4-five", viscous) + plate_in_use + plate_blade);
  const std::string expected = uninterrupted(scene);
  EXPECT_NE(expected.find("\"pieces\":2"), std::string::npos) << expected;
  for (const std::ptrdiff_t n_frames : {6, 13, 20, 28}) {
    std::filesystem::remove_all(folder + "/out");
    std::vector<std::string> words = run_arguments(scene, folder, {});
    words.insert(words.begin(), TROCAR_PROGRAM);
    EXPECT_EQ(run_until_signal(words, folder, SIGKILL, n_frames), -1);
    resume_and_compare(scene, folder, {n_frames == 20 ? 3 : 1, 2}, expected);
  }
}

TEST(Resume, after_a_signal_goes_on_at_the_frame_where_it_stopped) {
  const std::string folder = test_folder("signalled");
  const std::string scene = scene_file(folder, resume_block_text);
  const std::string expected = uninterrupted(scene);
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1, SIGHUP}) {
    std::filesystem::remove_all(folder + "/out");
    std::vector<std::string> words = run_arguments(scene, folder, {});
    words.insert(words.begin(), TROCAR_PROGRAM);
    ASSERT_EQ(run_until_signal(words, folder, signal, 9), stopped);
    const double at = read_summary(folder + "/out")["duration_s"];
    resume_and_compare(scene, folder, {2, 1}, expected);
    EXPECT_EQ(read_summary(folder + "/out")["resumed_at_s"], at);
  }
}

TEST(Resume, of_two_ranks_that_were_signalled_goes_on_with_one) {
  const std::string folder = test_folder("two-signalled");
  const std::string scene = scene_file(folder, resume_block_text);
  const std::string expected = uninterrupted(scene);
  const std::vector<std::string> words =
      mpirun_words(2, TROCAR_PROGRAM, run_arguments(scene, folder, {}));
  EXPECT_EQ(run_until_signal(words, folder, SIGUSR1, 10), stopped);
  resume_and_compare(scene, folder, {1, 1}, expected);
}

TEST(Resume, without_a_checkpoint_is_refused_on_every_rank_with_one_sentence) {
  const std::string folder = test_folder("nothing");
  const Finished run = run_trocar_on(
      2, {"run", config("plane_cut.toml"), "-o", folder + "/out", "--resume"}, folder);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("start the run without --resume"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace trocar
