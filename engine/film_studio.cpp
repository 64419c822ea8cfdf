#include "engine/film_studio.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "base/timers.h"
#include "engine/tissue.h"
#include "render/image_file.h"
#include "render/renderer.h"
#include "render/view.h"
#include "render/work_queue.h"

namespace trocar {

namespace {

constexpr std::size_t queue_length = 2, pictures_in_flight = 4;

Camera to_camera(const SceneCamera& c) {
  return {.eye = c.eye,
          .target = c.target,
          .up = c.up,
          .field_of_view = c.field_of_view,
          .has_endoscope_mask = c.has_endoscope_mask};
}

std::string time_text(double time) {
  return with_decimals(time, 2) + " s";
}

// The colours of the mesh's regions.
std::vector<TissueColours> region_colours(const SceneTissue& tissue, const Mesh& mesh) {
  const auto colours_of = [](const auto& look) {
    return TissueColours{.outer = look.colour, .cut = look.cut_colour};
  };
  return of_regions(tissue, mesh, colours_of(tissue.look), [&](const SceneRegionMaterial& other) {
    return other.look ? colours_of(*other.look) : colours_of(tissue.look);
  });
}

struct PictureFile {
  Image image;
  std::string file;
};

// An order and what writes it.
struct Film {
  FilmOrder order;
  std::unique_ptr<VideoWriter> video;
  std::unique_ptr<WorkQueue<PictureFile>> pictures;
  ContactSheet sheet;

  void open() {
    if (order.kind == OutputKind::video)
      video =
          std::make_unique<VideoWriter>(order.file, order.width, order.height, order.frame_rate);
    if (order.kind == OutputKind::frames) {
      std::filesystem::create_directories(order.file);
      pictures = std::make_unique<WorkQueue<PictureFile>>(
          pictures_in_flight, [](PictureFile& picture) { write_png(picture.image, picture.file); });
    }
  }
  void add(const Image& image, std::int64_t number, double time) {
    if (video) video->add(image);
    if (pictures) pictures->add({image, order.file + "/" + with_zeros(number, 6) + ".png"});
    if (order.kind == OutputKind::contact_sheet) {
      sheet.images.push_back(image);
      sheet.captions.push_back(time_text(time));
    }
  }
  void finish() {
    if (video) video->finish();
    if (pictures) pictures->finish();
    if (order.kind == OutputKind::contact_sheet && !sheet.images.empty())
      write_png(draw_contact_sheet(sheet), order.file);
  }
};

bool same_picture(const FilmOrder& a, const FilmOrder& b) {
  return a.camera.name == b.camera.name && a.width == b.width && a.height == b.height;
}

}  // namespace

struct FilmStudio::Thread {
  TissueLook look;
  bool is_plane = false, has_edges = false;
  std::vector<Tool> tools;
  std::vector<Film> films;
  std::atomic<double> seconds = 0;
  std::atomic<std::int64_t> n_drawn = 0;
  bool is_finished = false;
  // By size. GL contexts belong to the thread that made them, so they are made and ended by jobs.
  std::map<std::pair<int, int>, Renderer> renderers;
  WorkQueue<std::function<void()>> jobs{queue_length,
                                        [this](const std::function<void()>& job) { run(job); }};

