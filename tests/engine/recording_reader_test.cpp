#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/database.h"
#include "engine/recording.h"
#include "engine_recording.h"
#include "engine_split.h"
#include "engine_started.h"

namespace trocar {
namespace {

TEST(RecordingReader, gives_back_what_was_recorded) {
  const TestFolder folder;
  const ExampleRun run = example_run(9);
  write_run(run, folder.file("r"));
  RecordingReader reader(folder.file("r"));
  EXPECT_TRUE(is_equal(reader.head(), run.head));
  EXPECT_TRUE(reader.damage().empty());
  ASSERT_EQ(reader.frames().size(), run.frames.size());
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    EXPECT_EQ(reader.frames()[k], std::pair(run.frames[k].frame, run.frames[k].time));
    EXPECT_TRUE(is_equal(reader.read(run.frames[k].frame), run.frames[k])) << k;
  }
}

TEST(RecordingReader, meshes_are_the_first_with_the_edits_up_to_the_frame_in_any_order_of_asking) {
  const TestFolder folder;
  const ExampleRun run = example_run(9);
  write_run(run, folder.file("r"));
  RecordingReader reader(folder.file("r"));
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < 9; ++k) order.push_back(k);
  for (std::size_t k = 9; k-- > 0;) order.push_back(k);
  for (const std::size_t k : {5, 0, 8, 2, 2, 7, 1}) order.push_back(k);
  for (const std::size_t k : order) {
    EXPECT_TRUE(reader.mesh_at(run.frames[k].frame) == run.meshes[k]) << k;
    std::int64_t n_edits = 0;
    for (std::size_t j = 0; j <= k; ++j) n_edits += std::ssize(run.edits[j]);
    EXPECT_EQ(reader.n_edits(), n_edits) << k;
  }
}

// And displacements that belong to it.
TEST(RecordingReader, has_the_mesh_of_each_frame_of_a_run_whose_cut_splits_elements) {
  const auto plate = built(plate_of("tet4-five") + "[[support]]\nregion = \"x+\"\n" + plate_blade +
                           "[[output]]\nkind = \"recording\"\nfile = \"r\"\n");
  Simulation& s = *plate->s;
  auto outputs = std::make_unique<Outputs>(open_outputs(s, plate->folder.path(), "", nullptr));
  std::vector<Mesh> meshes;
  std::vector<std::vector<double>> u;
  std::int32_t n_most_added = 0;
  while (s.frame < 16) {
    const std::int32_t n_before = s.mesh.n_elements();
    run_frame(s, *outputs);
    n_most_added = std::max(n_most_added, s.mesh.n_elements() - n_before);
    meshes.push_back(s.mesh);
    u.push_back(gather_state(s).u);
  }
  finish_outputs(*outputs);
  outputs.reset();  // its lock
  EXPECT_GT(n_most_added, 1000);
  RecordingReader reader(plate->folder.file("r"));
  EXPECT_TRUE(reader.damage().empty());
  for (std::int64_t frame = 16; frame > 0; --frame) {
    const auto k = static_cast<std::size_t>(frame - 1);
    EXPECT_TRUE(reader.mesh_at(frame) == meshes[k]) << frame;
    EXPECT_EQ(reader.read(frame).u, u[k]) << frame;
  }
}

TEST(RecordingReader, frames_without_nodes_forces_or_tools_are_frames_too) {
  const TestFolder folder;
  ExampleRun run = example_run(1);
  run.head.tool_meshes.clear();
  run.frames[0].u.clear();
  run.frames[0].tool_forces.clear();
  write_run(run, folder.file("r"));
  RecordingReader reader(folder.file("r"));
  EXPECT_TRUE(is_equal(reader.head(), run.head));
  EXPECT_TRUE(is_equal(reader.read(0), run.frames[0]));
}

