#include "engine/metrics_file.h"

#include <gtest/gtest.h>

#include <sstream>

#include "error_of.h"
#include "test_files.h"

namespace trocar {
namespace {

// Fields of a line as RFC 4180 reads them.
std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> list(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && is_quoted && i + 1 < line.size() && line[i + 1] == '"')
      list.back() += line[i++];
    else if (line[i] == '"')
      is_quoted = !is_quoted;
    else if (line[i] == ',' && !is_quoted)
      list.emplace_back();
    else
      list.back() += line[i];
  }
  return list;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> list;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) list.push_back(line);
  return list;
}

std::vector<Tool> two_tools(const std::string& first) {
  SceneInstrument probe{.name = first, .path = {{.time = 0}}}, scalpel = probe;
  scalpel.kind = InstrumentKind::scalpel;
  scalpel.name = "blade";
  return {make_tool(probe, {}, 1e-3), make_tool(scalpel, {}, 1e-3)};
}

const std::vector<std::string> supports = {"z-"};
const std::vector<SceneMarker> markers = {{.name = "tumour"}};

FrameRow example_row() {
  FrameRow row{.frame = 3,
               .step = 120,
               .n_substeps = 40,
               .time = 0.1,
               .dt = 1.0 / 1200,
               .stable_step = 1e-3,
               .least_J = 0.9,
               .energy = {.kinetic = 1, .strain = 2, .hourglass = 3, .gravity = 21},
               .works = {.contact = 22,
                         .holds = 23,
                         .blade = 24,
                         .loads = 33,
                         .damping = -25,
                         .viscous = -29,
                         .cut = 26},
               .energy_error = 27,
               .wound_width = 4,
               .wound_width_mean = 5,
               .n_contacts = 6,
               .n_tissue_contacts = 37,
               .n_held = 7,
               .n_edits = 8,
               .n_pieces = 28,
               .seconds = 9};
  row.tools.resize(2);
  row.tools[0] = {
      .position = Vec3(10, 11, 12), .force = Vec3(13, 14, 15), .torque = Vec3(38, 39, 40)};
  row.tools[1] = {
      .position = Vec3(16, 17, 18), .force = Vec3(19, 20, 1.0 / 3), .torque = Vec3(41, 42, 43)};
  row.support_forces = {Vec3(30, 31, 32)};
  row.markers = {Vec3(34, 35, 36)};
  return row;
}

TEST(MetricsFile, has_each_value_of_a_row_under_its_column) {
  const TestFolder folder;
  const std::string file = folder.file("m.csv");
  {
    MetricsFile metrics(file, two_tools("probe"), supports, markers);
    metrics.add(example_row());
  }
  const std::vector<std::string> text = lines(read_text(file));
  ASSERT_EQ(text.size(), 2u);
  const std::vector<std::string> names = fields(text[0]), values = fields(text[1]);
  ASSERT_EQ(names.size(), values.size());
  const auto value = [&](const std::string& name) {
    for (std::size_t k = 0; k < names.size(); ++k)
      if (names[k] == name) return std::stod(values[k]);
    ADD_FAILURE() << "no column " << name;
    return 0.0;
  };
  const std::vector<std::pair<std::string, double>> expected = {{"time_s", 0.1},
                                                                {"frame", 3},
                                                                {"step", 120},
                                                                {"substeps", 40},
                                                                {"dt_s", 1.0 / 1200},
                                                                {"stable_step_s", 1e-3},
                                                                {"least_J", 0.9},
                                                                {"kinetic_J", 1},
                                                                {"strain_J", 2},
                                                                {"hourglass_J", 3},
                                                                {"gravity_J", 21},
                                                                {"contact_work_J", 22},
                                                                {"hold_work_J", 23},
                                                                {"blade_work_J", 24},
                                                                {"load_work_J", 33},
                                                                {"damping_work_J", -25},
                                                                {"viscous_work_J", -29},
                                                                {"cut_energy_J", 26},
                                                                {"energy_error_J", 27},
                                                                {"wound_width_m", 4},
                                                                {"wound_width_mean_m", 5},
                                                                {"contacts", 6},
                                                                {"tissue_contacts", 37},
                                                                {"held_nodes", 7},
                                                                {"cut_edits", 8},
                                                                {"pieces", 28},
                                                                {"frame_seconds", 9},
                                                                {"marker_tumour_x_m", 34},
                                                                {"marker_tumour_y_m", 35},
                                                                {"marker_tumour_z_m", 36},
                                                                {"support_z-_force_x_N", 30},
                                                                {"support_z-_force_y_N", 31},
                                                                {"support_z-_force_z_N", 32},
                                                                {"probe_x_m", 10},
                                                                {"probe_y_m", 11},
                                                                {"probe_z_m", 12},
                                                                {"probe_force_x_N", 13},
                                                                {"probe_force_y_N", 14},
                                                                {"probe_force_z_N", 15},
                                                                {"probe_torque_x_Nm", 38},
                                                                {"probe_torque_y_Nm", 39},
                                                                {"probe_torque_z_Nm", 40},
                                                                {"blade_x_m", 16},
                                                                {"blade_y_m", 17},
                                                                {"blade_z_m", 18},
                                                                {"blade_force_x_N", 19},
                                                                {"blade_force_y_N", 20},
                                                                {"blade_force_z_N", 1.0 / 3},
                                                                {"blade_torque_x_Nm", 41},
                                                                {"blade_torque_y_Nm", 42},
                                                                {"blade_torque_z_Nm", 43}};
  EXPECT_EQ(names.size(), expected.size());
  for (const auto& [name, number] : expected)
    EXPECT_EQ(value(name), number) << name;  // texts read back to the same bits
}

TEST(MetricsFile, has_every_row_on_the_disk_before_the_next_comes) {
  const TestFolder folder;
  const std::string file = folder.file("m.csv");
  MetricsFile metrics(file, two_tools("probe"), supports, markers);
  EXPECT_EQ(lines(read_text(file)).size(), 1u);
  for (std::size_t k = 0; k < 3; ++k) {
    metrics.add(example_row());
    EXPECT_EQ(lines(read_text(file)).size(), k + 2);
  }
}

TEST(MetricsFile, keeps_its_columns_whatever_an_instrument_is_called) {
  const TestFolder folder;
  const std::string file = folder.file("m.csv");
  {
    MetricsFile metrics(file, two_tools("left, \"old\" probe"), supports, markers);
    metrics.add(example_row());
  }
  const std::vector<std::string> text = lines(read_text(file));
  EXPECT_EQ(fields(text[0]).size(), fields(text[1]).size());
  EXPECT_EQ(fields(text[0])[27], "left, \"old\" probe_x_m");
}

TEST(MetricsFile, says_which_file_can_not_be_written) {
  const TestFolder folder;
  const std::string file = folder.file("no/such/folder/m.csv");
  EXPECT_TRUE(contains(error_of<MachineError>([&] { MetricsFile(file, {}, {}, {}); }),
                       file + ": can't be written"));
}

TEST(MetricsFile, notices_a_full_disk) {
  if (access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  EXPECT_THROW(MetricsFile("/dev/full", {}, {}, {}), MachineError);
}

}  // namespace
}  // namespace trocar
