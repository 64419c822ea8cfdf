#include "engine/metrics_file.h"

#include "base/error.h"
#include "base/options.h"

namespace trocar {

namespace {

// A column's name as RFC 4180 has it: quoted where it holds a comma, a quote or a line break.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text)
    quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + "\"";
}

}  // namespace

MetricsFile::MetricsFile(const std::string& file, std::span<const Tool> tools,
                         std::span<const std::string> supports,
                         std::span<const SceneMarker> markers)
    : file_(file), stream_(file) {
  stream_ << "time_s,frame,step,substeps,dt_s,stable_step_s,least_J,kinetic_J,strain_J,hourglass_J,"
             "gravity_J,contact_work_J,hold_work_J,blade_work_J,load_work_J,damping_work_J,viscous_"
             "work_J,"
             "cut_energy_J,energy_error_J,contacts,tissue_contacts,held_nodes,cut_edits,pieces,"
             "wound_width_m,"
             "wound_width_mean_m,frame_seconds";
  for (const Tool& tool : tools)
    for (const char* column : {"_x_m", "_y_m", "_z_m", "_force_x_N", "_force_y_N", "_force_z_N"})
      stream_ << ',' << csv_text(tool.name + column);
  for (const std::string& support : supports)
    for (const char* column : {"_force_x_N", "_force_y_N", "_force_z_N"})
      stream_ << ',' << csv_text("support_" + support + column);
  for (const SceneMarker& marker : markers)
    for (const char* column : {"_x_m", "_y_m", "_z_m"})
      stream_ << ',' << csv_text("marker_" + marker.name + column);
  stream_ << '\n';
  check();
}

void MetricsFile::add(const FrameRow& row) {
  stream_ << number_text(row.time) << ',' << row.frame << ',' << row.step << ',' << row.n_substeps;
  for (const double value : {row.dt, row.stable_step, row.least_J, row.energy.kinetic,
                             row.energy.strain, row.energy.hourglass, row.energy.gravity,
                             row.works.contact, row.works.holds, row.works.blade, row.works.loads,
                             row.works.damping, row.works.viscous, row.works.cut, row.energy_error})
    stream_ << ',' << number_text(value);
  stream_ << ',' << row.n_contacts << ',' << row.n_tissue_contacts << ',' << row.n_held << ','
          << row.n_edits << ',' << row.n_pieces;
  for (const double value : {row.wound_width, row.wound_width_mean, row.seconds})
    stream_ << ',' << number_text(value);
  for (const ToolRow& tool : row.tools)
    for (const Vec3& vector : {tool.position, tool.force})
      for (int i = 0; i < 3; ++i) stream_ << ',' << number_text(vector[i]);
  for (const std::vector<Vec3>* vectors : {&row.support_forces, &row.markers})
    for (const Vec3& vector : *vectors)
      for (int i = 0; i < 3; ++i) stream_ << ',' << number_text(vector[i]);
  stream_ << '\n';
  check();
}

void MetricsFile::check() {
  if (!stream_.flush())
    throw MachineError(file_ + ": can't be written (disk full or no permission)");
}

}  // namespace trocar
