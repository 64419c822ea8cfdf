#include "engine/replay.h"

#include <gtest/gtest.h>

#include "base/digest.h"
#include "base/log.h"
#include "base/number_text.h"
#include "engine/database.h"
#include "engine_recording.h"
#include "engine_scene.h"
#include "mesh/mesh_file.h"

namespace trocar {
namespace {

// A recording with a scene that can be read again.
ExampleRun replayable_run() {
  ExampleRun run = example_run(6);
  const Scene scene = load_scene_text(
      scene_text(camera_text + instrument_text("probe") + instrument_text("scalpel")));
  run.head.scene = echo_options(scene_options(), &scene);
  return run;
}

struct RunToReplay {
  TestFolder folder;
  ExampleRun run = replayable_run();
  ReplayOptions options{
      .recording = folder.file("r"), .folder = folder.file("out"), .writes_vtu = true};
  RunToReplay() {
    start_log(0, true);
    write_run(run, options.recording);
  }
  std::string vtu(std::int64_t frame) const {
    const std::string number = std::to_string(frame);
    return options.folder + "/frame_" + std::string(6 - number.size(), '0') + number + ".vtu";
  }
};

TEST(Replay, writes_a_vtu_of_each_frame_with_the_displaced_mesh_of_that_frame) {
  RunToReplay c;
  replay(c.options);
  for (std::size_t k = 0; k < c.run.frames.size(); ++k) {
    for (const char* field : {"displacement", "touches_cut", "det_F", "green_strain",
                              "cauchy_stress", "von_mises_stress"})
      EXPECT_TRUE(contains(read_text(c.vtu(c.run.frames[k].frame)), field));
    const Mesh read = read_mesh(c.vtu(c.run.frames[k].frame), 1);
    const Mesh& mesh = c.run.meshes[k];
    ASSERT_EQ(read.X.size(), mesh.X.size()) << k;
    EXPECT_EQ(read.corner_node, mesh.corner_node) << k;
    const std::vector<double>& u = c.run.frames[k].u;
    for (std::size_t i = 0; i < mesh.X.size(); ++i) {
      const Vec3 x = mesh.X[i] + Vec3(u[3 * i], u[3 * i + 1], u[3 * i + 2]);
      EXPECT_EQ(read.X[i], x) << k << " " << i;
    }
  }
}

TEST(Replay, lists_the_vtu_files_with_their_times_for_paraview) {
  RunToReplay c;
  replay(c.options);
  const std::string pvd = read_text(c.options.folder + "/recording.pvd");
  for (const RecordedFrame& frame : c.run.frames)
    EXPECT_TRUE(contains(pvd, std::filesystem::path(c.vtu(frame.frame)).filename().string()));
}

TEST(Replay, shows_the_frames_of_the_chosen_time_alone) {
  RunToReplay c;
  c.options.from = c.run.frames[2].time;
  c.options.to = c.run.frames[4].time;
  replay(c.options);
  for (std::size_t k = 0; k < c.run.frames.size(); ++k)
    EXPECT_EQ(std::filesystem::exists(c.vtu(c.run.frames[k].frame)), k >= 2 && k <= 4) << k;
}

// Edits come in between: the surface is another then.
TEST(Replay, draws_each_frame_as_it_does_alone) {
  RunToReplay c;
  c.options.writes_vtu = false;
  c.options.writes_frames = true;
  c.options.width = 160;
  c.options.height = 120;
  c.options.eye = {0.035, 0.02, 0.1};
  c.options.target = {0.035, 0.02, 0};
  replay(c.options);
  for (const RecordedFrame& frame : c.run.frames) {
    ReplayOptions alone = c.options;
    alone.folder = c.folder.file("alone");
    alone.from = alone.to = frame.time;
    replay(alone);
    const std::string picture = "/frames/" + with_zeros(frame.frame, 6) + ".png";
    EXPECT_TRUE(read_text(alone.folder + picture) == read_text(c.options.folder + picture))
        << picture;
  }
}

TEST(Replay, says_that_no_frame_lies_in_the_chosen_time) {
  RunToReplay c;
  c.options.from = 100;
  EXPECT_TRUE(
      contains(error_of([&] { replay(c.options); }), "no recorded frame lies in the chosen time"));
}

TEST(Replay, lists_frames_with_times_and_digests_and_writes_nothing) {
  RunToReplay c;
  c.options.is_list = true;
  testing::internal::CaptureStdout();
  replay(c.options);
  const std::string text = testing::internal::GetCapturedStdout();
  for (const RecordedFrame& frame : c.run.frames)
    EXPECT_TRUE(contains(text, digest_text(frame.digest)));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'),
            static_cast<std::ptrdiff_t>(c.run.frames.size()));
  EXPECT_FALSE(std::filesystem::exists(c.options.folder));
}

TEST(Replay, lists_the_whole_frames_behind_a_damaged_one) {
  RunToReplay c;
  c.options.is_list = true;
  const std::int64_t damaged = c.run.frames[1].frame;
  Database(c.options.recording, Database::Mode::read)
      .run("UPDATE frame SET u = zeroblob(length(u)) WHERE frame = " + std::to_string(damaged));
  testing::internal::CaptureStdout();
  const std::string error = error_of([&] { replay(c.options); });
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_TRUE(contains(error, "frame " + std::to_string(damaged) + ": damaged")) << error;
  EXPECT_TRUE(contains(error, "1 of 6 frames are damaged")) << error;
  for (std::size_t k = 0; k < c.run.frames.size(); ++k)
    EXPECT_EQ(contains(text, digest_text(c.run.frames[k].digest)), k != 1) << k;
}

TEST(Replay, says_that_it_has_nothing_to_do) {
  RunToReplay c;
  c.options.writes_vtu = false;
  EXPECT_TRUE(contains(error_of([&] { replay(c.options); }), "--vtu"));
}

TEST(Replay, names_a_camera_that_the_scene_lacks) {
  RunToReplay c;
  c.options.writes_frames = true;
  c.options.camera = "other";
  EXPECT_TRUE(contains(error_of([&] { replay(c.options); }), "no camera \"other\"; there"));
}

TEST(Replay, does_not_write_a_film_over_its_recording) {
  RunToReplay c;
  c.options.folder = c.folder.path();
  c.options.video = "./r";
  const std::string before = read_text(c.options.recording);
  EXPECT_TRUE(contains(error_of([&] { replay(c.options); }), "would replace its recording"));
  EXPECT_EQ(read_text(c.options.recording), before);
}

TEST(Replay, says_which_folder_can_not_be_made) {
  RunToReplay c;
  write_text(c.options.folder, "a file");
  EXPECT_TRUE(contains(error_of<MachineError>([&] { replay(c.options); }), c.options.folder));
}

TEST(Replay, shows_the_other_frames_of_a_damaged_recording) {
  RunToReplay c;
  Database(c.options.recording, Database::Mode::read)
      .run("UPDATE frame SET step = step + 1 WHERE frame = 4");
  replay(c.options);
  for (const RecordedFrame& frame : c.run.frames)
    EXPECT_EQ(std::filesystem::exists(c.vtu(frame.frame)), frame.frame != 4);
}

TEST(Replay, refuses_a_frame_whose_displacements_are_not_those_of_the_mesh) {
  RunToReplay c;
  c.run.frames[3].u.resize(3);
  write_run(c.run, c.options.recording);
  EXPECT_TRUE(contains(error_of([&] { replay(c.options); }), "1 displacements for"));
}

}  // namespace
}  // namespace trocar
