#include "engine/metrics_file.h"

#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number_text.h"
#include "base/quoted.h"

namespace trocar {

namespace {

// A column's name as RFC 4180 has it: quoted where it holds a comma, a quote or a line break.
std::string csv_text(const std::string& text) {
  return text.find_first_of(",\"\r\n") == std::string::npos ? text : csv_quoted(text);
}

std::string text_of(double value) {
  return number_text(value);
}
std::string text_of(std::int64_t value) {
  return std::to_string(value);
}

// The columns that every run has, by their names.
std::vector<std::pair<std::string, std::string>> fields_of(const FrameRow& row) {
  const EnergyState& energy = row.energy;
  const EnergyWorks& works = row.works;
  return {{"time_s", text_of(row.time)},
          {"frame", text_of(row.frame)},
          {"step", text_of(row.step)},
          {"substeps", text_of(row.n_substeps)},
          {"dt_s", text_of(row.dt)},
          {"stable_step_s", text_of(row.stable_step)},
          {"least_J", text_of(row.least_J)},
          {"kinetic_J", text_of(energy.kinetic)},
          {"strain_J", text_of(energy.strain)},
          {"hourglass_J", text_of(energy.hourglass)},
          {"gravity_J", text_of(energy.gravity)},
          {"contact_work_J", text_of(works.contact)},
          {"hold_work_J", text_of(works.holds)},
          {"blade_work_J", text_of(works.blade)},
          {"load_work_J", text_of(works.loads)},
          {"damping_work_J", text_of(works.damping)},
          {"viscous_work_J", text_of(works.viscous)},
          {"cut_energy_J", text_of(works.cut)},
          {"energy_error_J", text_of(row.energy_error)},
          {"contacts", text_of(row.n_contacts)},
          {"tissue_contacts", text_of(row.n_tissue_contacts)},
          {"held_nodes", text_of(row.n_held)},
          {"cut_edits", text_of(row.n_edits)},
          {"pieces", text_of(row.n_pieces)},
          {"wound_width_m", text_of(row.wound_width)},
          {"wound_width_mean_m", text_of(row.wound_width_mean)},
          {"frame_seconds", text_of(row.seconds)}};
}

}  // namespace

MetricsFile::MetricsFile(const std::string& file, std::span<const Tool> tools,
                         std::span<const std::string> supports,
                         std::span<const SceneMarker> markers)
    : file_(file), stream_(file) {
  std::string separator;
  for (const auto& [name, text] : fields_of({})) {
    stream_ << separator << name;
    separator = ",";
  }
  const auto add_vector = [&](const std::string& name, const std::string& unit) {
    for (const char* axis : {"_x_", "_y_", "_z_"}) stream_ << ',' << csv_text(name + axis + unit);
  };
  for (const Tool& tool : tools) {
    add_vector(tool.name, "m");
    add_vector(tool.name + "_force", "N");
    add_vector(tool.name + "_torque", "Nm");
  }
  for (const std::string& support : supports) add_vector("support_" + support + "_force", "N");
  for (const SceneMarker& marker : markers) add_vector("marker_" + marker.name, "m");
  stream_ << '\n';
  check();
}

void MetricsFile::add(const FrameRow& row) {
  std::string separator;
  for (const auto& [name, text] : fields_of(row)) {
    stream_ << separator << text;
    separator = ",";
  }
  const auto add_vector = [&](const Vec3& vector) {
    for (int i = 0; i < 3; ++i) stream_ << ',' << number_text(vector[i]);
  };
  for (const ToolRow& tool : row.tools) {
    add_vector(tool.position);
    add_vector(tool.force);
    add_vector(tool.torque);
  }
  for (const Vec3& force : row.support_forces) add_vector(force);
  for (const Vec3& marker : row.markers) add_vector(marker);
  stream_ << '\n';
  check();
}

void MetricsFile::check() {
  if (!stream_.flush())
    throw MachineError(file_ + ": can't be written (disk full or no permission)");
}

}  // namespace trocar
