// Whole scenes through the front door: what a user is promised of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "program.h"

namespace trocar {
namespace {

using Column = std::vector<double>;

// metrics.csv by column name.
std::map<std::string, Column> read_metrics(const std::string& file) {
  std::stringstream text(read_text(file));
  std::string line, cell;
  std::getline(text, line);
  std::vector<std::string> names;
  for (std::stringstream head(line); std::getline(head, cell, ',');) names.push_back(cell);
  std::map<std::string, Column> columns;
  while (std::getline(text, line)) {
    std::stringstream row(line);
    for (std::size_t k = 0; std::getline(row, cell, ','); ++k)
      columns[names[k]].push_back(std::stod(cell));
  }
  return columns;
}

Column force_size(const std::map<std::string, Column>& metrics, const std::string& tool) {
  Column size(metrics.at("time_s").size());
  for (std::size_t k = 0; k < size.size(); ++k)
    for (const char* axis : {"_force_x_N", "_force_y_N", "_force_z_N"})
      size[k] += std::pow(metrics.at(tool + axis)[k], 2);
  for (double& value : size) value = std::sqrt(value);
  return size;
}

double at_time(const std::map<std::string, Column>& metrics, const Column& values, double time) {
  const Column& t = metrics.at("time_s");
  const auto k = std::lower_bound(t.begin(), t.end(), time - 1e-9) - t.begin();
  return values.at(static_cast<std::size_t>(k));
}

struct Ran {
  std::string folder;
  Finished program;
  nlohmann::json summary;
  std::map<std::string, Column> metrics;
};

double peak_memory_of_block(int cells, const std::string& precision) {
  const std::string folder = test_folder("memory"), n = std::to_string(cells);
  const Finished program =
      run_trocar({"run", config("block_hex.toml"), "-q", "-o", folder, "--set", "output=[]",
                  "--set", "instrument=[]", "--set", "time.duration=0.1 s", "--set",
                  "solver.precision='" + precision + "'", "--set",
                  "tissue.shape.cells=[" + n + "," + n + "," + n + "]"},
                 folder);
  EXPECT_EQ(program.exit_code, 0) << program.err;
  return read_summary(folder)["peak_memory_bytes"];
}

Ran run_scene_file(const std::string& name, const std::string& outputs) {
  Ran ran{.folder = test_folder("scene-" + name)};
  ran.program = run_trocar_on(
      2,
      {"run", config(name), "-q", "--threads", "1", "-o", ran.folder, "--set", "output=" + outputs},
      ran.folder, 500);
  EXPECT_EQ(ran.program.exit_code, 0);
  EXPECT_EQ(ran.program.err, "");
  ran.summary = read_summary(ran.folder);
  // Of instruments that do nothing.
  EXPECT_EQ(ran.summary["events"].dump().find(" nothing"), std::string::npos);
  if (!ran.summary.is_discarded()) ran.metrics = read_metrics(ran.folder + "/metrics.csv");
  return ran;
}

void expect_sound_cuts(const nlohmann::json& summary) {
  EXPECT_FALSE(summary["cuts"].empty());
  for (const auto& cut : summary["cuts"]) {
    EXPECT_GT(cut["nodes_duplicated"], 0);
    EXPECT_EQ(cut["elements_added"], 0);
    EXPECT_LE(cut["mass_change"], 1e-12);
    EXPECT_LE(cut["momentum_change"], 1e-12);
    EXPECT_LT(cut["deviation_max_m"], cut["edge_mean_m"]);
  }
}

// What the body holds is what was done to it; the scheme's error is of second order in the step.
void expect_closed_energy_balance(const nlohmann::json& summary, double most) {
  const auto& energies = summary["energies_J"];
  EXPECT_GT(std::abs(energies["hold_work"].get<double>()), 1e-4);
  EXPECT_LT(energies["largest_balance_error_share"], most);
}

// On two ranks; all tests of the liver look at one run, for which they run in one process.
const Ran& liver_run() {
  static const Ran ran = run_scene_file(
      "liver_incision.toml",
      "[{kind='metrics', file='metrics.csv'}, {kind='recording', file='liver.trocar'}]");
  return ran;
}

// Bytes of a hexahedron more: mesh, surface, a search and a frame's beginning included.
TEST(Memory, of_the_whole_program_is_half_a_kilobyte_a_hexahedron_in_single_precision) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer has memory of its own";
#endif
  for (const auto& [precision, most] : {std::pair("single", 480.0), std::pair("double", 680.0)}) {
    const double small = peak_memory_of_block(30, precision),
                 large = peak_memory_of_block(50, precision);
    const double bytes = (large - small) / (50 * 50 * 50 - 30 * 30 * 30);
    EXPECT_LT(bytes, most) << precision;
    EXPECT_GT(bytes, 200) << precision;
  }
}

TEST(LiverIncision, is_pressed_grasped_cut_and_opened) {
  const Ran& ran = liver_run();
  ASSERT_FALSE(ran.summary.is_discarded());
  EXPECT_EQ(ran.summary["finished"], true);
  EXPECT_GE(ran.summary["mesh"]["elements"]["tet4"], 20000);
  EXPECT_EQ(ran.summary["mesh"]["pieces"], 1);
  EXPECT_GT(ran.summary["least_det_F"]["value"], 0.0);  // nothing was inverted at any frame
  expect_sound_cuts(ran.summary);
  expect_closed_energy_balance(ran.summary, 3e-5);
  EXPECT_GT(ran.summary["energies_J"]["blade_work"], 1e-4);
  // While the probe presses; less than its largest force over its way of 10 mm. It gets it back.
  const double pressing = at_time(ran.metrics, ran.metrics.at("contact_work_J"), 1.1);
  EXPECT_GT(pressing, 1e-3);
  EXPECT_LT(pressing, 6e-3);
  EXPECT_LT(ran.metrics.at("contact_work_J").back(), 0.1 * pressing);

  const Column probe = force_size(ran.metrics, "probe");
  EXPECT_EQ(at_time(ran.metrics, probe, 0.4), 0.0);
  EXPECT_GT(at_time(ran.metrics, probe, 1.1), 0.5);
  EXPECT_EQ(at_time(ran.metrics, probe, 2.0), 0.0);
  const Column& wound = ran.metrics.at("wound_width_m");
  EXPECT_EQ(at_time(ran.metrics, wound, 3.0), 0.0);
  const double before_pull = at_time(ran.metrics, wound, 4.9), after_pull = wound.back();
  EXPECT_GT(after_pull, before_pull + 2e-3);  // the grasper pulls the wound open
}

// Until the blade is in it.
TEST(LiverIncision, has_the_same_bits_on_three_ranks_with_two_threads_each_while_it_is_cut) {
  const std::string folder = test_folder("liver-on-three");
  const Finished run =
      run_trocar_on(3,
                    {"run", config("liver_incision.toml"), "-q", "--threads", "2", "-o", folder,
                     "--set", "output=[]", "--set", "time.duration='3.6 s'"},
                    folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string digest = read_summary(folder)["state_digest"];
  const Finished list =
      run_trocar({"replay", liver_run().folder + "/liver.trocar", "--list"}, folder);
  ASSERT_EQ(list.exit_code, 0) << list.err;
  EXPECT_NE(list.out.find("3.6000 s  " + digest), std::string::npos) << digest;
}

TEST(BlockHex, is_pressed_and_comes_back) {
  const Ran ran = run_scene_file("block_hex.toml", "[{kind='metrics', file='metrics.csv'}]");
  ASSERT_FALSE(ran.summary.is_discarded());
  EXPECT_EQ(ran.summary["mesh"]["elements"]["hex8"], 8000);
  EXPECT_GT(ran.summary["least_det_F"]["value"], 0.0);
  const Column probe = force_size(ran.metrics, "probe"),
               grasper = force_size(ran.metrics, "grasper");
  EXPECT_GT(at_time(ran.metrics, probe, 1.1), 0.1);
  EXPECT_EQ(at_time(ran.metrics, probe, 1.9), 0.0);
  EXPECT_GT(at_time(ran.metrics, grasper, 2.3), 0.1);
  // Released, it swings back to where gravity alone had put it: same strain energy within 1 %, at
  // rest.
  const Column& strain = ran.metrics.at("strain_J");
  EXPECT_NEAR(strain.back(), at_time(ran.metrics, strain, 0.7), 0.01 * strain.back());
  EXPECT_LT(ran.metrics.at("kinetic_J").back(), 1e-6 * strain.back());
  EXPECT_LT(ran.summary["energies_J"]["largest_hourglass_share"], 0.05);
  expect_closed_energy_balance(ran.summary, 2e-3);
}

TEST(BlockHexCut, converts_what_the_blade_crosses_and_opens) {
  const Ran ran = run_scene_file("block_hex_cut.toml", "[{kind='metrics', file='metrics.csv'}]");
  ASSERT_FALSE(ran.summary.is_discarded());
  ASSERT_EQ(ran.summary["cuts"].size(), 1U);
  const auto& cut = ran.summary["cuts"][0];
  const int n_converted = cut["hexahedra_converted"];
  EXPECT_GT(n_converted, 0);
  EXPECT_EQ(cut["elements_added"], 5 * n_converted);
  EXPECT_EQ(ran.summary["mesh"]["elements"]["hex8"], 24 * 18 * 12 - n_converted);
  EXPECT_EQ(ran.summary["mesh"]["elements"]["tet4"], 6 * n_converted);
  EXPECT_EQ(cut["refused"], 0);
  EXPECT_EQ(cut["pieces"], 1);
  EXPECT_EQ(ran.metrics.at("pieces").back(), 1);
  EXPECT_LE(cut["mass_change"], 1e-12);
  EXPECT_LE(cut["momentum_change"], 1e-12);
  // least_step_ratio of the tetrahedra, which have 1/sqrt(2) of the step of a cube in its place.
  EXPECT_GE(cut["stable_step_ratio"], 0.75 * std::sqrt(0.5));
  EXPECT_GT(ran.summary["least_det_F"]["value"], 0.0);
  const Column& wound = ran.metrics.at("wound_width_m");
  EXPECT_GT(wound.back(), at_time(ran.metrics, wound, 1.2) + 2e-3);  // pulled open
  EXPECT_LT(ran.summary["energies_J"]["largest_hourglass_share"], 0.05);
  expect_closed_energy_balance(ran.summary, 2e-3);
}

TEST(PlaneCut, opens_and_its_recording_can_be_replayed) {
  const Ran ran = run_scene_file(
      "plane_cut.toml",
      "[{kind='metrics', file='metrics.csv'}, {kind='recording', file='cut.trocar'}]");
  ASSERT_FALSE(ran.summary.is_discarded());
  EXPECT_EQ(ran.summary["mesh"]["elements"]["tri3"], 570);
  expect_sound_cuts(ran.summary);
  expect_closed_energy_balance(ran.summary, 1e-4);
  EXPECT_GT(ran.summary["wound"]["width_at_end_m"], 2e-3);

  const std::string recording = ran.folder + "/cut.trocar", folder = ran.folder + "/replay";
  const Finished list = run_trocar({"replay", recording, "--list"}, ran.folder);
  EXPECT_EQ(list.exit_code, 0) << list.err;
  const std::string digest = ran.summary["state_digest"];
  EXPECT_NE(list.out.rfind(digest), std::string::npos);  // the last frame is the final state
  const Finished vtu =
      run_trocar({"replay", recording, "--vtu", "-q", "-o", folder, "--from", "1.9", "--to", "2.1"},
                 ran.folder);
  EXPECT_EQ(vtu.exit_code, 0) << vtu.err;
  EXPECT_EQ(vtu.out + vtu.err, "");
  EXPECT_TRUE(std::filesystem::exists(folder + "/recording.pvd"));
  EXPECT_TRUE(std::filesystem::exists(folder + "/frame_000060.vtu"));
}

TEST(Pictures, are_drawn_for_a_running_scene) {
  const std::string folder = test_folder("pictures");
  const Finished run = run_trocar(
      {"run", config("plane_cut.toml"), "-q", "-o", folder, "--set", "time.duration='0.3 s'",
       "--set",
       "output=[{kind='frames', file='png', size=[320, 180]}, {kind='contact-sheet', "
       "file='sheet.png', size=[320, 180]}, {kind='video', file='film.mp4', size=[320, 180]}]"},
      folder);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"png/000001.png", "png/000009.png", "sheet.png", "film.mp4"}) {
    ASSERT_TRUE(std::filesystem::exists(folder + "/" + name)) << name;
    EXPECT_GT(std::filesystem::file_size(folder + "/" + name), 500u) << name;
  }
}

