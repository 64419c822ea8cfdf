// The same bits for any number of ranks and threads.
#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <map>
#include <set>

#include "engine_resume.h"
#include "mesh_fixtures.h"
#include "mesh_write.h"
#include "program.h"
#include "small_scenes.h"

namespace trocar {
namespace {

struct Case {
  SmallScene scene;
  std::string precision;
  std::string name() const { return scene.name + ", " + precision; }
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const SmallScene& scene : small_scenes())
    for (const char* const precision : {"double", "single"}) cases.push_back({scene, precision});
  return cases;
}

// What scene_digests reads.
void write_cases(const std::vector<Case>& cases, const std::string& folder) {
  write_mesh(mixed_mesh(2), folder + "/" + mixed_file);
  write_mesh(with_thin_layer(BoxElements::hex8, 2), folder + "/" + layer_files[0]);
  write_mesh(with_thin_layer(BoxElements::tet4_kuhn, 2), folder + "/" + layer_files[1]);
  std::ofstream list(folder + "/list");
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const SmallScene& scene = cases[k].scene;
    const std::string file = folder + "/" + std::to_string(k);
    std::ofstream(file + ".toml") << scene.text;
    list << file << ".toml\t" << file << "\t" << scene.first_half << "\tsolver.precision='"
         << cases[k].precision << "'"
         << (scene.first_half.empty() ? "\tcheckpoint.every=0\n" : "\n");
  }
}

// Of each case on one thread, on two, and so on.
std::vector<nlohmann::json> summaries_on(int ranks, const std::vector<Case>& cases) {
  const std::string folder = test_folder("digests");
  write_cases(cases, folder);
  const Finished run = run_words(mpirun_words(ranks, TROCAR_SCENE_DIGESTS, {folder}), folder, 560);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::vector<nlohmann::json> summaries;
  for (std::size_t k = 0; k < cases.size(); ++k)
    for (const int threads : {1, 2}) {
      const std::string name = std::to_string(k) + "-" + std::to_string(threads);
      nlohmann::json summary = read_summary(folder + "/" + name);
      if (!summary.is_object()) summary = nlohmann::json::object();
      if (cases[k].scene.text.find("m.csv") != std::string::npos)
        summary["metrics"] = metrics_without_times(folder + "/" + name + "/m.csv");
      EXPECT_EQ(summary.value("ranks", 0), ranks) << cases[k].name();
      EXPECT_EQ(summary.value("threads", 0), threads) << cases[k].name();
      summaries.push_back(summary);
    }
  std::filesystem::remove_all(folder);
  return summaries;
}

// What a scene has instruments and options for took place in it.
void expect_not_idle(const SmallScene& scene, const nlohmann::json& summary) {
  bool has_blade = false;
  double n_duplicated = 0;
  for (const auto& [name, tool] : summary["instruments"].items())
    if (name.find("scalpel") != name.npos || name.find("scissors") != name.npos)
      has_blade = true;
    else
      EXPECT_GT(tool["largest_force_N"], 1e-3) << name;
  for (const auto& cut : summary["cuts"]) n_duplicated += cut["nodes_duplicated"].get<double>();
  EXPECT_EQ(n_duplicated > 5, has_blade) << n_duplicated << " nodes were duplicated";
  EXPECT_GT(summary.value("share_asleep_mean", 1.), 0.05);
  EXPECT_EQ(summary.contains("multirate"), scene.name.find("local steps") != std::string::npos);
  if (scene.name.find("small cells") != std::string::npos) {
    EXPECT_GT(summary["searches"]["parts"], 0) << summary["searches"];
  }
  if (summary.contains("added_mass")) {
    EXPECT_GT(summary["added_mass"]["nodes"], 0);
  }
  if (scene.name.find("rolled back") != std::string::npos) {
    EXPECT_GT(summary["roll_backs"], 0);
    EXPECT_NE(summary["events"].dump().find("is inverted (det F = "), std::string::npos)
        << summary["events"];
  }
}

TEST(StateDigest, of_small_scenes_of_every_kind_is_the_same_on_any_ranks_and_threads) {
  const std::vector<Case> cases = all_cases();
  EXPECT_GE(cases.size(), 70u);
  std::set<std::string> seen;
  std::vector<nlohmann::json> first;
  for (int ranks = 1; ranks <= 4; ++ranks) {
    const std::vector<nlohmann::json> summaries = summaries_on(ranks, cases);
    if (ranks == 1) first = summaries;
    for (std::size_t k = 0; k < summaries.size(); ++k) {
      SCOPED_TRACE(cases[k / 2].name() + " on " + std::to_string(ranks) + " ranks, " +
                   std::to_string(k % 2 + 1) + " threads");
      const nlohmann::json& found = summaries[k];
      const nlohmann::json same = result_in(found), expected = result_in(first[k - k % 2]);
      EXPECT_EQ(same.size(), expected.size());
      for (const auto& [key, value] : expected.items())
        EXPECT_EQ(same.value(key, nlohmann::json()), value) << key;
      EXPECT_EQ(found.value("metrics", ""), first[k - k % 2].value("metrics", ""));
      if (ranks > 1 || k % 2 == 1) continue;
      expect_not_idle(cases[k / 2].scene, found);
      EXPECT_TRUE(seen.insert(found.value("state_digest", "")).second) << "as in another scene";
    }
  }
}

