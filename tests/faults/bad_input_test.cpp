// Wrong input ends with one clear sentence on rank 0 and exit code 2 or 4, never a hang, on one
// rank and on two.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "program.h"
#include "replaced.h"

namespace trocar {
namespace {

constexpr int input_wrong = 2, machine_failed = 4;

// Copies a configuration into `folder` with one text replaced.
std::string changed_config(const std::string& folder, const std::string& name,
                           const std::string& from, const std::string& to) {
  const std::string file = folder + "/scene.toml";
  std::ofstream(file) << replaced(read_text(config(name)), from, to);
  return file;
}

int count(const std::string& text, const std::string& word) {
  int n = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

// One error, with these words, on one rank and on two.
void expect_refusal(const std::string& scene, const std::string& folder, int exit_code,
                    const std::string& words, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"run", scene, "-o", folder + "/out"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  for (const int ranks : {1, 2}) {
    const Finished run = ranks == 1 ? run_trocar(arguments, folder, 60)
                                    : run_trocar_on(ranks, arguments, folder, 60);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_EQ(count(run.err, "error"), 1) << "on " << ranks << " ranks: " << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  }
}

TEST(BadInput, a_misspelt_key_is_named_with_its_place_and_the_nearest_key) {
  const std::string folder = test_folder("misspelt");
  const std::string scene =
      changed_config(folder, "block_hex.toml", "young_modulus", "young_moduls");
  expect_refusal(scene, folder, input_wrong, scene + ":18:1: ");
  expect_refusal(scene, folder, input_wrong, "young_modulus");
}

TEST(BadInput, a_negative_density_is_refused_with_the_allowed_range) {
  const std::string folder = test_folder("density");
  const std::string scene = changed_config(folder, "block_hex.toml", "\"1060 kg/m^3\"", "-1060");
  expect_refusal(scene, folder, input_wrong, "density");
}

TEST(BadInput, a_poisson_ratio_of_one_half_is_refused) {
  const std::string folder = test_folder("poisson");
  const std::string scene =
      changed_config(folder, "block_hex.toml", "poisson_ratio = 0.45", "poisson_ratio = 0.5");
  expect_refusal(scene, folder, input_wrong, scene + ":19:17: ");
}

// Keys of wrong types, a value that is out of range and what only several keys tell; then, with
// these mended, names that the body does not have.
TEST(BadInput, all_that_is_wrong_with_a_scene_is_told_at_once) {
  const std::string folder = test_folder("at_once"), scene = folder + "/scene.toml";
  const std::string body = "[time]\nduration = 1\n[tissue.shape]\nkind = \"box\"\n";
  std::ofstream(scene) << body << "[contact]\nfriction = -1\n[[load]]\nregion = \"z+\"\n"
                       << "[[support]]\nregion = 3\n";
  expect_refusal(scene, folder, input_wrong,
                 scene + ":6:12: contact.friction: -1 is out of range; allowed: >= 0\n" +
                     "    friction = -1\n               ^\n" + scene +
                     ":7:1: load[0]: a load needs a force or a pressure that is not 0\n" +
                     "    [[load]]\n    ^\n" + scene +
                     ":10:10: support[0].region: needs a text in quotes, found the integer 3\n");
  std::ofstream(scene) << body << "[[support]]\nregion = \"a\"\n[[support]]\nregion = \"z\"\n";
  const std::string known = "there are \"x-\", \"x+\", \"y-\", \"y+\", \"z-\", \"z+\"\n";
  expect_refusal(scene, folder, input_wrong,
                 scene + ":6:10: support[0].region: the body has no region \"a\"; " + known +
                     "    region = \"a\"\n             ^\n" + scene +
                     ":8:10: support[1].region: the body has no region \"z\"; the nearest is " +
                     "\"z-\"; " + known);
}

TEST(BadInput, a_missing_mesh_is_named) {
  const std::string folder = test_folder("missing");
  const std::string scene =
      changed_config(folder, "liver_incision.toml", "meshes/liver.msh", "nothing.msh");
  expect_refusal(scene, folder, input_wrong, "nothing.msh");
}

TEST(BadInput, a_missing_instrument_mesh_with_an_absolute_path_is_named_as_it_was_given) {
  const std::string folder = test_folder("missing_tip");
  const std::string scene = changed_config(folder, "block_hex.toml", "radius = \"8 mm\"",
                                           "radius = \"8 mm\"\nmesh = \"/nowhere/tip.stl\"");
  expect_refusal(scene, folder, input_wrong, "mesh: /nowhere/tip.stl");
}

TEST(BadInput, a_truncated_mesh_is_refused) {
  const std::string folder = test_folder("truncated");
  const std::string whole = read_text(config("meshes/liver.msh"));
  std::ofstream(folder + "/cut.msh") << whole.substr(0, whole.size() / 2);
  const std::string scene =
      changed_config(folder, "liver_incision.toml", "meshes/liver.msh", "cut.msh");
  expect_refusal(scene, folder, input_wrong, "cut.msh");
}

TEST(BadInput, a_mesh_with_an_inverted_element_names_the_element) {
  const std::string folder = test_folder("inverted");
  write_tetrahedra(folder + "/bad.msh", {"0 0 0", "1 0 0", "0 1 0", "0 0 1", "0.3 0.3 -1"},
                   {"1 2 3 4", "1 2 3 5"});
  const std::string scene =
      changed_config(folder, "liver_incision.toml", "meshes/liver.msh", "bad.msh");
  expect_refusal(scene, folder, input_wrong, "inverted");
}

TEST(BadInput, a_mesh_with_a_sliver_that_would_take_for_ever_is_refused_with_its_element) {
  const std::string folder = test_folder("sliver");
  write_tetrahedra(folder + "/sliver.msh",
                   {"0 0 0", "1 0 0", "0 1 0", "0.3 0.3 1e-8", "0.3 0.3 -1"},
                   {"1 2 3 4", "1 3 2 5"});
  const std::string scene = folder + "/scene.toml";
  std::ofstream(scene) << "[time]\nduration = \"1 s\"\n[tissue]\nmesh = \"sliver.msh\"\nscale = "
                          "\"10 mm\"\n";
  expect_refusal(scene, folder, input_wrong, "because element 0 allows only");
}

TEST(BadInput, a_blade_that_is_longer_than_100000_edges_is_refused_before_it_is_divided) {
  expect_refusal(config("block_hex.toml"), test_folder("blade"), input_wrong,
                 "instrument[0].blade_length",
                 {"--set",
                  "instrument=[{kind='scalpel',blade_length=1e20,path=[{time=0,position="
                  "[0,0,1]}]}]"});
}

TEST(BadInput, a_generated_body_that_can_not_be_made_is_refused_with_its_place) {
  const std::string folder = test_folder("cells");
  const std::string scene =
      changed_config(folder, "block_hex.toml", "[20, 20, 20]", "[2000, 2000, 2000]");
  expect_refusal(scene, folder, input_wrong, scene + ":14:9: tissue.shape.cells: a generated mesh");
}

TEST(BadInput, a_step_factor_that_asks_for_millions_of_steps_a_frame_is_named_as_a_cause) {
  expect_refusal(config("block_hex.toml"), test_folder("factor"), input_wrong, "solver.step_factor",
                 {"--set", "solver.step_factor=1e-6"});
}

TEST(BadInput, an_unwritable_output_folder_is_refused) {
  const std::string folder = test_folder("unwritable");
  std::ofstream(folder + "/out") << "a file where the folder should be\n";
  expect_refusal(config("block_hex.toml"), folder, machine_failed, "can't be written");
}

TEST(BadInput, too_many_ranks_for_a_tiny_mesh_are_refused) {
  const std::string folder = test_folder("ranks");
  std::ofstream(folder + "/scene.toml")
      << "[time]\nduration = 1\n[tissue.shape]\nkind = \"box\"\ncells = [1, 1, 1]\n";
  const Finished run =
      run_trocar_on(64, {"run", folder + "/scene.toml", "-o", folder + "/out"}, folder, 120);
  EXPECT_EQ(run.exit_code, input_wrong) << run.err;
  EXPECT_EQ(count(run.err, "64 ranks"), 1) << run.err;
}

TEST(BadInput, an_unknown_command_suggests_the_nearest) {
  const std::string folder = test_folder("command");
  const Finished run = run_trocar({"rnu"}, folder);
  EXPECT_EQ(run.exit_code, input_wrong);
  EXPECT_NE(run.err.find("\"run\""), std::string::npos) << run.err;
}

TEST(BadInput, a_command_that_is_like_no_other_is_named) {
  const Finished run = run_trocar({"bogus-words"}, test_folder("bogus"));
  EXPECT_EQ(run.exit_code, input_wrong);
  EXPECT_NE(run.err.find("\"bogus-words\""), std::string::npos) << run.err;
}

TEST(BadInput, help_on_what_is_not_there_says_so) {
  const Finished run = run_trocar({"help", "bogus"}, test_folder("help-bogus"));
  EXPECT_EQ(run.exit_code, input_wrong);
  EXPECT_NE(run.err.find("no help on \"bogus\""), std::string::npos) << run.err;
}

TEST(Help, alone_and_on_a_command_is_that_of_the_option) {
  const std::string folder = test_folder("help");
  const Finished alone = run_trocar({"help"}, folder), on_run = run_trocar({"help", "run"}, folder);
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_EQ(alone.out, run_trocar({"--help"}, folder).out);
  EXPECT_EQ(on_run.exit_code, 0);
  EXPECT_EQ(on_run.out, run_trocar({"run", "--help"}, folder).out);
}

// Elements at the border between two ranks are computed on both.
TEST(BadInput, ranks_that_would_compute_with_different_instructions_are_refused) {
  const std::string folder = test_folder("simd");
  const auto run_with = [&](const std::string& first, const std::string& second) {
    const auto words_with = [&](const std::string& simd) {
      return std::vector<std::string>{"run", config("block_hex.toml"), "-o", folder, "--simd",
                                      simd};
    };
    std::vector<std::string> words = mpirun_words(1, TROCAR_PROGRAM, words_with(first));
    const std::vector<std::string> behind = mpirun_words(1, TROCAR_PROGRAM, words_with(second));
    words.push_back(":");
    words.push_back("-np");
    words.insert(words.end(), behind.begin() + 1, behind.end());
    return run_words(words, folder, 60);
  };
  const Finished different = run_with("sse2", "scalar");
  EXPECT_EQ(different.exit_code, input_wrong) << different.err;
  EXPECT_NE(different.err.find("--simd scalar"), std::string::npos) << different.err;
  const Finished unknown = run_with("sse2", "sse3");
  EXPECT_EQ(unknown.exit_code, input_wrong) << unknown.err;
  EXPECT_NE(unknown.err.find("\"sse3\""), std::string::npos) << unknown.err;
}

TEST(Help, that_can_not_be_printed_is_an_error_of_the_machine) {
  for (const char* words : {"help scene", "--help", "run --help", "--version"}) {
    const Finished run =
        run_words({"sh", "-c", std::string("\"$0\" ") + words + " > /dev/full", TROCAR_PROGRAM},
                  test_folder("help-full"));
    EXPECT_EQ(run.exit_code, machine_failed) << words;
    EXPECT_NE(run.err.find("standard output can't be written"), std::string::npos) << run.err;
  }
}

TEST(BadInput, study_and_replay_refuse_what_they_would_ignore) {
  const std::string folder = test_folder("study");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"study", "--all", "indentation"},
        {"study", "--all", "--meshes", "a.msh"},
        {"study", "--all", "--sleep", "0"},
        {"study", "--all", "--set", "time.duration=1"},
        {"study", "--list", "indentation"},
        {"study", "--list", "--all"},
        {"study", "--list", "--sizes", "4"},
        {"study", "--list", "-o", folder},
        {"replay", "r.trocar", "--list", "--video", "x.mp4"},
        {"replay", "r.trocar", "--list", "--frames"},
        {"replay", "r.trocar", "--list", "--vtu"},
        {"study", "indentation", "--docs", folder}}) {
    const Finished run = run_trocar(words, folder);
    EXPECT_EQ(run.exit_code, input_wrong) << run.out;
    // Of the scene's reader or of the command line's.
    EXPECT_EQ(count(run.err, "error") + count(run.err, "trocar: "), 1) << run.err;
  }
}

