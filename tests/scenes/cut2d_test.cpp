// `trocar cut2d` through the front door.
#include <gtest/gtest.h>

#include "mesh/generate.h"
#include "mesh_write.h"
#include "program.h"

namespace trocar {
namespace {

nlohmann::json cut_json(std::vector<std::string> words, const std::string& folder) {
  words.insert(words.begin(), "cut2d");
  words.push_back("--json");
  const Finished cut = run_trocar(words, folder);
  EXPECT_EQ(cut.exit_code, 0) << cut.err;
  return nlohmann::json::parse(cut.out, nullptr, false);
}

TEST(Cut2d, configuration_in_each_mode_has_the_papers_counts) {
  const std::string folder = test_folder("cut2d");
  for (const char* mode : {"robust", "paper"}) {
    const auto json = cut_json({"--config", "2", "--mode", mode}, folder);
    EXPECT_EQ(json["after"]["n_nodes"], 326) << mode;
    EXPECT_EQ(json["after"]["n_elements"], 570) << mode;
  }
  const auto divided = cut_json({"--config", "2", "--mode", "or"}, folder);
  EXPECT_EQ(divided["after"]["n_nodes"], 376);
  EXPECT_EQ(divided["after"]["n_elements"], 626);
}

// A mesh file in mm must be cut like the same mesh in metres.
TEST(Cut2d, mesh_file_is_cut_like_the_configuration_it_holds) {
  const std::string folder = test_folder("cut2d-file");
  write_mesh(make_rectangle(70, 40, 20, 16), folder + "/plate.msh");
  const std::string path = "17.8,35.2 41.6,18";
  const auto own = cut_json({"--mesh", folder + "/plate.msh", "--path", path}, folder);
  const auto paper = cut_json({"--config", "2", "--path", path}, folder);
  EXPECT_EQ(own["n_new_nodes"], paper["n_new_nodes"]);
  EXPECT_EQ(own["n_opened_edges"], paper["n_opened_edges"]);
  EXPECT_NEAR(own["after"]["area_mm2"]["min"].get<double>(),
              paper["after"]["area_mm2"]["min"].get<double>(), 1e-9);
}

// A through-cut of n edges adds n + 1 nodes; an arc from side to side is one.
TEST(Cut2d, curved_cut_from_side_to_side_opens_all_its_edges) {
  const std::string folder = test_folder("cut2d-arc");
  const auto json = cut_json({"--config", "2", "--arc", "-1,12 35,28 71,12"}, folder);
  EXPECT_EQ(json["n_refused"], 0);
  EXPECT_EQ(json["n_new_nodes"], json["n_opened_edges"].get<int>() + 1);
  EXPECT_EQ(json["n_new_elements"], 0);
}

TEST(Cut2d, table_and_pictures_are_written) {
  const std::string folder = test_folder("cut2d-table");
  const Finished table = run_trocar({"cut2d", "--table1", "--repeat", "2", "--markdown",
                                     folder + "/table1.md", "--svg", folder + "/svg"},
                                    folder);
  ASSERT_EQ(table.exit_code, 0) << table.err;
  EXPECT_NE(table.out.find("robust mode"), std::string::npos);
  EXPECT_NE(read_text(folder + "/table1.md").find("| robust mode |"), std::string::npos);
  for (const char* name : {"before", "after_or", "after_paper", "after_robust"})
    EXPECT_NE(read_text(folder + "/svg/configuration_4_" + name + ".svg").find("</svg>"),
              std::string::npos)
        << name;
}

TEST(Cut2d, wrong_command_lines_are_explained_in_one_sentence) {
  const std::string folder = test_folder("cut2d-wrong");
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"--config", "7"},
      {"--config", "1", "--mesh", "x.msh"},
      {"--config", "1", "--path", "1,2"},
      {"--config", "1", "--path", "1;2 3;4"},
      {"--config", "1", "--mode", "best"},
      {"--config", "1", "--mode", "or", "--path", "1,2 3,4 5,4"},
      {"--mesh", folder + "/missing.msh", "--path", "1,2 3,4"},
      {"--mesh", config("meshes/liver.msh"), "--scale", "0", "--path", "1,2 3,4"},
      {"--table1", "--config", "1"},
      {"--table1", "--mesh", config("meshes/liver.msh")},
      {"--table1", "--path", "1,2 3,4"},
      {"--table1", "--sweep"},
      {"--sweep", "--arc", "1,2 3,4 5,4"},
      {"--sweep", "--config", "1"},
      {"--config", "1", "--markdown", folder + "/table1.md"},
      {"--table1", "--mode", "or"},
      {"--config", "1", "--mode", "paper", "--least-step-ratio", "0.9"},
      {"--config", "1", "--cuts", "5"},
      {"--sweep", "--json"},
      {"--config", "1", "--docs", folder}};
  for (std::vector<std::string> words : wrong) {
    words.insert(words.begin(), "cut2d");
    const Finished cut = run_trocar(words, folder);
    EXPECT_EQ(cut.exit_code, 2) << cut.err;
    EXPECT_FALSE(cut.err.empty());
  }
}

TEST(Cut2d, a_scale_without_a_mesh_and_a_point_without_end_are_refused) {
  const std::string folder = test_folder("cut2d-scale");
  const Finished scaled = run_trocar({"cut2d", "--config", "2", "--scale", "3 mm"}, folder);
  EXPECT_EQ(scaled.exit_code, 2);
  EXPECT_NE(scaled.err.find("--scale belongs to --mesh"), std::string::npos) << scaled.err;
  const Finished far = run_trocar({"cut2d", "--config", "2", "--path", "1e300,1 3,4"}, folder);
  EXPECT_EQ(far.exit_code, 2);
  EXPECT_NE(far.err.find("within 1e9 mm of the axes, \"1e300,1\" does not"), std::string::npos)
      << far.err;
}

TEST(Cut2d, a_path_beside_the_mesh_is_told_where_the_mesh_lies) {
  const std::string folder = test_folder("cut2d-beside");
  const Finished cut = run_trocar({"cut2d", "--config", "2", "--path", "500,500 600,600"}, folder);
  EXPECT_EQ(cut.exit_code, 0);
  EXPECT_NE(cut.err.find("lies from 0,0 to 70,40 mm"), std::string::npos) << cut.err;
}

TEST(Cut2d, names_the_files_that_it_writes_unless_it_is_to_be_quiet) {
  const std::string folder = test_folder("cut2d-quiet");
  std::vector<std::string> words = {"cut2d", "--config", "2", "--svg", folder};
  EXPECT_NE(run_trocar(words, folder).err.find("before.svg"), std::string::npos);
  words.emplace_back("-q");
  const Finished quiet = run_trocar(words, folder);
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.err, "");
}

TEST(Cut2d, help_has_examples) {
  const Finished help = run_trocar({"cut2d", "--help"}, test_folder("cut2d-help"));
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("trocar cut2d --table1"), std::string::npos);
}

}  // namespace
}  // namespace trocar
