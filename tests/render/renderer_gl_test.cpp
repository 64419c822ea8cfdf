#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "error_of.h"
#include "larger_or_nan.h"
#include "largest.h"
#include "render/renderer.h"
#include "render_scene.h"

using namespace trocar;
using namespace trocar::testing;

namespace {

// A bent sheet with a cut part, a probe in front of it: all that is drawn takes part.
struct FullScene {
  Sheet sheet = make_sheet(0.1, 12);
  TriangleMesh probe = make_capsule_surface(Vec3(0, 0, 0.005), Vec3(0.01, 0.01, 0.06), 0.004, 16);
  SceneView view;
  FullScene() {
    for (Vec3& p : sheet.x) p.z() = -2 * p.squaredNorm();
    for (std::size_t t = 0; t < 40; ++t) sheet.is_cut[t] = 1;
    view.camera = camera_above(0.15);
    view.tissue = view_of(sheet);
    view.instruments.push_back({.shape = &probe});
    view.caption = "t = 1.00 s";
  }
};

std::string digest_with_threads(const std::string& n_threads) {
  const TestFolder folder;
  const std::string file = folder.file("digest");
  const pid_t child = fork();
  if (child == 0) {
    setenv("LP_NUM_THREADS", n_threads.c_str(), 1);
    setenv("TROCAR_TEST_DIGEST_FILE", file.c_str(), 1);
    if (!std::freopen("/dev/null", "w", stdout)) _exit(1);
    execl("/proc/self/exe", "test_render", "--gtest_filter=RendererChild.*",
          "--gtest_also_run_disabled_tests", static_cast<char*>(nullptr));
    _exit(1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  std::ifstream in(file);
  std::string digest;
  in >> digest;
  return digest;
}

// One renderer of 160 x 120 for all tests that need no size of their own: making one takes longest.
class Picture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { renderer = std::make_unique<Renderer>(160, 120); }
  static void TearDownTestSuite() { renderer.reset(); }
  static Image draw(const SceneView& scene) {
    Image image;
    renderer->draw(scene, image);
    return image;
  }
  static std::unique_ptr<Renderer> renderer;
};
std::unique_ptr<Renderer> Picture::renderer;

int difference(const Image& a, const Image& b, int x, int y) {
  int largest = 0;
  for (int c = 0; c < 3; ++c) {
    const int k = (y * a.width + x) * 3 + c;
    largest = larger_or_nan(largest, std::abs(a.rgb[k] - b.rgb[k]));
  }
  return largest;
}

}  // namespace

// Run by the thread test below in a process of its own.
TEST(RendererChild, DISABLED_writes_the_digest_of_a_picture) {
  const char* file = std::getenv("TROCAR_TEST_DIGEST_FILE");
  ASSERT_NE(file, nullptr);
  const Image image = draw_once(FullScene().view, 320, 200);
  std::uint64_t h = 1469598103934665603u;  // FNV-1a
  for (const std::uint8_t byte : image.rgb) h = (h ^ byte) * 1099511628211u;
  std::ofstream(file) << h << "\n";
}

TEST(Renderer, same_picture_for_any_number_of_threads) {
  const std::string alone = digest_with_threads("0");
  EXPECT_FALSE(alone.empty());
  EXPECT_EQ(alone, digest_with_threads("1"));
  EXPECT_EQ(alone, digest_with_threads("2"));
}

TEST(Renderer, same_scene_gives_the_same_picture_again) {
  const FullScene scene;
  Renderer renderer(160, 120);
  Image first, between, again;
  renderer.draw(scene.view, first);
  renderer.draw({.camera = camera_above(1)}, between);
  renderer.draw(scene.view, again);
  EXPECT_EQ(first.rgb, again.rgb);
  EXPECT_NE(first.rgb, between.rgb);
}

// The left half of a sheet is a blue region, inside and out.
TEST(Renderer, each_region_has_its_colours) {
  for (const bool is_cut : {false, true}) {
    const Sheet sheet = make_sheet(0.1, 12, is_cut);
    std::vector<std::int32_t> region;
    for (const auto& triangle : sheet.triangle)
      region.push_back((sheet.x[triangle[0]] + sheet.x[triangle[1]] + sheet.x[triangle[2]]).x() <
                       0);
    SceneView scene{.camera = camera_above(0.15)};
    scene.tissue = view_of(sheet);
    scene.tissue.region = region;
    scene.tissue.look.colours = {{}, {.outer = {0.02, 0.1, 0.6}, .cut = {0.02, 0.1, 0.6}}};
    const Image image = draw_once(scene);
    constexpr int red = 0, blue = 2;
    EXPECT_GT(mean_level(image, 60, 60, 10, blue), 1.5 * mean_level(image, 60, 60, 10, red));
    EXPECT_GT(mean_level(image, 100, 60, 10, red), 1.5 * mean_level(image, 100, 60, 10, blue));
  }
}

TEST(Renderer, two_of_different_size_live_side_by_side) {
  const FullScene scene;
  Renderer small(64, 48), large(160, 120);
  Image a, b, c;
  small.draw(scene.view, a);
  large.draw(scene.view, b);
  small.draw(scene.view, c);
  EXPECT_EQ(a.rgb, c.rgb);
  EXPECT_EQ(b.width, 160);
  EXPECT_EQ(b.rgb.size(), 160u * 120 * 3);
}

// A corner at (X, Y, 0) seen from height d is at pixel (w/2 + h/2 X / (d tan), h/2 - h/2 Y / (d
// tan)).
TEST(Renderer, triangle_covers_the_pixels_of_its_projection) {
  const int w = 200, h = 150;
  const std::vector<Vec3> x = {{-0.05, -0.04, 0}, {0.06, -0.03, 0}, {-0.01, 0.05, 0}};
  const Triangles triangle = {{0, 1, 2}};
  SceneView scene{.camera = camera_above(0.2)};
  const Image empty = draw_once(scene, w, h);
  scene.tissue = {.x = x, .X = x, .triangle = triangle};
  const Image image = draw_once(scene, w, h);
  const double f = 0.5 * h / (0.2 * std::tan(0.45));
  std::array<Vec2, 3> p;
  for (int k = 0; k < 3; ++k) p[k] = Vec2(0.5 * w + f * x[k].x(), 0.5 * h - f * x[k].y());
  int n_inside = 0;
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      double inside = 1e9;  // distance from the nearest edge, positive inside
      for (int k = 0; k < 3; ++k) {
        const Vec2 a = p[k], e = (p[(k + 1) % 3] - a).normalized(), q = Vec2(i + 0.5, j + 0.5) - a;
        inside = std::min(inside, e.y() * q.x() - e.x() * q.y());
      }
      // One pixel of antialiasing; the tissue is at least 12 levels brighter than the cavity behind
      // it.
      if (inside > 1) {
        EXPECT_GE(difference(image, empty, i, j), 12) << i << " " << j;
      }
      // The highlights' glow reaches over the edge by a few levels.
      if (inside < -1) {
        EXPECT_LE(difference(image, empty, i, j), 5) << i << " " << j;
      }
      n_inside += inside > 1;
    }
  EXPECT_GT(n_inside, 2000);
}