TEST(BadInput, a_scale_that_is_not_above_zero_is_refused) {
  const std::string folder = test_folder("scale");
  for (const std::string scale : {"0", "-1 mm"}) {
    const Finished run =
        run_trocar({"mesh", config("meshes/liver.msh"), "--scale=" + scale}, folder);
    EXPECT_EQ(run.exit_code, input_wrong) << run.err;
    EXPECT_NE(run.err.find("--scale: \"" + scale + "\" is out of range"), std::string::npos)
        << run.err;
  }
}

TEST(BadInput, a_frame_of_too_many_steps_names_the_material_as_a_cause) {
  const std::string folder = test_folder("stiff");
  expect_refusal(config("block_hex.toml"), folder, input_wrong, "too near poisson_ratio = 0.5",
                 {"--set", "tissue.material.poisson_ratio=0.4999999999999"});
}

TEST(BadInput, what_elements_can_not_be_is_refused_with_its_place) {
  const std::string folder = test_folder("misfit"), scene = folder + "/scene.toml";
  std::ofstream(scene) << "[time]\nduration = 1\n[tissue.shape]\nkind = \"ball\"\n"
                          "elements = \"tet4-five\"\n[tissue.material]\nmodel = \"linear\"\n"
                          "[solver]\ntetrahedron = \"nodal-pressure\"\n";
  expect_refusal(scene, folder, input_wrong, ":5:12: tissue.shape.elements: balls and cylinders");
  expect_refusal(scene, folder, input_wrong, ":6:1: tissue.material: tet4-nodal-pressure elements",
                 {"--set", "tissue.shape.elements=tet4-kuhn"});
  std::ofstream(scene, std::ios::app) << "[[instrument]]\nkind = \"scalpel\"\n[[instrument.path]]\n"
                                         "time = 0\nposition = [0, 0, 1]\n";
  expect_refusal(scene, folder, input_wrong, ":9:15: solver.tetrahedron: a cut makes tetrahedra",
                 {"--set", "tissue.shape.elements=hex8"});
}

