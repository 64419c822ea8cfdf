// The pages of docs/ that say what the program reads and writes are those of this program.
#include <gtest/gtest.h>

#include <set>

#include "mesh_fixtures.h"
#include "mesh_write.h"
#include "program.h"

namespace trocar {
namespace {

std::string page(const std::string& name) {
  return read_text(std::string(TROCAR_SOURCE_DIR) + "/docs/" + name);
}

TEST(Docs, pages_of_the_program_are_what_it_prints) {
  const std::string folder = test_folder("docs");
  EXPECT_EQ(run_trocar({"help", "scene", "--markdown"}, folder).out, page("scene.md"));
  EXPECT_EQ(run_trocar({"help", "tissues", "--markdown"}, folder).out, page("tissues.md"));
}

TEST(Docs, the_scene_of_the_readme_runs_and_cuts) {
  const std::string folder = test_folder("readme"), begin = "```toml\n";
  const std::string readme = read_text(std::string(TROCAR_SOURCE_DIR) + "/README.md");
  const std::size_t at = readme.find(begin) + begin.size();
  std::ofstream(folder + "/s.toml") << readme.substr(at, readme.find("```", at) - at);
  const Finished run =
      run_trocar({"run", folder + "/s.toml", "-q", "-o", folder, "--set", "output=[]", "--set",
                  "time.duration=4", "--set", "tissue.mesh='" + config("meshes/liver.msh") + "'"},
                 folder);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  ASSERT_EQ(summary["events"].size(), 1U);  // the run ends before the cut
  EXPECT_NE(summary["events"][0].get<std::string>().find("scalpel is still in the tissue"),
            std::string::npos);
  ASSERT_EQ(summary["cuts"].size(), 1U);
  EXPECT_GT(summary["cuts"][0]["facets_opened"], 4);
}

// Names of phases and of what the scene names are not words of the page.
void collect_keys(const nlohmann::json& value, std::set<std::string>& keys) {
  if (!value.is_structured()) return;
  for (const auto& entry : value.items()) {
    if (value.is_object()) keys.insert(entry.key());
    if (entry.key() == "elements" || entry.key() == "by_phase") continue;
    const bool has_names = entry.key() == "instruments" || entry.key() == "supports";
    if (!has_names) collect_keys(entry.value(), keys);
    for (const auto& named : entry.value())
      if (has_names) collect_keys(named, keys);
  }
}

// Two that have every part: a cut body with all that is optional, and one of local steps.
const char* const scenes[] = {R"(
[time]
duration = 0.5
[start]
state = "equilibrium"
[tissue.shape]
kind = "box"
high = [0.03, 0.03, 0.03]
cells = [4, 4, 4]
elements = "tet4-kuhn"
[solver]
gravity = [0, 0, -9.81]
mass_scaling_step = "0.9 ms"
sleep = "0.1 mm"
[[support]]
region = "z-"
[[instrument]]
kind = "scalpel"
blade_length = "50 mm"
path = [{ time = 0.0, position = [-0.01, 0.015, 0.02] }, { time = 0.4, position = [0.04, 0.015, 0.02] }]
[[output]]
kind = "metrics"
file = "m.csv"
)",
                              R"(
[time]
duration = 0.1
[tissue]
mesh = "thin_layer.msh"
[solver]
multirate = true
)"};

TEST(Docs, every_key_of_a_summary_and_every_column_of_metrics_is_explained) {
  std::set<std::string> keys;
  for (const char* const scene : scenes) {
    const std::string folder = test_folder("docs-keys");
    std::ofstream(folder + "/s.toml") << scene;
    write_mesh(with_thin_layer(BoxElements::hex8, 2), folder + "/thin_layer.msh");
    const Finished run = run_trocar({"run", folder + "/s.toml", "-q", "-o", folder}, folder);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json summary = read_summary(folder);
    collect_keys(summary, keys);
    std::istringstream columns(read_text(folder + "/m.csv").substr(0, 2000));
    std::string line, column;
    std::getline(columns, line);
    for (std::istringstream names(line); std::getline(names, column, ',');)
      if (!column.starts_with("scalpel_") && !column.starts_with("support_")) keys.insert(column);
  }
  for (const char* const optional :
       {"added_mass", "equilibrium", "multirate", "share_asleep_mean", "energies_J", "supports",
        "refusals", "viscous_work_J", "largest_force_N"})
    EXPECT_TRUE(keys.contains(optional)) << optional;
  const std::string outputs = page("outputs.md");
  for (const std::string& key : keys)
    EXPECT_NE(outputs.find("`" + key + "`"), std::string::npos) << key;
}

}  // namespace
}  // namespace trocar