TEST_F(Picture, rows_come_from_the_top) {
  const Sheet sheet = make_sheet(0.04, 2);
  Sheet high = sheet;
  for (Vec3& p : high.x) p.y() += 0.05;
  SceneView scene{.camera = camera_above(0.2)};
  const Image empty = draw(scene);
  scene.tissue = view_of(high);
  const Image image = draw(scene);
  EXPECT_GT(difference(image, empty, 80, 25), 12);
  EXPECT_LT(difference(image, empty, 80, 95), 5);
}

TEST_F(Picture, cut_face_looks_different_from_the_outer_surface) {
  const Sheet outer = make_sheet(0.2, 4), cut = make_sheet(0.2, 4, true);
  SceneView scene{.camera = camera_above(0.15)};
  scene.tissue = view_of(outer);
  const Image a = draw(scene);
  scene.tissue = view_of(cut);
  const Image b = draw(scene);
  double change = 0;
  for (int c = 0; c < 3; ++c)
    change += std::abs(mean_level(a, 80, 60, 40, c) - mean_level(b, 80, 60, 40, c));
  EXPECT_GT(change, 15);  // three levels of grey that nobody overlooks
}

TEST_F(Picture, nothing_to_show_is_the_cavity_not_a_black_void) {
  const Image image = draw({.camera = camera_above(0.2)});
  EXPECT_GT(mean_level(image, 80, 60, 40, 0), 10);
  EXPECT_GT(mean_level(image, 80, 60, 40, 0), 1.5 * mean_level(image, 80, 60, 40, 2));  // reddish
}