// A coarse block, of which a cut converts a good part on the side of few ranks.
TEST(StateDigest, is_the_same_where_a_cut_makes_ranks_choose_their_parts_anew) {
  const std::string folder = test_folder("rebalanced");
  SmallBlock coarse = hexahedra();
  coarse.cells = "[8, 6, 4]";
  std::ofstream(folder + "/scene.toml") << block(coarse) + curved_cut;
  std::set<std::string> digests;
  for (const int ranks : {1, 4}) {
    const Finished run = run_trocar_on(
        ranks, {"run", folder + "/scene.toml", "-o", folder, "--threads", "1"}, folder);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const bool is_told = (run.out + run.err).find("parts are chosen anew") != std::string::npos;
    EXPECT_EQ(is_told, ranks > 1);
    digests.insert(read_summary(folder).value("state_digest", "no digest"));
  }
  EXPECT_EQ(digests.size(), 1u);
}

// Two pictures, all frames recorded; pressed, grasped and cut.
const std::string watched = resume_block_text + metrics_table + R"([[camera]]
eye = [0, "-150 mm", "90 mm"]
target = [0, 0, "15 mm"]
[[output]]
kind = "recording"
file = "r.trocar"
[[output]]
kind = "frames"
file = "png"
size = [64, 48]
every = "0.3 s"
)";

TEST(StateDigest, and_all_that_is_recorded_and_drawn_are_the_same_on_any_ranks_and_threads) {
  const std::string folder = test_folder("watched");
  std::ofstream(folder + "/scene.toml") << watched;
  std::map<std::string, std::string> expected;
  for (const auto& [ranks, threads] : {std::pair{1, 1}, {2, 1}, {3, 2}}) {
    const std::string out = folder + "/" + std::to_string(ranks) + "/";
    const Finished run = run_trocar_on(ranks,
                                       {"run", folder + "/scene.toml", "-q", "-o", out, "--threads",
                                        std::to_string(threads), "--set", "time.duration='0.6 s'"},
                                       folder);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::map<std::string, std::string> found = {{"m.csv", metrics_without_times(out + "m.csv")}};
    for (const char* const file : {"r.trocar", "png/000009.png", "png/000018.png"})
      found[file] = read_text(out + file);
    if (ranks == 1) expected = found;
    for (const auto& [file, content] : found) {
      EXPECT_FALSE(content.empty()) << file;
      EXPECT_TRUE(content == expected[file])
          << file << " on " << ranks << " ranks x " << threads << " threads";
    }
  }
  EXPECT_NE(read_summary(folder + "/1")["cuts"][0]["nodes_duplicated"], 0);
}

std::string digest_of(const std::string& scene, std::vector<std::string> settings, int ranks,
                      int threads) {
  const std::string folder = test_folder("invariance");
  std::vector<std::string> arguments = {"run",       config(scene),          "-o", folder, "-q",
                                        "--threads", std::to_string(threads)};
  settings.push_back("output=[]");  // pictures don't touch the state
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  const Finished run = run_trocar_on(ranks, arguments, folder);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return read_summary(folder).value("state_digest", "no digest");
}

// Steps a second of the same frames are doubled: messages follow, what all ranks say together does
// not. The start and the end need some messages of their own.
TEST(Traffic, collectives_go_by_frames_and_messages_by_steps) {
  nlohmann::json traffic[2], steps[2];
  for (const int k : {0, 1}) {
    const std::string folder = test_folder("traffic");
    const Finished run =
        run_trocar_on(2,
                      {"run", config("block_hex.toml"), "-o", folder, "-q", "--threads", "1",
                       "--set", "output=[]", "--set", "instrument=[]", "--set",
                       "time.duration='0.2 s'", "--set", "solver.stable_step='element-bound'",
                       "--set", k == 0 ? "solver.step_factor=0.8" : "solver.step_factor=0.4"},
                      folder);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    traffic[k] = read_summary(folder)["traffic_of_rank_0"];
    steps[k] = read_summary(folder)["steps"];
  }
  const auto n = [](const nlohmann::json& value) { return value.get<std::int64_t>(); };
  EXPECT_GT(n(steps[1]), n(steps[0]) * 3 / 2);
  EXPECT_EQ(traffic[1]["collectives"], traffic[0]["collectives"]);
  EXPECT_EQ(n(traffic[1]["messages"]) - n(traffic[0]["messages"]), n(steps[1]) - n(steps[0]));
}

TEST(StateDigest, changes_when_one_bit_of_the_input_changes) {
  // Each node's mass follows from it; one bit of Young's modulus rounds to the same two moduli.
  const double next = std::nextafter(1060., 2000.);
  std::ostringstream key;
  key << std::setprecision(17) << "tissue.material.density=" << next;
  const std::vector<std::string> settings = {"time.duration='0.2 s'"};
  const std::string digest = digest_of("block_hex.toml", settings, 1, 1);
  EXPECT_EQ(digest_of("block_hex.toml", {settings[0], "tissue.material.density=1060"}, 1, 1),
            digest);
  EXPECT_NE(digest_of("block_hex.toml", {settings[0], key.str()}, 1, 1), digest);
}

TEST(StateDigest, is_the_same_in_two_runs) {
  const std::vector<std::string> short_run = {"time.duration='1.2 s'"};
  EXPECT_EQ(digest_of("plane_cut.toml", short_run, 1, 2),
            digest_of("plane_cut.toml", short_run, 1, 2));
}

}  // namespace
}  // namespace trocar
