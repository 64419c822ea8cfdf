// Small surfaces and scenes that several tests of render/ share.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "mesh/triangle_mesh.h"
#include "render/renderer.h"

namespace trocar::testing {

using Triangles = std::vector<std::array<std::int32_t, 3>>;

// A square sheet in z = 0 that looks up, of 2 n^2 triangles.
struct Sheet {
  std::vector<Vec3> x;
  Triangles triangle;
  std::vector<std::uint8_t> is_cut;
};
inline Sheet make_sheet(double side, int n, bool is_cut = false) {
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

inline TissueView view_of(const Sheet& s) {
  return {.x = s.x, .X = s.x, .triangle = s.triangle, .is_cut = s.is_cut};
}

inline Camera camera_above(double height) {
  return {
      .eye = Vec3(0, 0, height), .target = Vec3::Zero(), .up = Vec3::UnitY(), .field_of_view = 0.9};
}

inline Image draw_once(const SceneView& scene, int width = 160, int height = 120) {
  Renderer renderer(width, height);
  Image image;
  renderer.draw(scene, image);
  return image;
}

// Mean of a colour (0 red, 1 green, 2 blue) over the square of (2 r + 1)^2 pixels around one.
inline double mean_level(const Image& image, int x, int y, int r, int colour) {
  double sum = 0;
  for (int j = y - r; j <= y + r; ++j)
    for (int i = x - r; i <= x + r; ++i) sum += image.rgb[(j * image.width + i) * 3 + colour];
  return sum / ((2 * r + 1) * (2 * r + 1));
}

// A folder of its own for a test's files, removed at the end.
struct OwnFolder {
  std::filesystem::path path;
  OwnFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "trocar-render-XXXXXX").string();
    if (mkdtemp(name.data())) path = name;
  }
  ~OwnFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::string file(const std::string& name) const { return (path / name).string(); }
};

// An environment variable with another value for a while.
struct WithVariable {
  std::string name, before;
  WithVariable(const std::string& n, const std::string& value) : name(n) {
    if (const char* old = std::getenv(n.c_str())) before = old;
    setenv(n.c_str(), value.c_str(), 1);
  }
  ~WithVariable() { setenv(name.c_str(), before.c_str(), 1); }
};

}  // namespace trocar::testing
