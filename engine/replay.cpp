#include "engine/replay.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/digest.h"
#include "base/error.h"
#include "base/log.h"
#include "base/number_text.h"
#include "engine/film_studio.h"
#include "engine/frame_vtu.h"
#include "engine/output.h"
#include "engine/recording.h"
#include "engine/scene_outputs.h"
#include "engine/tissue.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

SceneCamera camera_of(const Scene& scene, const ReplayOptions& options) {
  const SceneCamera* found = find_camera(scene, options.camera);
  if (!found && !options.camera.empty())
    throw InputError("the recorded scene has " + no_camera_text(scene, options.camera));
  SceneCamera camera = found ? *found : SceneCamera{};
  if (options.eye.size() == 3) camera.eye = Vec3(options.eye[0], options.eye[1], options.eye[2]);
  if (options.target.size() == 3)
    camera.target = Vec3(options.target[0], options.target[1], options.target[2]);
  return camera;
}

std::vector<Tool> recorded_tools(const Scene& scene, const RecordingHead& head) {
  std::vector<Tool> tools;
  for (std::size_t k = 0; k < scene.instruments.size(); ++k)
    tools.push_back(make_tool(scene.instruments[k],
                              k < head.tool_meshes.size() ? head.tool_meshes[k] : TriangleMesh{},
                              1e-3));
  return tools;
}

// All of them; throws InputError behind the last one if any is damaged.
void list_frames(RecordingReader& reader,
                 const std::vector<std::pair<std::int64_t, double>>& frames) {
  std::string first_damage;
  std::size_t n_damaged = 0;
  for (const auto& [frame, time] : frames) {
    std::string what;
    try {
      what = digest_text(reader.read(frame).digest);
    } catch (const InputError& trouble) {
      what = "damaged";
      if (n_damaged++ == 0) first_damage = trouble.what();
    }
    std::printf("%8lld  %10.4f s  %s\n", static_cast<long long>(frame), time, what.c_str());
  }
  if (n_damaged > 0)
    throw InputError(first_damage + "; " + std::to_string(n_damaged) + " of " +
                     std::to_string(frames.size()) + " frames are damaged, the others are whole");
}

std::string video_file(const ReplayOptions& options) {
  return (std::filesystem::path(options.folder) / options.video).string();
}

// The film is not written over what it shows.
void check_recording_stays(const ReplayOptions& options) {
  std::error_code is_new;
  if (!options.video.empty() &&
      std::filesystem::equivalent(video_file(options), options.recording, is_new))
    throw InputError("--video " + options.video + ": the film would replace its recording");
}

std::vector<FilmOrder> orders_of(const Scene& scene, const ReplayOptions& options, double rate) {
  std::vector<FilmOrder> orders;
  const auto add = [&](OutputKind kind, const std::string& file) {
    orders.push_back({.kind = kind,
                      .file = file,
                      .camera = camera_of(scene, options),
                      .width = options.width,
                      .height = options.height,
                      .frame_rate = rate});
  };
  if (!options.video.empty()) add(OutputKind::video, video_file(options));
  if (options.writes_frames) add(OutputKind::frames, options.folder + "/frames");
  return orders;
}

// Frames of the recording in [from, to].
std::vector<std::pair<std::int64_t, double>> chosen_frames(const RecordingReader& reader,
                                                           const ReplayOptions& options) {
  std::vector<std::pair<std::int64_t, double>> chosen;
  for (const auto& entry : reader.frames())
    if (entry.second >= options.from - 1e-9 && entry.second <= options.to + 1e-9)
      chosen.push_back(entry);
  if (reader.frames().empty()) throw InputError(options.recording + ": holds no frame");
  if (chosen.empty())
    throw InputError(options.recording + ": no recorded frame lies in the chosen time");
  return chosen;
}

// The displacements are counted in the frame, the nodes follow from the edits before it.
void check_frame(const RecordedFrame& frame, const Mesh& mesh, const std::string& recording) {
  const std::size_t n = frame.u.size() / 3;
  if (frame.u.size() != 3 * mesh.X.size())
    throw InputError(recording + ": frame " + std::to_string(frame.frame) + ": has " +
                     std::to_string(n) + " displacements for " + std::to_string(mesh.X.size()) +
                     " nodes");
}

Scene recorded_scene(const RecordingReader& reader, const ReplayOptions& options) {
  Scene scene;
  SourceMap where;
  read_options_text(scene_options(), reader.head().scene, options.recording, {}, &scene, where);
  return scene;
}

double frame_rate_of(const Scene& scene,
                     const std::vector<std::pair<std::int64_t, double>>& frames) {
  const double span = frames.back().second - frames.front().second;
  return span > 0 ? static_cast<double>(frames.size() - 1) / span : scene.time.frame_rate;
}

// None of a plane body whose thickness is free: its strain across is not recorded.
std::vector<Material> recorded_materials(const Scene& scene, const Mesh& mesh) {
  const bool is_free =
      mesh.dimension() == 2 && scene.solver.triangle == Formulation::tri3_plane_stress;
  return is_free ? std::vector<Material>() : region_materials(scene.tissue, mesh);
}

// What all frames between two edits share.
FilmFrame film_of(const Mesh& mesh, std::size_t orders) {
  FilmFrame film{.X = mesh.X, .surface = boundary_surface(mesh)};
  film.region = surface_regions(mesh, film.surface);
  for (std::size_t k = 0; k < orders; ++k) film.orders.push_back(k);
  return film;
}

FilmFrame film_frame(FilmFrame film, const RecordedFrame& frame) {
  film.number = frame.frame;
  film.time = frame.time;
  film.x = present_positions(film.X, frame.u);
  return film;
}

}  // namespace

void replay(const ReplayOptions& options) {
  RecordingReader reader(options.recording);
  for (const std::string& sentence : reader.damage())
    log_warning(options.recording + ": " + sentence);
  const auto frames = chosen_frames(reader, options);
  if (options.is_list) return list_frames(reader, frames);
  if (options.video.empty() && !options.writes_frames && !options.writes_vtu)
    throw InputError("nothing to do: ask for --video FILE, --frames, --vtu or --list");
  check_recording_stays(options);
  make_output_folder(options.folder);
  const RecordingHead& head = reader.head();
  const Scene scene = recorded_scene(reader, options);
  const std::vector<Material> materials = recorded_materials(scene, head.mesh);
  const std::vector<FilmOrder> orders = orders_of(scene, options, frame_rate_of(scene, frames));
  std::unique_ptr<FilmStudio> studio;  // the picture thread for what is asked for
  if (!orders.empty())
    studio =
        std::make_unique<FilmStudio>(orders, scene.tissue, head.mesh, recorded_tools(scene, head));
  std::vector<PvdEntry> entries;
  FilmFrame film;
  ProgressBar bar("replay");
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const RecordedFrame frame = reader.read(frames[k].first);
    const std::int64_t n_edits = reader.n_edits();
    const Mesh& mesh = reader.mesh_at(frames[k].first);
    check_frame(frame, mesh, options.recording);
    if (options.writes_vtu)
      entries.push_back(write_frame_vtu(mesh, frame, materials, options.folder));
    if (studio && (k == 0 || reader.n_edits() != n_edits)) film = film_of(mesh, orders.size());
    if (studio) studio->add(film_frame(film, frame));
    bar.update(static_cast<double>(k + 1) / static_cast<double>(frames.size()),
               std::to_string(k + 1) + " frames");
  }
  if (studio) studio->finish();
  if (options.writes_vtu) write_pvd(entries, options.folder + "/recording.pvd");
}

}  // namespace trocar
