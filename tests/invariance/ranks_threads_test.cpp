// The same bits for any number of ranks and threads.
#include <gtest/gtest.h>

#include "program.h"

namespace trocar {
namespace {

std::string digest_of(const std::string& scene, const std::vector<std::string>& settings, int ranks,
                      int threads) {
  const std::string folder = test_folder("invariance");
  std::vector<std::string> arguments = {"run",       config(scene),          "-o", folder, "-q",
                                        "--threads", std::to_string(threads)};
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  const Finished run = run_trocar_on(ranks, arguments, folder);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json summary = read_summary(folder);
  if (summary.is_discarded()) return "no summary";
  EXPECT_EQ(summary["ranks"], ranks);
  EXPECT_EQ(summary["threads"], threads);
  std::string digest = summary["state_digest"];
  for (const auto& cut : summary["cuts"]) digest += " cut " + cut["nodes_duplicated"].dump();
  if (summary.contains("share_asleep_mean")) {
    EXPECT_GT(summary["share_asleep_mean"], 0.05);
    digest += " asleep " + summary["share_asleep_mean"].dump();
  }
  if (summary.contains("multirate")) digest += " multirate " + summary["multirate"].dump();
  return digest;
}

// All combinations of {1, 2, 3, 4} ranks and {1, 2} threads. No pictures: they don't touch the
// state.
std::string expect_one_digest(const std::string& scene, std::vector<std::string> settings) {
  settings.push_back("output=[]");
  const std::string first = digest_of(scene, settings, 1, 1);
  for (int ranks = 1; ranks <= 4; ++ranks)
    for (int threads = 1; threads <= 2; ++threads)
      if (ranks * threads > 1) {
        EXPECT_EQ(digest_of(scene, settings, ranks, threads), first)
            << scene << " on " << ranks << " x " << threads;
      }
  return first;
}

TEST(StateDigest, of_the_liver_is_the_same_on_any_ranks_and_threads_while_it_is_cut) {
  expect_one_digest("liver_incision.toml", {"time.duration='3.6 s'"});
}

TEST(StateDigest, of_the_hexahedral_block_is_the_same_on_any_ranks_and_threads) {
  expect_one_digest("block_hex.toml", {"time.duration='1.7 s'"});
}

TEST(StateDigest, of_the_hexahedral_block_is_the_same_on_any_ranks_and_threads_while_it_is_cut) {
  expect_one_digest("block_hex_cut.toml", {"time.duration='0.8 s'"});
}

TEST(StateDigest, of_a_duct_is_the_same_on_any_ranks_and_threads_while_scissors_cut_it) {
  expect_one_digest("duct_scissors.toml",
                    {"tissue.shape.cells=[4,4,20]", "time.duration='0.85 s'"});
}

TEST(StateDigest, of_the_plane_cut_is_the_same_on_any_ranks_and_threads) {
  expect_one_digest("plane_cut.toml", {});
}

const std::vector<std::string> short_start = {"time.duration='0.1 s'", "start.state='equilibrium'"};

std::vector<std::string> with_short_start(std::vector<std::string> settings) {
  settings.insert(settings.end(), short_start.begin(), short_start.end());
  return settings;
}

TEST(StateDigest, of_a_start_in_equilibrium_is_the_same_on_any_ranks_and_threads) {
  const std::string coarse = "tissue.shape.cells=[6,6,6]";
  expect_one_digest(
      "block_hex.toml",
      with_short_start({coarse, "tissue.material.prony=[{share=0.4, time='0.1 s'}]"}));
  expect_one_digest("block_hex.toml", with_short_start({coarse, "tissue.shape.elements='tet4-five'",
                                                        "solver.tetrahedron='nodal-pressure'"}));
  expect_one_digest("plane_cut.toml", with_short_start({"solver.gravity=[0, -2, 0]"}));
}

TEST(StateDigest, with_scaled_masses_is_the_same_on_any_ranks_and_threads_while_it_is_cut) {
  expect_one_digest("plane_cut.toml", {"time.duration='2 s'", "solver.mass_scaling_step='0.5 ms'"});
}

// At rest at first, then pressed and pulled.
TEST(StateDigest, with_sleep_is_the_same_on_any_ranks_and_threads) {
  for (const std::string precision : {"double", "single"})
    expect_one_digest("block_hex.toml",
                      {"tissue.shape.cells=[8,8,8]", "start.state='equilibrium'",
                       "solver.sleep='0.2 mm'", "solver.precision='" + precision + "'"});
}

// Asleep until the blade comes; hexahedra become tetrahedra.
TEST(StateDigest, with_sleep_is_the_same_on_any_ranks_and_threads_while_hexahedra_are_cut) {
  expect_one_digest("block_hex_cut.toml",
                    {"time.duration='1.3 s'", "start.state='equilibrium'", "solver.sleep='0.2 mm'",
                     "instrument=[{kind='scalpel', blade_length='30 mm', path=["
                     "{time='0.7 s', position=['-35 mm','-9 mm','60 mm'], direction=[0,0.2,-1], "
                     "forward=[0.94,0.34,0]},"
                     "{time='0.9 s', position=['-24 mm','-5 mm','22 mm'], direction=[0,0.2,-1], "
                     "forward=[0.94,0.34,0]},"
                     "{time='1.3 s', position=['8 mm','6.6 mm','22 mm'], direction=[0,0.2,-1], "
                     "forward=[0.94,0.34,0]}]}]"});
}

// Asleep before and after the cut, which leaves elements whose masses are scaled.
TEST(StateDigest, with_sleep_and_scaled_masses_is_the_same_on_any_ranks_and_threads) {
  expect_one_digest("plane_cut.toml",
                    {"time.duration='3.6 s'", "support=[{region='x-'},{region='x+'}]",
                     "solver.mass_scaling_step='0.5 ms'", "solver.sleep='0.5 mm'"});
}

// The cut leaves small elements.
TEST(StateDigest, with_local_steps_is_the_same_on_any_ranks_and_threads_while_it_is_cut) {
  const std::string digest = expect_one_digest("plane_cut.toml", {"solver.multirate=true"});
  EXPECT_NE(digest.find("multirate"), std::string::npos) << "nothing was small";
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

TEST(StateDigest, changes_when_an_input_changes_in_its_sixteenth_digit) {
  const std::vector<std::string> short_run = {"output=[]", "time.duration='0.2 s'"};
  std::vector<std::string> other = short_run;
  other.push_back("tissue.material.young_modulus=6000.000000000004");
  EXPECT_NE(digest_of("block_hex.toml", short_run, 1, 1), digest_of("block_hex.toml", other, 1, 1));
}

TEST(StateDigest, is_the_same_in_two_runs) {
  const std::vector<std::string> short_run = {"output=[]", "time.duration='1.2 s'"};
  EXPECT_EQ(digest_of("plane_cut.toml", short_run, 1, 2),
            digest_of("plane_cut.toml", short_run, 1, 2));
}

}  // namespace
}  // namespace trocar
