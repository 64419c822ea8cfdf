#include "render_scene.h"

#include <cstdlib>

namespace trocar::testing {

WithVariable::WithVariable(const std::string& n, const std::string& value) : name(n) {
  if (const char* old = std::getenv(n.c_str())) before = old;
  setenv(n.c_str(), value.c_str(), 1);
}

WithVariable::~WithVariable() {
  setenv(name.c_str(), before.c_str(), 1);
}

Sheet make_sheet(double side, int n, bool is_cut) {
  Sheet s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      s.x.emplace_back(side * (1.0 * i / n - 0.5), side * (1.0 * j / n - 0.5), 0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      s.triangle.push_back({a, b, c});
      s.triangle.push_back({a, c, d});
    }
  s.is_cut.assign(s.triangle.size(), is_cut ? 1 : 0);
  return s;
}

TissueView view_of(const Sheet& s) {
  return {.x = s.x, .X = s.x, .triangle = s.triangle, .is_cut = s.is_cut};
}

Camera camera_above(double height) {
  return {
      .eye = Vec3(0, 0, height), .target = Vec3::Zero(), .up = Vec3::UnitY(), .field_of_view = 0.9};
}

Image draw_once(const SceneView& scene, int width, int height) {
  Renderer renderer(width, height);
  Image image;
  renderer.draw(scene, image);
  return image;
}

double mean_level(const Image& image, int x, int y, int r, int colour) {
  double sum = 0;
  for (int j = y - r; j <= y + r; ++j)
    for (int i = x - r; i <= x + r; ++i) sum += image.rgb[(j * image.width + i) * 3 + colour];
  return sum / ((2 * r + 1) * (2 * r + 1));
}

}  // namespace trocar::testing
