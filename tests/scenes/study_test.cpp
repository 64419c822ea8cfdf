// `trocar study` through the front door.
#include <gtest/gtest.h>

#include "program.h"

namespace trocar {
namespace {

TEST(Study, a_sweep_within_a_budget_writes_table_plot_and_advice) {
  const std::string folder = test_folder("study");
  const Finished study = run_trocar(
      {"study", "indentation", "--sizes", "2,4,64", "--budget", "5", "-o", folder, "-q"}, folder);
  ASSERT_EQ(study.exit_code, 0) << study.err;
  EXPECT_NE(study.out.find("error at least cost use"), std::string::npos) << study.out;
  const auto table = nlohmann::json::parse(read_text(folder + "/indentation.json"), nullptr, false);
  ASSERT_TRUE(table.is_object());
  EXPECT_GE(table["runs"].size(), 4u);
  EXPECT_GE(table["notes"].size(), 1u);  // n = 64 takes minutes
  EXPECT_EQ(read_text(folder + "/indentation.csv").rfind("elements,", 0), 0u);
  EXPECT_NE(read_text(folder + "/indentation.svg").find("</svg>"), std::string::npos);
}

TEST(Study, the_list_names_all_problems) {
  const std::string folder = test_folder("study-list");
  const Finished list = run_trocar({"study", "--list"}, folder);
  EXPECT_EQ(list.exit_code, 0);
  for (const char* name : {"indentation", "bonded-cube", "lame-mode", "bending-column"})
    EXPECT_NE(list.out.find(name), std::string::npos) << name;
}

TEST(Study, of_a_scene_takes_a_length_as_its_target) {
  const std::string folder = test_folder("study-scene");
  const Finished study =
      run_trocar({"study", config("plane_cut.toml"), "--sizes", "4,6", "--precision", "double",
                  "--target", "1 mm", "-o", folder, "--set", "time.duration='0.5 s'", "--set",
                  "instrument=[]", "--set", "solver.gravity=[0, -9.81, 0]"},
                 folder);
  EXPECT_EQ(study.exit_code, 0) << study.err;
  EXPECT_NE(study.out.find("For 1 mm error at least cost"), std::string::npos) << study.out;
}

TEST(Study, what_does_not_exist_is_named_with_the_nearest_that_does) {
  const std::string folder = test_folder("study-wrong");
  const Finished wrong = run_trocar({"study", "indentatoin"}, folder);
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("the nearest is \"indentation\""), std::string::npos) << wrong.err;
  EXPECT_EQ(run_trocar({"study"}, folder).exit_code, 2);
  const Finished absent = run_trocar({"study", "absent.toml"}, folder);
  EXPECT_EQ(absent.exit_code, 2);
  EXPECT_NE(absent.err.find("absent.toml: there is no file"), std::string::npos) << absent.err;
  EXPECT_EQ(run_trocar({"study", "lame-mode", "--elements", "hex9"}, folder).exit_code, 2);
  EXPECT_EQ(run_trocar({"study", "lame-mode", "--target", "soon"}, folder).exit_code, 2);
  EXPECT_EQ(run_trocar({"study", "bending-column", "--sizes", "3"}, folder).exit_code, 2);
}

}  // namespace
}  // namespace trocar