// Its last corner is pushed in: the element has a volume, but not at each of its eight points. Only
// one of the ranks has it; the others waited for ever.
TEST(BadInput, an_element_that_is_bent_too_far_is_refused_on_every_rank) {
  const std::string folder = test_folder("bent"), scene = folder + "/scene.toml";
  std::ofstream mesh(folder + "/bar.msh");
  mesh << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n20\n";
  for (int i = 0; i < 19; ++i)
    mesh << i + 1 << ' ' << 5 * (i / 4) << ' ' << 5 * (i / 2 % 2) << ' ' << 5 * (i % 2) << '\n';
  mesh << "20 16.5 1.5 1.5\n$EndNodes\n$Elements\n4\n";
  for (int e = 0; e < 4; ++e) {
    mesh << e + 1 << " 5 2 1 1";
    for (const int corner : {1, 5, 7, 3, 2, 6, 8, 4}) mesh << ' ' << 4 * e + corner;
    mesh << '\n';
  }
  mesh << "$EndElements\n" << std::flush;
  std::ofstream(scene) << "[time]\nduration = 0.1\n[tissue]\nmesh = \"bar.msh\"\nscale = \"1 mm\"\n"
                          "[solver]\nhexahedron = \"full\"\n[[region]]\nname = \"foot\"\n"
                          "low = [-1, -1, -1]\nhigh = [\"1 mm\", 1, 1]\n[[support]]\nregion = "
                          "\"foot\"\n";
  expect_refusal(scene, folder, input_wrong, "element 3 has no positive volume");
}