TEST_F(Picture, instrument_casts_a_shadow_on_tissue) {
  const Sheet sheet = make_sheet(0.3, 4);
  SceneView scene{.camera = camera_above(0.2)};
  scene.tissue = view_of(sheet);
  const Image lit = draw(scene);
  // The lamp stands at (+0.06, +0.044, 0.2): a ball at (0, 0, 0.05) throws its shadow round (-0.02,
  // -0.0147, 0).
  const TriangleMesh ball = make_sphere_surface(Vec3(0, 0, 0.05), 0.008, 24);
  scene.instruments.push_back({.shape = &ball});
  const Image shaded = draw(scene);
  const double f = 60 / (0.2 * std::tan(0.45));
  const int x = static_cast<int>(80 - 0.02 * f), y = static_cast<int>(60 + 0.0147 * f);
  EXPECT_LT(mean_level(shaded, x, y, 1, 0), 0.8 * mean_level(lit, x, y, 1, 0));
}

TEST_F(Picture, pattern_sticks_to_the_reference_position) {
  const Sheet sheet = make_sheet(0.2, 4);
  Sheet moved = sheet;
  const Vec3 step(0.25, -0.5, 0.125);  // exact in binary
  for (Vec3& p : moved.x) p += step;
  SceneView scene{.camera = camera_above(0.125)};
  scene.tissue = view_of(sheet);
  const Image a = draw(scene);
  scene.tissue.x = moved.x;
  scene.camera.eye += step;
  scene.camera.target += step;
  const Image b = draw(scene);
  // Single precision of positions times steep highlights.
  EXPECT_LE(largest_difference(a.rgb, b.rgb), 4);
}

TEST_F(Picture, plane_tissue_is_seen_from_below_and_closed_tissue_is_not) {
  const Sheet sheet = make_sheet(0.05, 2);
  SceneView scene{.camera = camera_above(-0.2)};
  const Image empty = draw(scene);
  scene.tissue = view_of(sheet);
  EXPECT_EQ(draw(scene).rgb, empty.rgb);
  scene.tissue.is_two_sided = true;
  EXPECT_GT(difference(draw(scene), empty, 80, 60), 12);
}

TEST_F(Picture, element_edges_darken_their_pixels_only) {
  const Sheet sheet = make_sheet(0.2, 2);  // edges along x = 0 and y = 0, and one diagonal
  SceneView scene{.camera = camera_above(0.2)};
  scene.tissue = view_of(sheet);
  scene.tissue.is_two_sided = true;
  const Image plain = draw(scene);
  scene.tissue.has_edges = true;
  const Image edged = draw(scene);
  EXPECT_LT(mean_level(edged, 80, 30, 0, 0), 0.85 * mean_level(plain, 80, 30, 0, 0));
  EXPECT_NEAR(mean_level(edged, 100, 30, 1, 0), mean_level(plain, 100, 30, 1, 0), 3);
}

TEST(Renderer, endoscope_shows_a_round_picture_on_black) {
  SceneView scene{.camera = camera_above(0.2)};
  const Image open = draw_once(scene, 320, 180);
  scene.camera.has_endoscope_mask = true;
  const Image round = draw_once(scene, 320, 180);
  EXPECT_GT(mean_level(open, 8, 90, 4, 0), 3);
  EXPECT_LT(mean_level(round, 8, 90, 4, 0), 1);
  EXPECT_GT(mean_level(round, 160, 90, 4, 0), 0.9 * mean_level(open, 160, 90, 4, 0));
}

