#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "base_scene_options.h"

namespace trocar {
namespace {

std::string echo(const Scene& scene) {
  return echo_options(scene_options(), &scene);
}

void expect_same_bits(double a, double b) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)) << a << " " << b;
}

TEST(Echo, reads_back_to_the_same_bits_for_any_number) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 20000; ++i) {
    Scene scene;
    for (int k = 0; k < 3; ++k) {
      const double value = std::bit_cast<double>(random());
      const double magnitude = std::abs(value);
      if (magnitude >= 1e-24 && magnitude <= 1e24) scene.gravity[k] = value;
    }
    if (i == 0) scene.gravity = Vec3(-0.0, 1.0000000000000002e-24, 9.999999999999999e23);
    if (i == 1) scene.gravity = Vec3(1e22, 123456789012345678.0, 1e-7);
    const Scene again = read_scene(echo(scene)).value;
    for (int k = 0; k < 3; ++k) expect_same_bits(again.gravity[k], scene.gravity[k]);
  }
}

TEST(Echo, reads_back_every_kind_of_option) {
  Scene scene;
  scene.name = "a \"quoted\" \\ text\nwith\ttabs, \x01\x7f and ü";
  scene.is_fast = true;
  scene.duration = 0.1;
  scene.tissue.mesh = "";
  scene.tissue.material.law = Law::linear;
  scene.camera = Camera{.size = {3, 4}};
  scene.instrument.resize(2);
  scene.instrument[0].path.resize(2);
  scene.instrument[0].path[1] = {.time = 0.3, .position = Vec3(1, 2, 3)};
  scene.instrument[1].n_sides = 5;
  const Scene again = read_scene(echo(scene)).value;
  EXPECT_EQ(again.name, scene.name);
  EXPECT_TRUE(again.is_fast);
  EXPECT_EQ(again.duration, 0.1);
  EXPECT_EQ(again.tissue.material.law, Law::linear);
  ASSERT_TRUE(again.camera.has_value());
  EXPECT_EQ(again.camera->size, scene.camera->size);
  ASSERT_EQ(again.instrument.size(), 2u);
  ASSERT_EQ(again.instrument[0].path.size(), 2u);
  EXPECT_EQ(again.instrument[0].path[1].position, Vec3(1, 2, 3));
  EXPECT_EQ(again.instrument[1].n_sides, 5);
  EXPECT_TRUE(again.instrument[1].path.empty());
  EXPECT_EQ(echo(again), echo(scene));
}

TEST(Echo, leaves_out_what_toml_input_refuses) {
  Scene scene;
  ASSERT_TRUE(std::isinf(scene.duration));
  EXPECT_EQ(echo(scene).find("duration"), std::string::npos);
  EXPECT_TRUE(std::isinf(read_scene(echo(scene)).value.duration));
}

TEST(Echo, keeps_an_absent_table_absent) {
  EXPECT_FALSE(read_scene(echo(Scene())).value.camera.has_value());
}

struct Defaulted {
  std::vector<Camera> cameras{Camera{}};
};

TEST(Echo, of_a_list_emptied_against_its_default_stays_empty) {
  Options<Camera> camera("A view.");
  camera.integers("size", &Camera::size, any, "Pixels.");
  Options<Defaulted> options("Views.");
  options.list("camera", &Defaulted::cameras, camera, "The views.");
  const Defaulted none{.cameras = {}};
  Defaulted again;
  SourceMap where;
  read_options_text(options, echo_options(options, &none), "echo", {}, &again, where);
  EXPECT_TRUE(again.cameras.empty());
}

}  // namespace
}  // namespace trocar