TEST(BadInput, a_region_without_elements_may_have_any_material) {
  const std::string folder = test_folder("empty_region"), scene = folder + "/scene.toml";
  std::ofstream(folder + "/cube.msh")
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"soft\"\n3 2 \"hard\"\n"
         "$EndPhysicalNames\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n"
         "7 1 1 1\n8 0 1 1\n$EndNodes\n$Elements\n1\n1 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n";
  std::ofstream(scene) << "[time]\nduration = 1\n[tissue]\nmesh = \"cube.msh\"\n"
                          "[[tissue.region_material]]\nregion = \"hard\"\n"
                          "[tissue.region_material.material]\nmodel = \"linear\"\n"
                          "[solver]\ntetrahedron = \"nodal-pressure\"\n"
                          "[[instrument]]\nkind = \"scalpel\"\n[[instrument.path]]\n"
                          "time = 0\nposition = [0, 0, 9]\n";
  EXPECT_EQ(run_trocar({"check", scene}, folder).exit_code, 0);
  const std::string of_soft = "tissue.region_material=[{region='soft', material={model='linear'}}]";
  expect_refusal(scene, folder, input_wrong, "a cut makes tetrahedra", {"--set", of_soft});
}

TEST(BadInput, one_number_for_a_vector_is_refused_with_what_it_needs) {
  const std::string folder = test_folder("vector");
  expect_refusal(config("block_hex.toml"), folder, input_wrong, "needs 3 numbers and a unit",
                 {"--set", "solver.gravity='9.81 m/s^2'"});
}

