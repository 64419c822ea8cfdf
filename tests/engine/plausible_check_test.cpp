// Units that slipped are told when a scene is loaded.
#include "engine/plausible_check.h"

#include <gtest/gtest.h>

#include "base/options.h"
#include "engine/scene.h"
#include "engine_started.h"

namespace trocar {
namespace {

std::string implausible_in(const Scene& scene) {
  testing::internal::CaptureStderr();
  warn_of_implausible(scene);
  return testing::internal::GetCapturedStderr();
}

bool tells(const Scene& scene, const std::string& sentence) {
  return implausible_in(scene).find(sentence) != std::string::npos;
}

TEST(PlausibleCheck, scenes_of_tissue_are_not_warned_of) {
  Scene scene;
  scene.solver.gravity = Vec3(0, 0, -9.81);
  scene.instruments = {{.name = "probe", .path = {{.time = 0}, {.time = 0.1}}}};
  scene.instruments[0].path[1].position = Vec3(0.9, 0, 0);  // 9 m/s
  EXPECT_EQ(implausible_in(scene), "");
}

TEST(PlausibleCheck, warns_of_densities_of_another_unit_in_every_material) {
  Scene scene;
  scene.tissue.region_materials.resize(1);
  const auto path = [](const std::string& key) { return key + ".density: 1.06"; };
  scene.tissue.material.density = 1060e3;  // 1060 g/cm^3
  EXPECT_TRUE(tells(scene, path("tissue.material")));
  EXPECT_FALSE(tells(scene, "region_material"));
  scene.tissue.region_materials[0].material.density = 1.06;
  EXPECT_TRUE(tells(scene, path("tissue.region_material[0].material")));
}

TEST(PlausibleCheck, warns_of_gravity_in_millimetres) {
  Scene scene;
  scene.solver.gravity = Vec3(0, 0, -9810);
  EXPECT_TRUE(tells(scene, "solver.gravity: 9.81e+03 m/s^2, while the Earth's is 9.81"));
}

TEST(PlausibleCheck, warns_of_keys_that_are_too_close_in_time) {
  Scene scene;
  scene.instruments = {{.name = "knife", .path = {{.time = 0}, {.time = 1e-3}}}};
  scene.instruments[0].path[1].position = Vec3(0, 0.12, 0);
  EXPECT_TRUE(tells(scene, "instrument[0].path[1]: \"knife\" goes 120 mm in 1 ms, at 120 m/s"));
  scene.instruments.clear();
  scene.supports = {{.region = "z-", .path = {{.time = 0}, {.time = 1e-3}}}};
  scene.supports[0].path[1].displacement = Vec3(0, 0, 0.02);
  EXPECT_TRUE(tells(scene, "support[0].path[1]: \"z-\" goes 20 mm in 1 ms, at 20 m/s"));
}

// Of tissue so stiff that a frame of a second takes this many steps.
std::string warnings_of_steps(double n) {
  const auto block = block_of("tet4-five");
  const Simulation& s = *block->s;
  const double n_soft = 1 / (s.step_factor * s.watch.stable_step);
  const double young_modulus = 3000 * (n / n_soft) * (n / n_soft);
  testing::internal::CaptureStderr();
  built(echo_options(scene_options(), &s.scene),
        {"time.frame_rate=1", "tissue.material.young_modulus=" + std::to_string(young_modulus)});
  return testing::internal::GetCapturedStderr();
}

TEST(PlausibleCheck, warns_of_more_than_ten_thousand_steps_a_frame) {
  EXPECT_EQ(warnings_of_steps(9000).find("a frame needs"), std::string::npos);
  EXPECT_NE(warnings_of_steps(12000).find("a frame needs 1.2e+04 steps, because element"),
            std::string::npos);
}

}  // namespace
}  // namespace trocar
