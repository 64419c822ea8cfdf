#include "engine/output.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "base/error.h"
#include "base/log.h"
#include "base/on_root.h"
#include "base/whole_file.h"
#include "engine/checkpoint.h"
#include "engine/checkpoint_file.h"
#include "engine/film_studio.h"
#include "engine/point_text.h"
#include "engine/run_files.h"
#include "engine/simulation.h"
#include "engine/state_digest.h"
#include "engine/version.h"

namespace trocar {

// Nine moments, evenly spread, the last one included.
static bool is_sheet_moment(std::int64_t k, std::int64_t n) {
  constexpr std::int64_t n_pictures = 9;
  for (std::int64_t j = 1; j <= n_pictures; ++j)
    if (k == std::max<std::int64_t>(1, n * j / n_pictures)) return true;
  return false;
}

bool OutputSlot::is_due(std::int64_t frame) const {
  return frame % interval == 0 && (kind != OutputKind::contact_sheet ||
                                   is_sheet_moment(frame / interval, n_frames / interval));
}

Outputs::Outputs() = default;
Outputs::~Outputs() = default;
Outputs::Outputs(Outputs&&) noexcept = default;

namespace {

std::vector<FilmOrder> place_orders(const Scene& scene, Outputs& outputs) {
  std::vector<FilmOrder> orders;
  for (std::size_t k = 0; k < scene.outputs.size(); ++k) {
    const SceneOutput& output = scene.outputs[k];
    if (!is_picture(output.kind)) continue;
    OutputSlot& slot = outputs.slots[k];
    slot.film = orders.size();
    orders.push_back({.kind = output.kind,
                      .file = slot.file,
                      .camera = *find_camera(scene, output.camera),
                      .width = output.size[0],
                      .height = output.size[1],
                      .frame_rate = scene.time.frame_rate / static_cast<double>(slot.interval)});
  }
  return orders;
}

void warn_of_empty_pictures(const Simulation& s, std::span<const FilmOrder> orders) {
  const Vec3 middle = std::accumulate(s.mesh.X.begin(), s.mesh.X.end(), Vec3(Vec3::Zero())) /
                      static_cast<double>(s.mesh.X.size());
  for (const FilmOrder& order : orders)
    if (!is_in_view(order, s.mesh.X))
      log_warning(order.file + ": camera \"" + order.camera.name + "\" looks from " +
                  point_text(order.camera.eye) + " to " + point_text(order.camera.target) +
                  " m and sees nothing of the tissue, which is around " + point_text(middle) +
                  " m at the start");
}

std::unique_ptr<RecordingWriter> new_recording(const Simulation& s, const std::string& file) {
  RecordingHead head{
      .version = version_text(), .scene = echo_options(scene_options(), &s.scene), .mesh = s.mesh};
  for (const Tool& tool : s.tools) head.tool_meshes.push_back(tool.own_mesh);
  return std::make_unique<RecordingWriter>(file, head);
}

// Cut off behind the last frame that the checkpoint knows of, which must be there and whole.
std::unique_ptr<RecordingWriter> old_recording(const std::string& file, std::int64_t last_frame) {
  {
    RecordingReader reader(file);
    for (const std::string& sentence : reader.damage()) log_warning(file + ": " + sentence);
    if (last_frame > 0) reader.read(last_frame);
  }
  return std::make_unique<RecordingWriter>(file, last_frame);
}

// "m.csv" to "m.TAG-frame-75.csv".
std::string tagged(const std::string& file, const std::string& tag, std::int64_t frame) {
  std::filesystem::path path(file);
  path.replace_filename(path.stem().string() + "." + tag + "-frame-" + std::to_string(frame) +
                        path.extension().string());
  return path.string();
}

// The run went on without it: it would be lost. What stands aside already is that of an earlier try
// to go on from there. Whether there was one.
bool set_aside(const std::string& file, std::int64_t frame) {
  const std::string aside = tagged(file, "before", frame);
  if (!std::filesystem::exists(file) || std::filesystem::exists(aside)) return false;
  for (const char* tail : {"-wal", "-journal", ""})  // a recording's, of a run that was killed
    if (std::filesystem::exists(file + tail)) std::filesystem::rename(file + tail, aside + tail);
  log_warning(file + ": the run went on without it, a new one begins after frame " +
              std::to_string(frame) + "; the old one is " + aside + " now");
  return true;
}

// Rows of the frames before a resumed run are written again: the checkpoint has them.
std::unique_ptr<MetricsFile> open_metrics(const Simulation& s, const OutputSlot& slot,
                                          const Checkpoint* resumed) {
  const std::int64_t begin = resumed ? s.energy->memory.first_frame : 0;
  if (resumed && !slot.is_continued && !set_aside(slot.file, s.first_frame) && begin > 0)
    log_warning(slot.file + ": begins after frame " + std::to_string(begin) +
                ", it was not asked for before");
  auto metrics = std::make_unique<MetricsFile>(slot.file, s.tools, support_names(s.scene.supports),
                                               s.scene.markers);
  if (!resumed) return metrics;
  for (const FrameRow& row : *resumed->rows)
    if (row.frame > begin && slot.is_due(row.frame)) metrics->add(row);
  return metrics;
}

// On every rank: what the checkpoint knows goes on.
void take_over_marks(const Scene& scene, const Checkpoint& resumed, Outputs& outputs) {
  for (std::size_t k = 0; k < outputs.slots.size(); ++k)
    for (const OutputMark& mark : resumed.outputs)
      if (mark.file == scene.outputs[k].file && mark.kind == outputs.slots[k].kind) {
        outputs.slots[k].is_continued = true;
        outputs.slots[k].last_frame = mark.last_frame;
        outputs.slots[k].pending = mark.pending;
      }
}

// "liver.mp4" resumed at frame 75 goes on in "liver.from-frame-75.mp4": an encoder can't go on with
// a finished film, and to draw its first part again would take as long as it did.
void rename_films(const Simulation& s, Outputs& outputs) {
  if (s.first_frame == 0) return;
  for (OutputSlot& slot : outputs.slots) {
    if (slot.kind != OutputKind::video && slot.kind != OutputKind::contact_sheet) continue;
    const std::string next = tagged(slot.file, "from", s.first_frame);
    log_info(slot.file + " can't be continued: what follows goes into " + next);
    slot.file = next;
  }
}

void open_writers(const Simulation& s, const std::string& echo, const Checkpoint* resumed,
                  Outputs& outputs) {
  make_output_folder(outputs.folder);
  if (resumed)
    rename_films(s, outputs);
  else
    remove_checkpoint(outputs.folder);  // it would not belong to the files that are written now
  if (!echo.empty()) write_whole_file(outputs.folder + "/" + scene_name, echo);
  for (OutputSlot& slot : outputs.slots) {
    std::filesystem::create_directories(std::filesystem::path(slot.file).parent_path());
    if (slot.kind == OutputKind::metrics) slot.metrics = open_metrics(s, slot, resumed);
    if (slot.kind != OutputKind::recording) continue;
    if (resumed && !slot.is_continued) set_aside(slot.file, s.first_frame);
    slot.recording =
        slot.is_continued ? old_recording(slot.file, slot.last_frame) : new_recording(s, slot.file);
  }
  const std::vector<FilmOrder> orders = place_orders(s.scene, outputs);
  const bool is_over = s.first_frame >= s.scene.time.n_frames();
  if (orders.empty() || is_over) return;
  warn_of_empty_pictures(s, orders);
  outputs.studio = std::make_unique<FilmStudio>(orders, s.scene.tissue, s.mesh, s.tools);
}

void add_film_frame(const Simulation& s, Outputs& outputs, const FrameRow& row) {
  FilmFrame frame{.number = row.frame, .time = row.time};
  for (const OutputSlot& slot : outputs.slots)
    if (is_picture(slot.kind) && slot.is_due(row.frame)) frame.orders.push_back(slot.film);
  if (frame.orders.empty()) return;
  frame.x = s.view.x;
  frame.X = s.mesh.X;
  frame.surface = s.surface;
  frame.region = surface_regions(s.mesh, s.surface);
  outputs.studio->add(std::move(frame));
}

// The displacements come from all ranks to the one with the writer. Collective.
void add_recorded_frame(Simulation& s, OutputSlot& slot, const FrameRow& row) {
  RecordedFrame frame{
      .frame = row.frame, .step = row.step, .time = row.time, .digest = state_digest(s)};
  frame.u = gather_field(s.part, 3, s.state.u, *s.communicator);
  for (const ToolRow& tool : row.tools)
    for (int i = 0; i < 3; ++i) frame.tool_forces.push_back(tool.force[i]);
  on_root(*s.communicator, [&] {
    // One that fails is left as a kill would leave it, without an end that it has not come to.
    std::unique_ptr<RecordingWriter> writer = std::move(slot.recording);
    writer->add(slot.pending, frame);
    slot.recording = std::move(writer);
  });
  slot.pending.clear();
  slot.last_frame = row.frame;
}

// Each recording keeps the edits until its next frame is due.
void hand_out_edits(Simulation& s, Outputs& outputs) {
  for (OutputSlot& slot : outputs.slots)
    if (slot.kind == OutputKind::recording)
      slot.pending.insert(slot.pending.end(), s.log.new_edits.begin(), s.log.new_edits.end());
  s.log.new_edits.clear();
}

}  // namespace

void make_output_folder(const std::string& folder) {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  const std::string probe = folder + "/.trocar-write-test";
  errno = 0;
  if (!trouble && !std::ofstream(probe).put('x').flush())
    trouble = std::error_code(errno, std::generic_category());
  std::error_code ignored;
  std::filesystem::remove(probe, ignored);
  if (trouble)
    throw MachineError("the output folder \"" + folder + "\" can't be written: " +
                       trouble.message() + "; choose another one with -o");
}

Outputs open_outputs(Simulation& s, const std::string& folder, const std::string& echo,
                     const Checkpoint* resumed) {
  Outputs outputs;
  outputs.folder = folder;
  for (const SceneOutput& output : s.scene.outputs)
    outputs.slots.push_back({.kind = output.kind,
                             .file = folder + "/" + output.file,
                             .interval = s.scene.time.interval(output.every),
                             .n_frames = s.scene.time.n_frames()});
  if (resumed) take_over_marks(s.scene, *resumed, outputs);
  on_root(*s.communicator, [&] { open_writers(s, echo, resumed, outputs); });
  return outputs;
}

void write_outputs(Simulation& s, Outputs& outputs, const FrameRow& row) {
  const PhaseScope scope(s.timers, phase_output);
  hand_out_edits(s, outputs);
  for (OutputSlot& slot : outputs.slots)
    if (slot.kind == OutputKind::recording && slot.is_due(row.frame))
      add_recorded_frame(s, slot, row);
  on_root(*s.communicator, [&] {
    for (OutputSlot& slot : outputs.slots)
      if (slot.metrics && slot.is_due(row.frame)) slot.metrics->add(row);
    if (outputs.studio) add_film_frame(s, outputs, row);
  });
}

void finish_outputs(Outputs& outputs) {
  for (OutputSlot& slot : outputs.slots)
    if (slot.recording) slot.recording->finish();
  if (outputs.studio) outputs.studio->finish();
}

bool needs_surface(const Simulation& s, const Outputs& outputs) {
  if (s.contact || !s.duplicate_node.empty()) return true;
  return std::any_of(outputs.slots.begin(), outputs.slots.end(), [&](const OutputSlot& slot) {
    return is_picture(slot.kind) && slot.is_due(s.frame);
  });
}

}  // namespace trocar