TEST(BadInput, a_region_that_is_not_there_lists_those_that_are) {
  const std::string folder = test_folder("region");
  const std::string scene =
      changed_config(folder, "block_hex.toml", "region = \"z-\"", "region = \"bottom\"");
  expect_refusal(scene, folder, input_wrong, "\"z+\"");
}

TEST(BadInput, a_region_of_a_name_that_the_body_has_is_refused) {
  expect_refusal(config("block_hex.toml"), test_folder("region-twice"), input_wrong,
                 "the body has a region \"z-\" already",
                 {"--set", "region=[{name='z-',low=[-1,-1,-1],high=[1,1,1]}]"});
}

TEST(BadInput, an_output_outside_its_folder_is_refused) {
  const std::string folder = test_folder("outside");
  const std::string scene = changed_config(folder, "block_hex.toml", "file = \"metrics.csv\"",
                                           "file = \"../metrics.csv\"");
  expect_refusal(scene, folder, input_wrong, "inside the output folder");
}

// From 0.1 s on a load that no step is small enough for.
TEST(Simulation, that_can_not_be_continued_ends_with_code_3_and_keeps_its_summary) {
  const std::string folder = test_folder("unstable");
  const Finished run = run_trocar(
      {"run", config("block_hex.toml"), "-o", folder + "/out", "--set", "output=[]", "--set",
       "load=[{region='z+',force=[0,0,-1e6],path=[{time=0,factor=0},{time=0.1,factor=0},"
       "{time=0.101,factor=1}]}]"},
      folder);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("in the frame after 0.1 s: "), std::string::npos) << run.err;
  const nlohmann::json summary = read_summary(folder + "/out");
  EXPECT_EQ(summary["finished"], false);
  EXPECT_EQ(summary["frames"], 3);
  EXPECT_NE(run.err.find(summary["trouble"]), std::string::npos) << summary["trouble"];
  EXPECT_GT(summary["least_det_F"]["value"], 0.9);  // of the frames that went well
}

}  // namespace
}  // namespace trocar
