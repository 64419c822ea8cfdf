#include "engine/resume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "engine/checkpoint_file.h"
#include "engine/recording.h"
#include "engine/run.h"
#include "engine_resume.h"
#include "engine_split.h"
#include "error_of.h"
#include "mesh/generate.h"
#include "replaced.h"
#include "test_files.h"

namespace trocar {
namespace {

// The block scene as a file, changed by --set.
LoadedScene block_with(const std::vector<std::string>& settings) {
  const TestFolder folder;
  return load_scene(write_text(folder.file("s.toml"), resume_block_text), settings);
}

std::string resume_refusal(const std::vector<std::string>& settings) {
  const Scene before = block_with({}).scene;
  return error_of(
      [&] { require_same_scene(echo_options(scene_options(), &before), block_with(settings)); });
}

TEST(Resume, takes_the_same_scene) {
  EXPECT_EQ(resume_refusal({}), "");
}

TEST(Resume, lets_duration_pace_overrun_checkpoints_cameras_and_outputs_differ) {
  EXPECT_EQ(resume_refusal({"time.duration=9", "time.pace=real-time", "time.overrun=stop",
                            "checkpoint.every=0.1", "camera=[{eye=[0,-1,0],target=[0,0,0]}]",
                            "output=[{kind='metrics',file='m.csv'}]"}),
            "");
}

TEST(Resume, names_the_first_key_that_differs_and_both_values) {
  const std::string sentence = resume_refusal({"tissue.material.young_modulus=7000"});
  EXPECT_TRUE(contains(sentence, "tissue.material.young_modulus")) << sentence;
  EXPECT_TRUE(contains(sentence, "the stopped run had 6000")) << sentence;
}

TEST(Resume, names_a_key_within_lists_by_their_numbers) {
  const std::string text =  // with another second key of the grasper
      replaced(resume_block_text, "time = \"0.6 s\"", "time = \"0.65 s\"");
  const TestFolder folder;
  const LoadedScene now = load_scene(write_text(folder.file("s.toml"), text), {});
  const Scene before = block_with({}).scene;
  const std::string sentence =
      error_of([&] { require_same_scene(echo_options(scene_options(), &before), now); });
  EXPECT_TRUE(contains(sentence, "instrument[1].path[1].time")) << sentence;
}

TEST(Resume, refuses_a_scene_with_one_instrument_less) {
  const std::string sentence = resume_refusal({"instrument=[]"});
  EXPECT_TRUE(contains(sentence, "instrument[0].kind: the stopped run had \"")) << sentence;
  EXPECT_TRUE(contains(sentence, ", and this scene has no such key")) << sentence;
}

TEST(Resume, names_a_key_that_is_new) {
  const std::string sentence = resume_refusal({"region=[{name='q',low=[0,0,0],high=[1,1,1]}]"});
  EXPECT_TRUE(contains(sentence, "region[0].name: the stopped run had no such key")) << sentence;
}

TEST(Resume, without_a_checkpoint_says_how_to_start) {
  const TestFolder folder;
  Communicator alone;
  const std::string sentence =
      error_of([&] { load_checkpoint(folder.path(), block_with({}), alone); });
  EXPECT_EQ(sentence, "\"" + folder.path() +
                          "\" holds no checkpoint (checkpoint.bin) to resume from; start the run "
                          "without --resume");
}

// A run of the block into a folder; `settings` as --set has them.
bool run_block(const TestFolder& folder, const std::vector<std::string>& settings,
               bool resume = false, const std::string& text = resume_block_text) {
  Communicator alone;
  return run_scene({.scene_file = write_text(folder.file("s.toml"), text),
                    .folder = folder.file("out"),
                    .overrides = settings,
                    .is_resumed = resume},
                   alone);
}

std::string resume_error(const TestFolder& folder, const std::vector<std::string>& settings) {
  return error_of([&] { run_block(folder, settings, true); });
}

TEST(Resume, refuses_a_scene_that_ends_before_the_checkpoint) {
  const TestFolder folder;
  run_block(folder, {"time.duration=0.4"});
  EXPECT_TRUE(contains(resume_error(folder, {"time.duration=0.2"}), "time.duration"));
}

TEST(Resume, refuses_a_damaged_checkpoint) {
  const TestFolder folder;
  run_block(folder, {"time.duration=0.1"});
  std::string bytes = read_text(folder.file("out/checkpoint.bin"));
  bytes[bytes.size() / 2] ^= 1;
  write_text(folder.file("out/checkpoint.bin"), bytes);
  EXPECT_TRUE(contains(resume_error(folder, {}), "damaged"));
}

TEST(Resume, refuses_a_recording_that_lacks_frames_which_the_checkpoint_knows) {
  const std::string output = "output=[{kind='recording',file='r.trocar'}]";
  const TestFolder folder;
  run_block(folder, {"time.duration=0.2", output});
  std::filesystem::remove(folder.file("out/r.trocar"));
  EXPECT_TRUE(contains(resume_error(folder, {output}), "r.trocar"));
  {
    RecordingWriter(folder.file("out/r.trocar"),
                    RecordingHead{.mesh = make_rectangle(0.07, 0.04, 4, 3)});
  }
  EXPECT_TRUE(contains(resume_error(folder, {output}), "frame 6: is not recorded"));
}

TEST(Resume, is_not_possible_into_what_a_later_run_without_it_has_replaced) {
  const TestFolder folder;
  run_block(folder, {"time.duration=0.2"});
  run_block(folder, {"time.duration=0.2", "checkpoint.every=0"});
  EXPECT_TRUE(contains(resume_error(folder, {}), "holds no checkpoint"));
}

TEST(Resume, begins_a_recording_that_was_not_asked_for_before_with_the_present_mesh) {
  const std::string output = "output=[{kind='recording',file='r.trocar'}]";
  const TestFolder folder;
  run_block(folder, {"time.duration=0.6"});  // cut by then
  run_block(folder, {"time.duration=0.8", output}, true);
  RecordingReader reader(folder.file("out/r.trocar"));
  EXPECT_EQ(reader.frames().front().first, 19);
  EXPECT_EQ(reader.frames().back().first, 24);
  EXPECT_EQ(reader.read(24).u.size(), 3 * reader.mesh_at(24).X.size());
}

// Also where the first try to go on came to nothing, and of a run that was killed.
TEST(Resume, sets_aside_what_the_run_went_on_without) {
  const std::string outputs =
      "output=[{kind='recording',file='r.trocar'},{kind='metrics',file='m.csv'}]";
  const TestFolder folder;
  run_block(folder, {"time.duration=0.1", outputs});
  write_text(folder.file("out/r.trocar-journal"), "");
  const std::string first = read_text(folder.file("out/m.csv"));
  run_block(folder, {"time.duration=0.2"}, true);
  std::filesystem::copy_file(folder.file("out/checkpoint.bin"), folder.file("c.bin"));
  for (int k = 0; k < 2; ++k) {
    std::filesystem::copy_file(folder.file("c.bin"), folder.file("out/checkpoint.bin"),
                               std::filesystem::copy_options::overwrite_existing);
    run_block(folder, {"time.duration=0.3", outputs}, true);
    EXPECT_EQ(RecordingReader(folder.file("out/r.before-frame-6.trocar")).frames().size(), 3U);
    EXPECT_EQ(RecordingReader(folder.file("out/r.trocar")).frames().front().first, 7);
    EXPECT_EQ(read_text(folder.file("out/m.before-frame-6.csv")), first);
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("out/r.trocar-journal")));
}

TEST(Resume, keeps_metrics_of_another_name) {
  const auto output = [](const std::string& file) {
    return "output=[{kind='metrics',file='" + file + "'}]";
  };
  const TestFolder folder;
  run_block(folder, {"time.duration=0.1", output("m.csv")});
  const std::string first = read_text(folder.file("out/m.csv"));
  run_block(folder, {"time.duration=0.2", output("n.csv")}, true);
  run_block(folder, {"time.duration=0.3", output("m.csv")}, true);
  EXPECT_EQ(read_text(folder.file("out/m.before-frame-6.csv")), first);
  EXPECT_TRUE(read_text(folder.file("out/m.csv")).starts_with(first));
}

TEST(Resume, gives_metrics_the_rows_from_where_they_were_asked_for) {
  const std::string output = "output=[{kind='metrics',file='m.csv'}]";
  const TestFolder folder;
  run_block(folder, {"time.duration=0.1"});
  for (const char* duration : {"0.2", "0.3"})
    run_block(folder, {std::string("time.duration=") + duration, output}, true);
  std::istringstream lines(read_text(folder.file("out/m.csv")));
  std::vector<std::ptrdiff_t> n_fields;
  std::vector<double> time;
  for (std::string line; std::getline(lines, line);) {
    n_fields.push_back(std::ranges::count(line, ','));
    time.push_back(std::atof(line.c_str()));
  }
  EXPECT_EQ(n_fields, std::vector<std::ptrdiff_t>(1 + 6, n_fields.at(0)));
  EXPECT_NEAR(time.at(1), 4 / 30., 1e-9);
  EXPECT_NEAR(time.at(6), 9 / 30., 1e-9);
}

TEST(Resume, of_metrics_rarer_than_any_run_is_long_writes_no_row) {
  const TestFolder folder;
  run_block(folder, {"time.duration=0.1", "output=[{kind='metrics',file='m.csv',every=1e24}]"});
  const std::string metrics = read_text(folder.file("out/m.csv"));
  EXPECT_EQ(std::ranges::count(metrics, '\n'), 1);
}

// Stops at .5 s, while the grasper holds and the blade cuts, goes on to .8 s and is what it is
// without the stop.
void expect_the_same_after_a_stop(const std::vector<std::string>& settings,
                                  const std::string& half = "0.5", const std::string& end = "0.8",
                                  const std::string& text = resume_block_text) {
  const auto until = [&](const std::string& duration) {
    std::vector<std::string> all = settings;
    all.push_back("time.duration=" + duration);
    return all;
  };
  const TestFolder whole, parts;
  run_block(whole, until(end), false, text);
  run_block(parts, until(half), false, text);
  run_block(parts, until(end), true, text);
  RecordingReader a(whole.file("out/r.trocar")), b(parts.file("out/r.trocar"));
  EXPECT_TRUE(b.damage().empty());
  ASSERT_EQ(a.frames(), b.frames());
  for (const auto& [frame, time] : a.frames()) {
    EXPECT_EQ(a.read(frame).digest, b.read(frame).digest);
    EXPECT_EQ(a.mesh_at(frame).X, b.mesh_at(frame).X);
    EXPECT_EQ(a.mesh_at(frame).corner_node, b.mesh_at(frame).corner_node);
  }
}

TEST(Resume, keeps_the_edits_of_frames_that_a_sparse_recording_has_yet_to_take) {
  // Frame 15 lies between 12 and 18.
  expect_the_same_after_a_stop({"output=[{kind='recording',file='r.trocar',every='0.2 s'}]"});
}

// The plate is split in frames 14 and 15: the recording takes up that edit after the stop, or the
// stop is behind it.
TEST(Resume, keeps_the_split_elements_that_a_sparse_recording_has_yet_to_take) {
  const std::string text = plate_of("tet4-five", viscous) + plate_in_use + plate_blade;
  for (const std::string half : {"0.26", "0.28", "0.36"})
    expect_the_same_after_a_stop({"output=[{kind='recording',file='r.trocar',every='0.1 s'}]"},
                                 half, "0.44", text);
}

TEST(Resume, goes_on_with_the_scaled_masses_and_what_a_grasper_holds_of_them) {
  const std::string scaled = "solver.mass_scaling_step='1.5 ms'";
  expect_the_same_after_a_stop({"output=[{kind='recording',file='r.trocar'}]", scaled});
  // The run that was compared has elements in clusters.
  const TestFolder folder;
  run_block(folder, {"time.duration=0.1", scaled});
  const std::string summary = read_text(folder.file("out/summary.json"));
  const std::size_t at = summary.find("\"clusters\": ");
  ASSERT_NE(at, std::string::npos);
  EXPECT_GT(std::atoi(summary.c_str() + at + 12), 0);
}

}  // namespace
}  // namespace trocar