// Its glow looks beyond what the mask leaves, where another camera's picture was.
TEST(Renderer, endoscope_shows_the_same_whatever_was_drawn_before) {
  const Sheet sheet = make_sheet(2, 2);
  SceneView scene{.camera = camera_above(0.2)};
  scene.tissue = view_of(sheet);
  SceneView bright = scene;
  bright.tissue.look.colours[0].outer = Vec3(30, 30, 30);  // as highlights are
  scene.camera.has_endoscope_mask = true;
  Renderer renderer(320, 200);
  Image first, other, again;
  renderer.draw(scene, first);
  renderer.draw(bright, other);
  renderer.draw(scene, again);
  EXPECT_NE(other.rgb, first.rgb);
  EXPECT_EQ(again.rgb, first.rgb);
}

TEST_F(Picture, caption_changes_the_lower_left_corner_only) {
  SceneView scene{.camera = camera_above(0.2)};
  const Image plain = draw(scene);
  scene.caption = "Hi";
  const Image named = draw(scene);
  int n_changed = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      if (difference(plain, named, x, y) == 0) continue;
      EXPECT_TRUE(x < 20 && y >= 105) << x << " " << y;
      ++n_changed;
    }
  EXPECT_GT(n_changed, 20);
}

TEST_F(Picture, positions_that_are_not_finite_drop_their_triangles_only) {
  Sheet sheet = make_sheet(0.2, 4);
  SceneView scene{.camera = camera_above(0.2)};
  scene.tissue = view_of(sheet);
  const Image whole = draw(scene);
  sheet.x[0] = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  sheet.x[1].x() = std::numeric_limits<double>::infinity();
  sheet.x[2].y() = 1e300;
  const Image torn = draw(scene);
  EXPECT_NE(whole.rgb, torn.rgb);
  EXPECT_LE(difference(whole, torn, 110, 40), 3);  // the far corner of the sheet
}

TEST_F(Picture, empty_tissue_and_all_nan_are_drawn_as_nothing) {
  SceneView scene{.camera = camera_above(0.2)};
  const Image empty = draw(scene);
  const Sheet seen = make_sheet(0.2, 1);
  scene.tissue = view_of(seen);
  EXPECT_NE(draw(scene).rgb, empty.rgb);
  scene.tissue = {};
  const TriangleMesh no_shape;
  scene.instruments.push_back({.shape = &no_shape});
  EXPECT_EQ(draw(scene).rgb, empty.rgb);
  Sheet sheet = make_sheet(0.2, 1);
  for (Vec3& p : sheet.x) p.setConstant(std::numeric_limits<double>::quiet_NaN());
  scene.tissue = view_of(sheet);
  EXPECT_EQ(draw(scene).rgb, empty.rgb);
}

TEST(Renderer, smallest_and_odd_pictures_are_drawn) {
  const FullScene scene;
  for (const auto& [w, h] : {std::pair{1, 1}, std::pair{3, 1}, std::pair{17, 33}}) {
    const Image image = draw_once(scene.view, w, h);
    EXPECT_EQ(image.rgb.size(), std::size_t{3} * w * h);
  }
}

TEST(Renderer, impossible_sizes_and_cameras_are_refused_with_a_sentence) {
  for (const auto& [w, h] :
       {std::pair{0, 0}, std::pair{-1, 100}, std::pair{100, 8193}, std::pair{16384, 16384}}) {
    const auto renderer = [w = w, h = h] { Renderer(w, h); };
    EXPECT_TRUE(contains(error_of(renderer), "1 to 8192")) << w << " x " << h;
  }
  Renderer renderer(32, 32);
  Image image;
  SceneView scene;
  scene.camera.eye = scene.camera.target;
  EXPECT_THROW(renderer.draw(scene, image), InputError);
  scene.camera = camera_above(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(renderer.draw(scene, image), InputError);
  scene.camera = camera_above(1);
  scene.camera.field_of_view = 4;
  EXPECT_THROW(renderer.draw(scene, image), InputError);
}

TEST(Renderer, it_says_that_it_is_available_here) {
  std::string reason;
  EXPECT_TRUE(renderer_available(reason)) << reason;
}