  void run(const std::function<void()>& job);
  void open();
  void draw(const FilmFrame& frame);
  void finish();
  SceneView view_of(const FilmFrame& frame, const FilmOrder& order) const;
};

SceneView FilmStudio::Thread::view_of(const FilmFrame& frame, const FilmOrder& order) const {
  SceneView view{.camera = to_camera(order.camera)};
  view.tissue = {.x = frame.x,
                 .X = frame.X,
                 .triangle = frame.surface.triangle,
                 .is_cut = frame.surface.is_cut,
                 .region = frame.region,
                 .is_quad_half = frame.surface.is_quad_half,
                 .look = look,
                 .is_two_sided = is_plane,
                 .has_edges = has_edges};
  for (const Tool& tool : tools)
    for (const ToolPart& part : tool.parts)
      view.instruments.push_back(
          {.shape = &part.surface, .pose = part_pose(tool, part, frame.time)});
  return view;
}

void FilmStudio::Thread::open() {
  for (Film& film : films) {
    film.open();
    const std::pair<int, int> size(film.order.width, film.order.height);
    renderers.try_emplace(size, size.first, size.second);
  }
}

void FilmStudio::Thread::draw(const FilmFrame& frame) {
  const double start = monotonic_seconds();
  // Orders with the same camera and size share a picture.
  std::vector<std::pair<std::size_t, Image>> drawn;
  for (const std::size_t k : frame.orders) {
    const FilmOrder& order = films[k].order;
    auto found = std::find_if(drawn.begin(), drawn.end(), [&](const auto& d) {
      return same_picture(films[d.first].order, order);
    });
    if (found == drawn.end()) {
      drawn.emplace_back(k, Image{});
      found = drawn.end() - 1;
      renderers.at({order.width, order.height}).draw(view_of(frame, order), found->second);
      ++n_drawn;
    }
    films[k].add(found->second, frame.number, frame.time);
  }
  seconds = seconds + monotonic_seconds() - start;
}

void FilmStudio::Thread::finish() {
  for (Film& film : films) film.finish();
  renderers.clear();
}

void FilmStudio::Thread::run(const std::function<void()>& job) {
  try {
    job();
  } catch (...) {
    renderers.clear();
    throw;
  }
}

bool is_in_view(const FilmOrder& order, std::span<const Vec3> x) {
  const View view = make_view(to_camera(order.camera), order.width, order.height);
  return std::any_of(x.begin(), x.end(), [&](const Vec3& point) {
    const double depth = (point - view.eye).dot(view.forward);
    if (depth < view.near || depth > view.far) return false;
    const Vec2 at = project(view, point, order.width, order.height);
    return at.x() >= 0 && at.x() <= order.width && at.y() >= 0 && at.y() <= order.height;
  });
}

std::vector<std::int32_t> surface_regions(const Mesh& mesh, const Surface& surface) {
  std::vector<std::int32_t> region;
  if (mesh.region_name.size() == 1) return region;
  region.reserve(surface.element.size());
  for (const std::int32_t e : surface.element) region.push_back(mesh.element_region[e]);
  return region;
}

FilmStudio::FilmStudio(std::vector<FilmOrder> orders, const SceneTissue& tissue, const Mesh& mesh,
                       std::vector<Tool> tools)
    : thread_(std::make_unique<Thread>()) {
  Thread& t = *thread_;
  t.look = {.colours = region_colours(tissue, mesh),
            .wetness = tissue.look.wetness,
            .texture_size = tissue.look.texture_size};
  t.is_plane = mesh.dimension() == 2;
  t.has_edges = tissue.look.has_edges;
  t.tools = std::move(tools);
  for (FilmOrder& order : orders) {
    t.films.emplace_back();
    t.films.back().order = std::move(order);
  }
  t.jobs.add([&t] { t.open(); });
  t.jobs.wait();
}

FilmStudio::~FilmStudio() {
  try {
    finish();
  } catch (...) {  // whoever leaves without finish() has something else to tell
  }
}

void FilmStudio::add(FilmFrame frame) {
  thread_->jobs.add([&t = *thread_, frame = std::move(frame)] { t.draw(frame); });
}

void FilmStudio::wait_for_pictures() {
  const auto has_pictures = [](const Film& film) { return film.pictures != nullptr; };
  if (std::ranges::none_of(thread_->films, has_pictures)) return;
  thread_->jobs.wait();
  for (Film& film : thread_->films)
    if (film.pictures) film.pictures->wait();
}

void FilmStudio::finish() {
  Thread& t = *thread_;
  if (std::exchange(t.is_finished, true)) return;
  t.jobs.add([&t] { t.finish(); });
  t.jobs.finish();
}

double FilmStudio::seconds() const {
  return thread_->seconds;
}

std::int64_t FilmStudio::n_drawn() const {
  return thread_->n_drawn;
}

}  // namespace trocar
