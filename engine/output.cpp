#include "engine/output.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/digest.h"
#include "base/error.h"
#include "engine/apply_cut.h"
#include "engine/film_studio.h"
#include "engine/frame_report.h"
#include "engine/metrics_file.h"
#include "engine/simulation.h"
#include "engine/version.h"

namespace trocar {

Outputs::Outputs() = default;
Outputs::~Outputs() = default;
Outputs::Outputs(Outputs&&) noexcept = default;

namespace {

bool is_picture(OutputKind kind) {
  return kind == OutputKind::video || kind == OutputKind::frames ||
         kind == OutputKind::contact_sheet;
}

std::int64_t interval_of(const SceneOutput& output, double frame_rate) {
  return std::max<std::int64_t>(1,
                                static_cast<std::int64_t>(std::llround(output.every * frame_rate)));
}

SceneCamera camera_of(const Scene& scene, const std::string& name) {
  for (const SceneCamera& camera : scene.cameras)
    if (name.empty() || camera.name == name) return camera;
  return {};
}

std::vector<FilmOrder> film_orders(const Scene& scene, const Outputs& outputs) {
  const auto n_frames = std::llround(scene.time.duration * scene.time.frame_rate);
  std::vector<FilmOrder> orders;
  for (std::size_t k = 0; k < scene.outputs.size(); ++k) {
    const SceneOutput& output = scene.outputs[k];
    if (!is_picture(output.kind)) continue;
    const OutputSlot& slot = outputs.slots[k];
    orders.push_back({.kind = output.kind,
                      .file = slot.file,
                      .camera = camera_of(scene, output.camera),
                      .width = output.size[0],
                      .height = output.size[1],
                      .frame_rate = scene.time.frame_rate / static_cast<double>(slot.interval),
                      .n_frames = n_frames / slot.interval});
  }
  return orders;
}

void make_folder(const std::string& folder) {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  const std::string probe = folder + "/.trocar-write-test";
  const bool is_writable = !trouble && std::ofstream(probe).put('x').flush();
  if (!is_writable)
    throw MachineError("the output folder \"" + folder + "\" can't be written" +
                       (trouble ? ": " + trouble.message() : "") + "; choose another one with -o");
  std::filesystem::remove(probe, trouble);
}

void open_writers(const Simulation& s, const std::string& folder, Outputs& outputs) {
  make_folder(folder);
  std::ofstream(folder + "/scene.toml") << echo_options(scene_options(), &s.scene);
  for (const OutputSlot& slot : outputs.slots) {
    std::filesystem::create_directories(std::filesystem::path(slot.file).parent_path());
    outputs.metrics.push_back(slot.kind == OutputKind::metrics
                                  ? std::make_unique<MetricsFile>(slot.file, s.tools)
                                  : nullptr);
    outputs.recordings.push_back(nullptr);
    if (slot.kind != OutputKind::recording) continue;
    RecordingHead head{.version = version_text(),
                       .scene = echo_options(scene_options(), &s.scene),
                       .mesh = s.mesh};
    for (const Tool& tool : s.tools) head.tool_meshes.push_back(tool.own_mesh);
    outputs.recordings.back() = std::make_unique<RecordingWriter>(slot.file, head);
  }
  const std::vector<FilmOrder> orders = film_orders(s.scene, outputs);
  if (!orders.empty())
    outputs.studio =
        std::make_unique<FilmStudio>(orders, s.scene.tissue.look, s.mesh.dimension() == 2, s.tools);
}

void add_film_frame(const Simulation& s, Outputs& outputs, const FrameRow& row) {
  FilmFrame frame{.number = row.frame, .time = row.time};
  std::size_t order = 0;
  for (const OutputSlot& slot : outputs.slots) {
    if (!is_picture(slot.kind)) continue;
    if (slot.is_due(row.frame)) frame.orders.push_back(order);
    ++order;
  }
  if (frame.orders.empty()) return;
  frame.x = s.view.x;
  frame.X = s.mesh.X;
  frame.surface = s.surface;
  outputs.studio->add(std::move(frame));
}

// Collective: the displacements come from all ranks.
void add_recorded_frame(Simulation& s, RecordingWriter* writer, const FrameRow& row) {
  RecordedFrame frame{
      .frame = row.frame, .step = row.step, .time = row.time, .digest = state_digest(s)};
  frame.u = all_gather_field(s.part, s.mesh.n_nodes(), 3, s.state.u, *s.communicator);
  for (const ToolRow& tool : row.tools)
    for (int i = 0; i < 3; ++i) frame.tool_forces.push_back(tool.force[i]);
  if (writer) writer->add(s.log.new_edits, frame);
  s.log.new_edits.clear();
}

}  // namespace

Outputs open_outputs(Simulation& s, const std::string& folder) {
  Outputs outputs;
  for (const SceneOutput& output : s.scene.outputs)
    outputs.slots.push_back({.kind = output.kind,
                             .file = folder + "/" + output.file,
                             .interval = interval_of(output, s.scene.time.frame_rate)});
  std::string error;
  if (s.communicator->is_root()) {
    try {
      open_writers(s, folder, outputs);
    } catch (const std::exception& trouble) {
      error = trouble.what();
    }
  }
  error = s.communicator->first_text(error);
  if (!error.empty()) throw SharedMachineError(error);
  return outputs;
}

void write_outputs(Simulation& s, Outputs& outputs, const FrameRow& row) {
  const PhaseScope scope(s.timers, phase_output);
  for (std::size_t k = 0; k < outputs.slots.size(); ++k) {
    const OutputSlot& slot = outputs.slots[k];
    if (!slot.is_due(row.frame)) continue;
    if (slot.kind == OutputKind::recording)
      add_recorded_frame(s, outputs.recordings.empty() ? nullptr : outputs.recordings[k].get(),
                         row);
    if (!outputs.metrics.empty() && outputs.metrics[k]) outputs.metrics[k]->add(row);
  }
  if (outputs.studio) add_film_frame(s, outputs, row);
}

void finish_outputs(Outputs& outputs) {
  for (auto& recording : outputs.recordings)
    if (recording) recording->finish();
  if (outputs.studio) outputs.studio->finish();
}

bool needs_surface(const Simulation& s, const Outputs& outputs) {
  if (s.contact || !s.duplicate_node.empty()) return true;
  return std::any_of(outputs.slots.begin(), outputs.slots.end(), [&](const OutputSlot& slot) {
    return is_picture(slot.kind) && slot.is_due(s.frame);
  });
}

}  // namespace trocar