TEST(Commands, mesh_tells_every_fault_and_fails) {
  const std::string folder = test_folder("fault");
  write_tetrahedra(folder + "/three.msh", {"0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 -1", "1 1 1"},
                   {"1 2 3 4", "2 1 3 5", "1 2 3 6", "1 2 3 6"});
  const Finished mesh = run_trocar({"mesh", folder + "/three.msh"}, folder);
  EXPECT_EQ(mesh.exit_code, 2) << mesh.err;
  EXPECT_NE(mesh.out.find("FAULT             elements 2 and 3 have the same corners"),
            std::string::npos)
      << mesh.out;
  EXPECT_NE(mesh.out.find("FAULT             the facet of nodes 0 1 2 is shared by 4 elements"),
            std::string::npos)
      << mesh.out;
  EXPECT_NE(mesh.out.find("sound             NO"), std::string::npos) << mesh.out;
}

TEST(Commands, check_mesh_doctor_and_help_answer) {
  const std::string folder = test_folder("commands");
  const Finished check = run_trocar({"check", config("block_hex.toml")}, folder);
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_NE(check.out.find("stable step"), std::string::npos);
  const Finished mesh = run_trocar({"mesh", config("meshes/liver.msh")}, folder);
  EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
  EXPECT_NE(mesh.out.find("\"attachment\""), std::string::npos);
  EXPECT_EQ(run_trocar({"doctor"}, folder).exit_code, 0);
  const Finished help = run_trocar({"help", "scene"}, folder);
  EXPECT_NE(help.out.find("young_modulus"), std::string::npos);
  for (const char* command : {"run", "check", "replay", "mesh", "doctor"}) {
    const Finished usage = run_trocar({command, "--help"}, folder);
    EXPECT_EQ(usage.exit_code, 0);
    EXPECT_NE(usage.out.find("examples:"), std::string::npos) << command;
  }
}

