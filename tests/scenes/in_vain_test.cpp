// What a scene asks for in vain is told: loads on what can't move, markers without metrics,
// graspers and blades that meet no tissue.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "mesh/element_boxes.h"
#include "mesh/generate.h"
#include "mesh_joined.h"
#include "mesh_write.h"
#include "program.h"

namespace trocar {
namespace {

const std::string block = R"(
[time]
duration = "0.06 s"
frame_rate = "50 Hz"
[tissue.shape]
kind = "box"
elements = "hex8"
high = ["20 mm", "20 mm", "20 mm"]
cells = [4, 4, 4]
[tissue.material]
young_modulus = "5 kPa"
poisson_ratio = 0.4
density = 1000
[[support]]
region = "z-"
)";

struct Told {
  Finished run;
  std::string events;
};

// Of the block and what else a scene has.
Told told(const std::string& more, const std::string& folder) {
  const std::string file = folder + "/scene.toml";
  std::ofstream(file) << block + more;
  Told result{.run = run_trocar({"run", file, "-q", "-o", folder}, folder), .events = {}};
  const nlohmann::json summary = read_summary(folder);
  if (!summary.is_discarded()) result.events = summary["events"].dump();
  return result;
}

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(InVain, loads_on_what_cannot_move_and_markers_without_metrics_are_warned_of) {
  const std::string in_vain =
      "[[load]]\nregion = \"z-\"\nforce = [1, 0, 1]\n"
      "[[marker]]\nname = \"m\"\nposition = [0, 0, 0]\n";
  const Finished run = told(in_vain, test_folder("in-vain")).run;
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_TRUE(has(run.err, "load[0] moves nothing: supports hold all nodes of region \"z-\""));
  EXPECT_TRUE(has(run.err, "markers do nothing: there is no [[output]] of kind \"metrics\""));
}

TEST(InVain, nothing_is_said_of_loads_and_markers_that_serve) {
  const std::string of_use =
      "[[load]]\nregion = \"x+\"\npressure = 1\n"
      "[[marker]]\nname = \"m\"\nposition = [0, 0, 0]\n"
      "[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\n";
  const Told all = told(of_use, test_folder("of-use"));
  EXPECT_EQ(all.run.exit_code, 0);
  EXPECT_EQ(all.run.err, "");
  EXPECT_EQ(all.events, "[]");
}

TEST(InVain, instruments_that_meet_no_tissue_are_told_by_name) {
  const std::string pose = "position = [\"10 mm\", \"-40 mm\", \"30 mm\"], direction = [0, 0, -1]";
  const Told all = told(
      "[[instrument]]\nkind = \"grasper\"\nname = \"left hand\"\nradius = \"2 mm\"\n"
      "grip_radius = \"5 mm\"\npath = [{ time = 0, " +
          pose + " }, { time = \"0.02 s\", " + pose +
          ", action = \"close\" }, { time = \"0.04 s\", " + pose +
          ", action = \"open\" }]\n"
          "[[instrument]]\nkind = \"scalpel\"\nblade_length = \"9 mm\"\n"
          "path = [{ time = 0, " +
          pose +
          " }]\n[[instrument]]\nkind = \"scissors\"\nblade_length = \"9 mm\"\n"
          "path = [{ time = 0, " +
          pose + " }]\n[[instrument]]\nkind = \"probe\"\nname = \"thumb\"\npath = [{ time = 0, " +
          pose + " }]\n",
      test_folder("no-tissue"));
  EXPECT_EQ(all.run.exit_code, 0);
  // sqrt(40^2 + 10^2) mm to the edge of the top.
  EXPECT_TRUE(has(all.events,
                  "0.020 s: left hand closes on nothing: the nearest free node is 41.2 mm from its "
                  "tip, and it grips within 5 mm"))
      << all.events;
  EXPECT_TRUE(has(all.events, "0.040 s: left hand opens")) << all.events;
  EXPECT_TRUE(has(all.events, "thumb has touched nothing"));
  EXPECT_TRUE(has(all.events, "scalpel has cut nothing: its blade never met the tissue"));
  EXPECT_TRUE(has(all.events, "scissors has cut nothing: its jaws never closed on the tissue"));
}

TEST(InVain, parts_that_the_mesher_did_not_join_are_warned_of) {
  const std::string folder = test_folder("not-joined");
  const auto box = [](double x) {
    return make_box(Vec3(x, 0, 0), Vec3(x + 0.02, 0.02, 0.02), {2, 2, 2}, BoxElements::tet4_kuhn);
  };
  write_mesh(joined(box(0), box(0.02)), folder + "/two.msh");
  const std::string scene = folder + "/s.toml";
  std::ofstream(scene) << "[time]\nduration = 0.1\n[tissue]\nmesh = \"two.msh\"\n";
  const Finished run = run_trocar({"run", scene, "-q", "-o", folder}, folder);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_TRUE(has(run.err, "two.msh: is in 2 pieces, and 18 nodes lie where nodes of other pieces"))
      << run.err;
  EXPECT_FALSE(has(run.err, "m long"));
  const Finished large =
      run_trocar({"run", scene, "-q", "-o", folder, "--set", "tissue.scale=1000"}, folder);
  EXPECT_TRUE(has(large.err, "two.msh: is 40 m long: tissue.scale says")) << large.err;
  const Finished mesh = run_trocar({"mesh", folder + "/two.msh"}, folder);
  EXPECT_TRUE(has(mesh.out, "NOT JOINED        18 nodes")) << mesh.out;
}

TEST(InVain, pictures_without_tissue_are_warned_of) {
  const auto err_with = [&](const std::string& name, const std::string& camera) {
    return told(camera +
                    "[[output]]\nkind = \"frames\"\nfile = \"f\"\nevery = 0.02\nsize = [64, 48]\n",
                test_folder(name))
        .run.err;
  };
  EXPECT_TRUE(
      has(err_with("empty-pictures",
                   "[[camera]]\nname = \"roof\"\neye = [0, 0, 300]\ntarget = [0, 10, 300]\n"),
          "camera \"roof\" looks from (0, 0, 300) to (0, 10, 300) m and sees nothing of the "
          "tissue, which is around (0.01, 0.01, 0.01) m at the start"));
  EXPECT_EQ(err_with("pictures", "[[camera]]\neye = [0, -0.1, 0.1]\ntarget = [0, 0, 0]\n"), "");
}

TEST(InVain, intervals_and_files_of_an_earlier_run_are_told) {
  const std::string folder = test_folder("intervals");
  const std::string metrics = "[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\nevery = ";
  EXPECT_EQ(told(metrics + "0.02\n", folder).run.err, "");
  const std::string again = told(metrics + "0.03\n", folder).run.err;
  EXPECT_TRUE(has(again,
                  "output[0].every = 0.03 s is no whole number of frames of 50 Hz: it is "
                  "taken as 2 of them, 0.04 s"))
      << again;
  EXPECT_TRUE(has(again, "has files of an earlier run")) << again;
  EXPECT_TRUE(
      has(told(metrics + "2\n", folder).run.err,
          "output[0].every = 2 s is longer than the run: nothing is written into \"m.csv\""));
}

TEST(InVain, no_run_writes_over_what_it_reads) {
  const std::string folder = test_folder("inputs-stay");
  const std::string scene = folder + "/scene.toml",
                    more = "[[output]]\nkind = \"metrics\"\nfile = ";
  told("# mine\n", folder);
  std::ifstream stream(scene);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_TRUE(has(text, "# mine"));
  write_mesh(make_box(Vec3(0, 0, 0), Vec3(0.02, 0.02, 0.02), {2, 2, 2}, BoxElements::tet4_kuhn),
             folder + "/organ.msh");
  const std::string other = folder + "/other.toml";
  std::ofstream(other) << "[time]\nduration = 0.1\n[tissue]\nmesh = \"organ.msh\"\n"
                       << more << "\"organ.msh\"\n";
  const Finished run = run_trocar({"run", other, "-q", "-o", folder}, folder);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(has(run.err, "organ.msh, which it reads: choose another folder")) << run.err;
  // Elsewhere the scene as it was run can be run again.
  const std::string out = folder + "/out";
  EXPECT_EQ(run_trocar({"run", other, "-q", "-o", out}, folder).exit_code, 0);
  EXPECT_EQ(run_trocar({"check", out + "/scene.toml"}, folder).exit_code, 0);
}

TEST(InVain, run_whose_last_picture_cannot_be_written_has_its_summary) {
  const std::string folder = test_folder("no-picture");
  std::filesystem::create_directories(folder + "/c.png");  // in the picture's place
  const Told told_of = told(
      "[[camera]]\neye = [0, -0.1, 0.1]\ntarget = [0, 0, 0]\n[[output]]\nkind = "
      "\"contact-sheet\"\nfile = \"c.png\"\nevery = 0.02\n",
      folder);
  EXPECT_EQ(told_of.run.exit_code, 4) << told_of.run.err;
  const nlohmann::json summary = read_summary(folder);
  EXPECT_FALSE(summary["finished"].get<bool>());
  EXPECT_TRUE(has(summary["trouble"].get<std::string>(), "c.png"));
  EXPECT_GT(summary["steps"].get<int>(), 0);
}

const std::string pictures =
    "[[camera]]\neye = [0, -0.1, 0.1]\ntarget = [0, 0, 0]\n[[output]]\nkind = \"frames\"\nfile = "
    "\"f\"\nsize = [64, 48]\n";

// Of one rank and of two: the others must learn of the failure and not wait.
TEST(InVain, run_whose_output_fails_in_the_middle_has_its_summary_and_is_resumed) {
  for (const int ranks : {1, 2}) {
    const std::string folder = test_folder("no-third-picture");
    const std::string in_the_way = folder + "/f/000003.png";
    std::filesystem::create_directories(in_the_way);
    std::ofstream(folder + "/s.toml") << block << pictures
                                      << "[[output]]\nkind = \"recording\"\nfile = \"r.trocar\"\n"
                                         "[checkpoint]\nevery = 0.02\n";
    std::vector<std::string> words = {"run",   folder + "/s.toml", "-q", "-o", folder,
                                      "--set", "time.duration=2"};
    const Finished run = run_trocar_on(ranks, words, folder);
    EXPECT_EQ(run.exit_code, 4) << run.err;
    EXPECT_TRUE(has(run.err, "000003.png: can't be written: Is a directory; the run ends"));
    const nlohmann::json summary = read_summary(folder);
    ASSERT_FALSE(summary.is_discarded());
    EXPECT_FALSE(summary["finished"].get<bool>());
    EXPECT_TRUE(has(summary["trouble"].get<std::string>(), "000003.png"));
    EXPECT_GE(summary["frames"].get<int>(), 3);
    EXPECT_LT(summary["frames"].get<int>(), 100);
    std::filesystem::remove(in_the_way);
    words.emplace_back("--resume");
    EXPECT_EQ(run_trocar(words, folder).exit_code, 0);
    EXPECT_EQ(read_summary(folder)["frames"].get<int>(), 100);
  }
}

TEST(InVain, second_run_in_a_folder_in_use_is_refused) {
  const std::string folder = test_folder("in-use");
  const int other = open((folder + "/.trocar-lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  ASSERT_EQ(flock(other, LOCK_EX), 0);
  for (const int ranks : {1, 2}) {
    std::ofstream(folder + "/s.toml") << block;
    const Finished run =
        run_trocar_on(ranks, {"run", folder + "/s.toml", "-q", "-o", folder}, folder);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(has(run.err, "is in use by another run: choose another one with -o")) << run.err;
    EXPECT_TRUE(read_summary(folder).is_discarded());
  }
  close(other);
  EXPECT_EQ(told("", folder).run.exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder + "/.trocar-lock"));
}

TEST(InVain, supports_of_the_same_nodes_are_told) {
  const auto run_with = [](const std::string& support) {
    return told("[[support]]\nregion = " + support + "\n", test_folder("two-supports")).run;
  };
  EXPECT_TRUE(has(run_with("\"z-\"").err,
                  "support[1] adds nothing: its nodes (region \"z-\") are held in the same way "
                  "without it, by support[0]"));
  const std::string path =
      "path = [{ time = 0, displacement = [0, 0, 0] }, { time = 0.06, displacement = ";
  const Finished against = run_with("\"z-\"\n" + path + "[0.001, 0, 0] }]");
  EXPECT_EQ(against.exit_code, 2);
  EXPECT_TRUE(
      has(against.err,
          "support[1].region: all its 25 nodes (region \"z-\") are held by support[0], which "
          "moves them otherwise"))
      << against.err;
  // The edge of five nodes that two sides of the block share.
  EXPECT_TRUE(has(run_with("\"x+\"\n" + path + "[0.001, 0, 0] }]").err,
                  "support[1]: support[0] holds 5 of its 25 nodes otherwise, and keeps them "
                  "in the components that both name"));
  EXPECT_EQ(run_with("\"x+\"\nfix = \"x\"").err, "");
}

TEST(InVain, of_two_motions_of_a_region_the_second_is_refused_unless_it_is_the_same) {
  const auto err_with = [](const std::string& first, const std::string& second) {
    const auto support = [](const std::string& z) {
      return "[[support]]\nregion = \"z+\"\npath = [{ time = 0, displacement = [0, 0, 0] }, { time "
             "= 0.06, displacement = [0, 0, " +
             z + "] }]\n";
    };
    return told(support(first) + support(second), test_folder("two-motions")).run.err;
  };
  EXPECT_TRUE(has(err_with("0.001", "-0.001"), "support[2].region: all its 25 nodes"));
  EXPECT_TRUE(has(err_with("0.001", "0.001"), "support[2] adds nothing"));
}

TEST(InVain, jaws_that_cannot_follow_are_told) {
  const auto err_with = [](const std::string& open_at) {
    const std::string pose = "position = [0, 0, 0.1]";
    return told("[[instrument]]\nkind = \"scissors\"\npath = [{ time = 0, " + pose +
                    " }, { time = 0.3, " + pose + ", action = \"close\" }, { time = " + open_at +
                    ", " + pose + ", action = \"open\" }]\n",
                test_folder("hasty"))
        .run.err;
  };
  EXPECT_TRUE(has(err_with("0.35"),
                  "instrument[0].path[2]: \"scissors\" turns its jaws round after 0.05 s, but they "
                  "take 0.2 s: they don't close fully"))
      << err_with("0.35");
  EXPECT_EQ(err_with("0.5"), "");
}

TEST(InVain, body_that_nothing_deforms_names_no_least_element) {
  const std::string folder = test_folder("at-rest");
  told("", folder);
  const nlohmann::json least = read_summary(folder)["least_det_F"];
  EXPECT_EQ(least["value"], 1.0);
  EXPECT_FALSE(least.contains("element"));
}

TEST(InVain, keys_without_effect_and_constants_that_soften_are_warned_of) {
  const Finished run =
      told(
          "[solver]\ntetrahedron = \"nodal-pressure\"\n[[output]]\nkind = \"metrics\"\nfile = "
          "\"m.csv\"\nsize = [64, 48]\n",
          test_folder("unused"))
          .run;
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_TRUE(has(run.err, "solver.tetrahedron has no effect: the body has no tetrahedra"))
      << run.err;
  EXPECT_TRUE(has(run.err, "output[0].size has no effect: only pictures have it")) << run.err;
  const std::string folder = test_folder("softens");
  const Finished softens = run_trocar(
      {"run", config("block_hex.toml"), "-q", "-o", folder, "--set", "time.duration=0.1", "--set",
       "output=[]", "--set", "tissue.material={model = 'yeoh', c1 = 900, c2 = -5000}"},
      folder);
  EXPECT_TRUE(has(softens.err,
                  "tissue.material: with these constants its stress falls beyond a "
                  "stretch of"))
      << softens.err;
}

// It stabs the body and moves on by less than half a cell.
TEST(InVain, blade_that_opens_no_face_has_cut_nothing) {
  const Told all = told(
      "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.004\npath = [{ time = 0, position = "
      "[0.01, 0.01, 0.025] }, { time = 0.02, position = [0.01, 0.01, 0.017] }, { time = 0.04, "
      "position = [0.012, 0.01, 0.017] }]\n",
      test_folder("opens-nothing"));
  EXPECT_TRUE(has(all.events, "scalpel has cut nothing: no more than 2.24 mm of its edge was in"))
      << all.events;
}

// A sheet of 3 mm in one layer of cells of 5 mm: its tip ends in the middle, and is held back.
TEST(InVain, blade_that_ends_inside_a_sheet_of_one_element_is_told_what_helps) {
  const auto sheet = [](const std::string& cells, const std::string& tip) {
    const std::string folder = test_folder("sheet");
    std::ofstream(folder + "/s.toml")
        << "[time]\nduration = 0.5\n[tissue.shape]\nkind = \"box\"\nelements = \"tet4-five\"\n"
           "high = [0.06, 0.04, 0.003]\ncells = [12, 8, "
        << cells
        << "]\n[tissue.material]\nyoung_modulus = 8000\n[cutting]\nresistance = 5\n[[support]]\n"
           "region = \"x-\"\n[[support]]\nregion = \"x+\"\n[[instrument]]\nkind = \"scalpel\"\n"
           "path = [{ time = 0, position = [0.01, 0.021, 0.01] }, { time = 0.1, position = [0.01, "
           "0.021, "
        << tip << "] }, { time = 0.4, position = [0.04, 0.021, " << tip
        << "] }, { time = 0.5, position = [0.04, 0.021, 0.01] }]\n";
    EXPECT_EQ(run_trocar({"run", folder + "/s.toml", "-q", "-o", folder}, folder).exit_code, 0);
    return read_summary(folder)["events"].dump();
  };
  const std::string thin = sheet("1", "0.0015");
  EXPECT_TRUE(has(thin, "scalpel has cut nothing: no more than 1.")) << thin;
  EXPECT_TRUE(has(thin, "a finer mesh, or let the blade go through (resistance is felt")) << thin;
  for (const std::string& helped : {sheet("1", "-0.003"), sheet("3", "0.0008")})
    EXPECT_FALSE(has(helped, "has cut nothing")) << helped;
}

// The blade dips into one of two bodies by a hundredth of an edge.
TEST(InVain, stroke_without_an_edit_tells_no_figures_of_edits) {
  const std::string folder = test_folder("no-edit");
  const auto box = [](double x) {
    return make_box(Vec3(x, 0, 0), Vec3(x + 0.02, 0.02, 0.02), {2, 2, 2}, BoxElements::tet4_kuhn);
  };
  write_mesh(joined(box(0), box(0.03)), folder + "/two.msh");
  std::ofstream(folder + "/s.toml")
      << "[time]\nduration = 0.3\n[tissue]\nmesh = \"two.msh\"\n[[instrument]]\nkind = "
         "\"scalpel\"\npath = [{ time = 0, position = [-0.01, 0.011, 0.012] }, { time = 0.1, "
         "position = [0.0001, 0.011, 0.012] }, { time = 0.2, position = [-0.01, 0.011, 0.012] }]\n";
  const Finished run = run_trocar({"run", folder + "/s.toml", "-q", "-o", folder}, folder);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json cuts = read_summary(folder)["cuts"];
  ASSERT_EQ(cuts.size(), 1u);
  ASSERT_EQ(cuts[0]["edits"], 0);
  EXPECT_EQ(cuts[0]["pieces"], 2);
  for (const char* const key : {"quality_min", "edge_mean_m", "deviation_max_m", "mass_change"})
    EXPECT_FALSE(cuts[0].contains(key)) << key;
}

TEST(InVain, volumes_of_a_mesh_file_are_regions_of_supports_and_loads) {
  const std::string folder = test_folder("volumes");
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(0.02, 0.02, 0.02), {2, 2, 2}, BoxElements::tet4_kuhn);
  mesh.region_name = {"upper", "floor"};
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    mesh.element_region[e] = element_box(mesh, e, mesh.X).high.z() < 0.011 ? 1 : 0;
  write_mesh(mesh, folder + "/m.msh");
  const auto run_with = [&](const std::string& region) {
    std::ofstream(folder + "/s.toml")
        << "[time]\nduration = 0.1\n[tissue]\nmesh = \"m.msh\"\n[[support]]\nregion = \"" + region +
               "\"\n[[load]]\nregion = \"floor\"\nforce = [0, 0, 1]\n";
    return run_trocar({"run", folder + "/s.toml", "-q", "-o", folder}, folder);
  };
  // Nodes of the lower half are all held, so that the load on them moves nothing.
  const Finished held = run_with("floor");
  EXPECT_EQ(held.exit_code, 0) << held.err;
  EXPECT_TRUE(has(held.err, "load[0] moves nothing: supports hold all nodes of region \"floor\""))
      << held.err;
  const std::string err = run_with("flor").err;
  EXPECT_TRUE(has(err, "the body has no region \"flor\"") && has(err, "\"upper\"")) << err;
}

}  // namespace
}  // namespace trocar