TEST(RecordingReader, names_a_frame_that_is_not_recorded) {
  const TestFolder folder;
  write_run(example_run(3), folder.file("r"));
  RecordingReader reader(folder.file("r"));
  EXPECT_EQ(error_of([&] { reader.read(3); }), folder.file("r") + ": frame 3: is not recorded");
  EXPECT_EQ(error_of([&] { reader.mesh_at(3); }), folder.file("r") + ": frame 3: is not recorded");
}

TEST(RecordingReader, says_what_a_file_is_that_is_no_recording) {
  const TestFolder folder;
  const auto trouble = [](const std::string& file) {
    return error_of([&] { RecordingReader r(file); });
  };
  EXPECT_EQ(trouble(folder.file("absent")), folder.file("absent") + ": no such recording");
  EXPECT_EQ(trouble(folder.path()), folder.path() + ": is not a file");
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_EQ(trouble(folder.file("pipe")), folder.file("pipe") + ": is not a file");
  EXPECT_TRUE(contains(trouble(write_text(folder.file("text"), "name = \"no recording\"\n")),
                       "is no readable recording"));
  EXPECT_TRUE(contains(trouble(write_text(folder.file("empty"), "")), "is no readable recording"));
}

// Changes a finished recording by SQL, as another program could.
void change(const std::string& file, const std::string& sql) {
  Database(file, Database::Mode::read).run(sql);
}

TEST(RecordingReader, refuses_another_format_by_its_number) {
  const TestFolder folder;
  write_run(example_run(1), folder.file("r"));
  change(folder.file("r"), "UPDATE head SET format = 99");
  EXPECT_TRUE(
      contains(error_of([&] { RecordingReader r(folder.file("r")); }), "has recording format 99"));
}

TEST(RecordingReader, finds_every_changed_column_of_a_frame_and_keeps_the_others) {
  const ExampleRun run = example_run(7);
  for (const std::string column :
       {"frame", "place", "n_edits", "step", "time", "digest", "crc", "row_crc"}) {
    const TestFolder folder;
    write_run(run, folder.file("r"));
    change(folder.file("r"),
           "UPDATE frame SET " + column + " = " + column + " + 1 WHERE frame = 6");
    RecordingReader reader(folder.file("r"));
    EXPECT_FALSE(reader.damage().empty()) << column;
    EXPECT_EQ(reader.frames().size(), 6u) << column;
    EXPECT_THROW(reader.read(6), InputError) << column;
    EXPECT_THROW(reader.mesh_at(6), InputError) << column;
    for (const auto& [frame, time] : reader.frames()) {
      EXPECT_TRUE(is_equal(reader.read(frame), run.frames[static_cast<std::size_t>(frame) / 2]));
      EXPECT_TRUE(reader.mesh_at(frame) == run.meshes[static_cast<std::size_t>(frame) / 2]);
    }
  }
}

TEST(RecordingReader, finds_every_changed_column_of_head_tool_and_edit) {
  const std::vector<std::string> changes = {"UPDATE head SET version = 'another'",
                                            "UPDATE head SET scene = scene || ' '",
                                            "UPDATE head SET n_tools = 1",
                                            "UPDATE head SET crc = crc + 1",
                                            "UPDATE head SET size = size + 1",
                                            "UPDATE tool SET number = 2 WHERE number = 1",
                                            "DELETE FROM tool WHERE number = 1",
                                            "UPDATE tool SET crc = crc + 1",
                                            "DELETE FROM head"};
  for (const std::string& sql : changes) {
    const TestFolder folder;
    write_run(example_run(2), folder.file("r"));
    change(folder.file("r"), sql);
    EXPECT_THROW(RecordingReader(folder.file("r")), InputError) << sql;
  }
}

TEST(RecordingReader, finds_lost_exchanged_and_changed_edits) {
  const ExampleRun run = example_run(7);
  for (const std::string sql :
       {"DELETE FROM edit WHERE number = 1", "UPDATE edit SET frame = 2 WHERE number = 1",
        "UPDATE edit SET crc = 1 WHERE number = 1",
        "UPDATE edit SET (change, size, crc) = (SELECT change, size, crc FROM edit WHERE number = "
        "2)"}) {
    const TestFolder folder;
    write_run(run, folder.file("r"));
    change(folder.file("r"), sql);
    RecordingReader reader(folder.file("r"));
    EXPECT_TRUE(contains(error_of([&] { reader.mesh_at(12); }), ": edit ")) << sql;
    EXPECT_TRUE(is_equal(reader.read(12), run.frames[6])) << sql;
    EXPECT_TRUE(reader.mesh_at(0) == run.meshes[0]) << sql;
  }
}

