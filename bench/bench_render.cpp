// Pictures a second of a wavy sheet of tissue seen through the endoscope, by the number of its
// triangles, and where the time goes. JSON to stdout.
// bench_render [width] [height] (default 1280 720)
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "bench/machine.h"
#include "bench/usage.h"
#include "render/renderer.h"
#include "render_scene.h"

using namespace trocar;

namespace {

SceneView scene_of(const testing::Sheet& sheet) {
  Camera camera{.eye = Vec3(0, -.12, .1), .has_endoscope_mask = true};
  return {.camera = camera, .tissue = testing::view_of(sheet), .instruments = {}, .caption = ""};
}

void report(int n, int width, int height, bool is_first) {
  testing::Sheet sheet = testing::make_sheet(.2, n);
  for (Vec3& x : sheet.x) x.z() = .005 * std::sin(60 * x.x()) * std::cos(50 * x.y());
  const SceneView scene = scene_of(sheet);
  Renderer renderer(width, height);
  Image image;
  renderer.draw(scene, image);
  const auto before = renderer.timers().totals();
  constexpr int n_pictures = 12;
  double best = 1e300;
  for (int k = 0; k < n_pictures; ++k) {
    const double start = monotonic_seconds();
    renderer.draw(scene, image);
    best = std::min(best, monotonic_seconds() - start);
  }
  std::printf("%s\n  {\"triangles\": %zu, \"picture_ms\": %.2f, \"pictures_per_second\": %.1f, ",
              is_first ? "" : ",", sheet.triangle.size(), 1e3 * best, 1 / best);
  std::printf("\"mean_ms\": {");
  const auto after = renderer.timers().totals();
  for (std::size_t k = 0; k < after.size(); ++k)
    std::printf("%s\"%s\": %.2f", k == 0 ? "" : ", ", after[k].first.c_str(),
                1e3 * (after[k].second - (k < before.size() ? before[k].second : 0)) / n_pictures);
  std::printf("}}");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (const int code =
          answer_options(argc, argv, "bench_render [width] [height] (default 1280 720)");
      code >= 0)
    return code;
  const int width = argc > 1 ? std::atoi(argv[1]) : 1280;
  const int height = argc > 2 ? std::atoi(argv[2]) : 720;
  std::printf(
      "{\"width\": %d, \"height\": %d, \"cores\": %d, \"peak_gflops\": %.1f, "
      "\"triad_gbytes\": %.1f, ",
      width, height, available_cores(), peak_gflops(), triad_gbytes());
  std::printf("\"pictures\": [");
  bool is_first = true;
  for (const int n : {30, 100, 300}) {
    report(n, width, height, is_first);
    is_first = false;
  }
  std::printf("\n]}\n");
}
