// Small surfaces and scenes that several tests of render/ share.
#pragma once

#include <string>

#include "mesh/triangle_mesh.h"
#include "render/renderer.h"
#include "test_files.h"

namespace trocar::testing {

using Triangles = std::vector<std::array<std::int32_t, 3>>;

// A square sheet in z = 0 that looks up, of 2 n^2 triangles.
struct Sheet {
  std::vector<Vec3> x;
  Triangles triangle;
  std::vector<std::uint8_t> is_cut;
};
Sheet make_sheet(double side, int n, bool is_cut = false);

TissueView view_of(const Sheet& s);

Camera camera_above(double height);

Image draw_once(const SceneView& scene, int width = 160, int height = 120);

// Mean of a colour (0 red, 1 green, 2 blue) over the square of (2 r + 1)^2 pixels around one.
double mean_level(const Image& image, int x, int y, int r, int colour);

// An environment variable with another value for a while.
struct WithVariable {
  std::string name, before;
  WithVariable(const std::string& n, const std::string& value);
  ~WithVariable();
};

}  // namespace trocar::testing