TEST(RecordingReader, says_when_frames_are_gone_from_the_middle_or_the_end) {
  for (const std::string which : {"frame = 0", "frame = 6", "frame >= 10", "frame >= 0"}) {
    const TestFolder folder;
    write_run(example_run(7), folder.file("r"));
    change(folder.file("r"), "DELETE FROM frame WHERE " + which);
    EXPECT_EQ(RecordingReader(folder.file("r")).damage().size(), 1u) << which;
  }
}

// A hostile file has the right checksums: numbers out of range must not be followed.
TEST(RecordingReader, refuses_edits_that_do_not_fit_the_mesh) {
  const std::vector<void (*)(MeshEdit&)> wrongs = {
      [](MeshEdit& e) { e.moves[0].node = 12; },
      [](MeshEdit& e) { e.moves[0].node = -1; },
      [](MeshEdit& e) { e.duplicate_parent[0] = 12; },
      [](MeshEdit& e) { e.corners[0].element = 1 << 30; },
      [](MeshEdit& e) { e.corners[0].corner = 3; },
      [](MeshEdit& e) { e.corners[0].node = 13; },
      [](MeshEdit& e) { e.cut_facets[0].element = -5; },
      [](MeshEdit& e) { e.density[0].element = 12; },
      [](MeshEdit& e) {
        e.inserted = {{.end = {5, 3}, .s = 0.5}};
      },
      [](MeshEdit& e) {
        e.inserted = {{.end = {3, 12}, .s = 0.5}};
      },
      [](MeshEdit& e) {
        e.inserted = {{.end = {3, 5}, .s = 1}};
      },
      [](MeshEdit& e) { e.splits = {{.element = 0, .n_tets = 2}}; }};
  for (std::size_t k = 0; k < wrongs.size(); ++k) {
    const TestFolder folder;
    ExampleRun run = example_run(3);
    wrongs[k](run.edits[2][0]);
    write_run(run, folder.file("r"));
    RecordingReader reader(folder.file("r"));
    EXPECT_TRUE(contains(error_of([&] { reader.mesh_at(4); }), "edit 0: does not fit the mesh"))
        << k;
    EXPECT_TRUE(reader.mesh_at(2) == run.meshes[1]) << k;
  }
}

TEST(RecordingReader, refuses_a_mesh_with_broken_invariants) {
  const TestFolder folder;
  ExampleRun run = example_run(1);
  run.head.mesh.corner_node[4] = 1 << 20;
  write_run(run, folder.file("r"));
  EXPECT_TRUE(contains(error_of([&] { RecordingReader r(folder.file("r")); }), "1048576"));
}

TEST(RecordingReader, leaves_the_file_and_its_folder_as_they_were) {
  const TestFolder folder;
  const ExampleRun run = example_run(4);
  write_run(run, folder.file("r"));
  const std::string before = read_text(folder.file("r"));
  {
    RecordingReader reader(folder.file("r"));
    reader.mesh_at(6);
    EXPECT_FALSE(std::filesystem::exists(folder.file("r-wal")));
    EXPECT_FALSE(std::filesystem::exists(folder.file("r-shm")));
  }
  EXPECT_EQ(read_text(folder.file("r")), before);
}