Finished run_block_start(const std::string& folder, const std::string& setting) {
  return run_trocar({"run", config("block_hex.toml"), "-q", "-o", folder, "--set", "output=[]",
                     "--set", "time.duration='0.1 s'", "--set", "tissue.shape.cells=[6,6,6]",
                     "--set", "start.state='equilibrium'", "--set", setting},
                    folder);
}

TEST(Equilibrium, is_reported_with_iterations_residual_and_seconds) {
  const std::string folder = test_folder("equilibrium");
  EXPECT_EQ(run_block_start(folder, "start.tolerance=1e-4").exit_code, 0);
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_GT(summary["equilibrium"]["iterations"], 0);
  EXPECT_LE(summary["equilibrium"]["residual"], 1e-4);
  EXPECT_GT(summary["equilibrium"]["seconds"], 0.0);
  EXPECT_NE(summary["events"][0].get<std::string>().find("in equilibrium after "),
            std::string::npos);
}

TEST(Equilibrium, that_is_not_found_ends_the_run_with_a_sentence_and_a_summary) {
  const std::string folder = test_folder("no-equilibrium");
  const Finished run = run_block_start(folder, "start.max_iterations=20");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("no equilibrium to start from: after 20 iterations"), std::string::npos)
      << run.err;
  const nlohmann::json summary = read_summary(folder);
  ASSERT_FALSE(summary.is_discarded());
  EXPECT_EQ(summary["finished"], false);
  EXPECT_EQ(summary["frames"], 0);
}

TEST(Equilibrium, of_a_floating_body_is_an_error_of_the_scene) {
  const std::string folder = test_folder("floating");
  const Finished run = run_block_start(folder, "support=[]");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("no support holds the piece of the body with node 0 along z"),
            std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace trocar
