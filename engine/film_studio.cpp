#include "engine/film_studio.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>

#include "base/error.h"
#include "base/number_text.h"
#include "base/timers.h"
#include "render/image_file.h"
#include "render/renderer.h"
#include "render/view.h"

namespace trocar {

namespace {

constexpr std::size_t queue_length = 2;
constexpr std::int64_t sheet_pictures = 9;

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
  std::vector<TissueColours> colours(mesh.region_name.size(), colours_of(tissue.look));
  for (const SceneRegionMaterial& other : tissue.region_materials) {
    const auto region = std::ranges::find(mesh.region_name, other.region);
    if (other.look && region != mesh.region_name.end())
      colours[region - mesh.region_name.begin()] = colours_of(*other.look);
  }
  return colours;
}

// An order, what writes it, and how far it has come.
struct Film {
  FilmOrder order;
  std::unique_ptr<VideoWriter> video;
  std::unique_ptr<PngQueue> pngs;
  ContactSheet sheet;
  std::int64_t n_seen = 0;

  void open() {
    if (order.kind == OutputKind::video)
      video =
          std::make_unique<VideoWriter>(order.file, order.width, order.height, order.frame_rate);
    if (order.kind == OutputKind::frames) {
      std::filesystem::create_directories(order.file);
      pngs = std::make_unique<PngQueue>();
    }
  }
  void add(const Image& image, std::int64_t number, double time) {
    if (video) video->add(image);
    if (pngs) pngs->add(image, order.file + "/" + with_zeros(number, 6) + ".png");
    if (order.kind == OutputKind::contact_sheet) {
      sheet.images.push_back(image);
      sheet.captions.push_back(time_text(time));
    }
  }
  // Whether the next of its frames is to be drawn: of a contact sheet most are not.
  bool takes_next() {
    const std::int64_t k = n_seen++;
    return order.kind != OutputKind::contact_sheet || is_sheet_moment(k);
  }
  // Nine moments, evenly spread, the last one included.
  bool is_sheet_moment(std::int64_t k) const {
    for (std::int64_t j = 1; j <= sheet_pictures; ++j)
      if (k == std::max<std::int64_t>(0, order.n_frames * j / sheet_pictures - 1)) return true;
    return false;
  }
  void finish() {
    if (video) video->finish();
    if (pngs) pngs->finish();
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
  std::map<std::pair<int, int>, Renderer> renderers;  // by size

  std::mutex mutex;
  std::condition_variable changed;
  std::deque<FilmFrame> queue;
  bool is_closing = false, is_ready = false;
  std::exception_ptr trouble;
  std::atomic<double> seconds = 0;
  std::atomic<std::int64_t> n_drawn = 0;
  std::thread worker;

  void run();
  void open();
  void draw(const FilmFrame& frame);
  SceneView view_of(const FilmFrame& frame, const FilmOrder& order) const;
  void throw_trouble(std::unique_lock<std::mutex>& lock) {
    if (!trouble) return;
    const std::exception_ptr thrown = trouble;
    lock.unlock();
    std::rethrow_exception(thrown);
  }
};

SceneView FilmStudio::Thread::view_of(const FilmFrame& frame, const FilmOrder& order) const {
  SceneView view{.camera = to_camera(order.camera)};
  view.tissues.push_back({.x = frame.x,
                          .X = frame.X,
                          .triangle = frame.surface.triangle,
                          .is_cut = frame.surface.is_cut,
                          .region = frame.region,
                          .is_quad_half = frame.surface.is_quad_half,
                          .look = look,
                          .is_two_sided = is_plane,
                          .has_edges = has_edges});
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
    if (!renderers.contains(size)) renderers.emplace(size, Renderer(size.first, size.second));
  }
}

void FilmStudio::Thread::draw(const FilmFrame& frame) {
  const double start = monotonic_seconds();
  std::vector<std::pair<std::size_t, Image>>
      drawn;  // orders with the same camera and size share a picture
  for (const std::size_t k : frame.orders) {
    if (!films[k].takes_next()) continue;
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

// GL contexts belong to the thread that made them, so the renderers are made here.
void FilmStudio::Thread::run() {
  std::unique_lock lock(mutex);
  try {
    lock.unlock();
    open();
    lock.lock();
    is_ready = true;
    changed.notify_all();
    while (true) {
      changed.wait(lock, [&] { return is_closing || !queue.empty(); });
      if (queue.empty()) break;
      const FilmFrame frame = std::move(queue.front());
      queue.pop_front();
      lock.unlock();
      draw(frame);
      lock.lock();
      changed.notify_all();
    }
    lock.unlock();
    for (Film& film : films) film.finish();
    renderers.clear();
    lock.lock();
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    trouble = std::current_exception();
  }
  is_ready = true;
  changed.notify_all();
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
    t.films.back().n_seen = order.n_before;
    t.films.back().order = std::move(order);
  }
  t.worker = std::thread([&t] { t.run(); });
  std::unique_lock lock(t.mutex);
  t.changed.wait(lock, [&] { return t.is_ready; });
  if (t.trouble) {
    const std::exception_ptr thrown = t.trouble;
    lock.unlock();
    t.worker.join();
    std::rethrow_exception(thrown);
  }
}

FilmStudio::~FilmStudio() {
  if (!thread_->worker.joinable()) return;
  {
    const std::lock_guard lock(thread_->mutex);
    thread_->is_closing = true;
  }
  thread_->changed.notify_all();
  thread_->worker.join();
}

void FilmStudio::add(FilmFrame frame) {
  Thread& t = *thread_;
  std::unique_lock lock(t.mutex);
  t.changed.wait(lock, [&] { return t.trouble || t.queue.size() < queue_length; });
  t.throw_trouble(lock);
  t.queue.push_back(std::move(frame));
  t.changed.notify_all();
}

void FilmStudio::finish() {
  Thread& t = *thread_;
  {
    const std::lock_guard lock(t.mutex);
    t.is_closing = true;
  }
  t.changed.notify_all();
  if (t.worker.joinable()) t.worker.join();
  std::unique_lock lock(t.mutex);
  t.throw_trouble(lock);
}

double FilmStudio::seconds() const {
  return thread_->seconds;
}

std::int64_t FilmStudio::n_drawn() const {
  return thread_->n_drawn;
}

}  // namespace trocar