// A limit on the size of files stands for a full disk: no index of the log can be written beside
// it.
TEST(RecordingReader, says_on_a_full_disk_that_the_log_of_a_killed_run_can_be_read_elsewhere) {
  const TestFolder folder;
  const ExampleRun run = example_run(4);
  RecordingWriter writer(folder.file("r"), run.head);
  for (const char* tail : {"", "-wal"})
    std::filesystem::copy_file(folder.file("r") + tail, folder.file("killed") + tail);
  const auto read = [&] { RecordingReader reader(folder.file("killed")); };
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit none{.rlim_cur = 0, .rlim_max = 0};
    setrlimit(RLIMIT_FSIZE, &none);
    _exit(contains(error_of<MachineError>(read), "copy both elsewhere") ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(error_of<MachineError>(read), "");
}

// What can be told from a file: the frames that are read are right and those that are not there are
// reported.
// "" if so, else what went wrong silently.
std::string silent_fault(const std::string& file, const ExampleRun& run, int& n_refused) {
  try {
    RecordingReader reader(file);
    if (!is_equal(reader.head(), run.head)) return "another head";
    if (reader.frames().size() != run.frames.size() && reader.damage().empty())
      return "frames are gone";
    for (const auto& [frame, time] : reader.frames()) {
      const auto k = static_cast<std::size_t>(frame / 2);
      if (frame % 2 != 0 || k >= run.frames.size() || time != run.frames[k].time)
        return "another frame list";
      try {
        if (!is_equal(reader.read(frame), run.frames[k]))
          return "another frame " + std::to_string(frame);
        if (reader.mesh_at(frame) != run.meshes[k])
          return "another mesh in frame " + std::to_string(frame);
      } catch (const InputError&) {
        ++n_refused;
      }
    }
    if (!reader.damage().empty()) ++n_refused;
  } catch (const InputError&) {
    ++n_refused;
  }
  return {};
}

// The same rows on small pages: less empty space, so that every byte can be tried.
void make_compact(const std::string& file) {
  Database(file, Database::Mode::read).run("PRAGMA page_size=512; VACUUM;");
}

TEST(RecordingReader, finds_every_changed_byte_of_a_file_or_it_is_harmless) {
  const TestFolder folder;
  const std::string file = folder.file("r");
  const ExampleRun run = example_run(4);
  write_run(run, file);
  make_compact(file);
  const std::string sound = read_text(file);
  int n_refused = 0;
  ASSERT_EQ(silent_fault(file, run, n_refused), "");
  ASSERT_EQ(n_refused, 0);
  for (std::size_t n = 0; n < sound.size(); ++n)
    for (const int change : {0x01, 0xff}) {
      const int handle = open(file.c_str(), O_WRONLY);
      const char wrong = static_cast<char>(sound[n] ^ change);
      ASSERT_EQ(pwrite(handle, &wrong, 1, static_cast<off_t>(n)), 1);
      EXPECT_EQ(silent_fault(file, run, n_refused), "") << "byte " << n << " changed by " << change;
      ASSERT_EQ(pwrite(handle, &sound[n], 1, static_cast<off_t>(n)), 1);
      close(handle);
      std::filesystem::remove(file + "-wal");
      std::filesystem::remove(file + "-journal");
    }
  EXPECT_EQ(read_text(file), sound);
  RecordProperty("bytes", static_cast<int>(sound.size()));
  RecordProperty("refused", n_refused);
  // A checksum covers at least the texts of the head and the 6 forces of each of the 4 frames.
  const std::size_t n_covered = run.head.scene.size() + run.head.version.size() + 4 * 6 * 8;
  EXPECT_GE(n_refused, static_cast<int>(2 * n_covered));
}

TEST(RecordingReader, finds_that_a_file_was_cut_off_at_any_length) {
  const TestFolder folder;
  const ExampleRun run = example_run(4);
  write_run(run, folder.file("r"));
  make_compact(folder.file("r"));
  const std::string sound = read_text(folder.file("r"));
  int n_refused = 0;
  for (std::size_t n = 0; n < sound.size(); ++n) {
    const std::string file = write_text(folder.file("short"), sound.substr(0, n));
    EXPECT_EQ(silent_fault(file, run, n_refused), "") << n;
    EXPECT_GT(n_refused, 0) << n;
    n_refused = 0;
  }
}

}  // namespace
}  // namespace trocar
