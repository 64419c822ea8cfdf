// Materials of scenes: what belongs to which model, tissues by name, the generated page.
#include "engine/scene_material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "engine/tissue_table.h"
#include "engine_scene.h"

namespace trocar {
namespace {

std::string with_material(const std::string& lines) {
  return scene_text("[tissue.material]\n" + lines);
}

Material material_of_scene(const std::string& lines) {
  return to_material(load_scene_text(with_material(lines)).tissue.material);
}

TEST(SceneMaterial, parameters_of_each_model_reach_the_solver) {
  const Material mr = material_of_scene(
      "model = \"mooney-rivlin\"\nc10 = \"0.3 kPa\"\nc01 = \"0.2 kPa\"\npoisson_ratio = 0.4\n");
  EXPECT_DOUBLE_EQ(lame_mu(mr), 1000);
  EXPECT_DOUBLE_EQ(bulk_modulus(mr), 2 * 1000 * 1.4 / (3 * .2));
  const Material yeoh = material_of_scene("model = \"yeoh\"\nc1 = 500\nc2 = \"-0.1 kPa\"\n");
  EXPECT_DOUBLE_EQ(lame_mu(yeoh), 1000);
  EXPECT_DOUBLE_EQ(yeoh.c2, -100);
  const Material ogden = material_of_scene(
      "model = \"ogden\"\nogden = [{mu = \"1 kPa\", alpha = 2}, {mu = 500, alpha = -8}]\n");
  EXPECT_DOUBLE_EQ(lame_mu(ogden), 1500);
  EXPECT_EQ(ogden.ogden[1].alpha, -8);
  const Material hgo = material_of_scene(
      "model = \"holzapfel-gasser-ogden\"\nk1 = \"2 kPa\"\nk2 = 5\nkappa = 0.1\n"
      "fibre_angle = \"30 deg\"\nfibre = [0, 1, 0]\n");
  EXPECT_DOUBLE_EQ(hgo.k1, 2000);
  EXPECT_NEAR(hgo.fibre_angle, std::acos(-1.) / 6, 1e-15);
  EXPECT_EQ(hgo.fibre, Vec3(0, 1, 0));
  const Material relaxing =
      material_of_scene("prony = [{share = 0.3, time = \"0.5 s\"}, {share = 0.2, time = 10}]\n");
  ASSERT_EQ(relaxing.prony.size(), 2U);
  EXPECT_EQ(relaxing.prony[0].time, 0.5);
  EXPECT_EQ(relaxing.prony[1].share, 0.2);
}

TEST(SceneMaterial, a_parameter_of_another_model_or_a_missing_one_is_refused_with_a_sentence) {
  const auto error = [](const std::string& lines) { return scene_error(with_material(lines)); };
  EXPECT_TRUE(contains(error("c10 = 300\n"), "c10 is no parameter of model neo-hookean"));
  EXPECT_TRUE(contains(error("model = \"yeoh\"\nc1 = 1\nyoung_modulus = 3000\n"),
                       "young_modulus is no parameter of model yeoh"));
  EXPECT_TRUE(contains(error("model = \"yeoh\"\n"), "needs c1"));
  EXPECT_TRUE(contains(error("model = \"ogden\"\n"), "needs terms"));
  EXPECT_TRUE(contains(error("ogden = [{mu = 1, alpha = 2}]\n"), "belong to model ogden"));
  EXPECT_TRUE(contains(error("prony = [{share = 0.7, time = 1}, {share = 0.7, time = 2}]\n"),
                       "more than 1"));
  EXPECT_TRUE(contains(error("tissue = \"livre\"\n"), "\"liver\""));
  EXPECT_TRUE(contains(error("tissue = \"liver\"\nmodel = \"ogden\"\n"), "yeoh"));
}

TEST(SceneMaterial, a_tissue_can_be_had_without_its_relaxation) {
  const std::string liver = "tissue = \"liver\"\n", elastic = liver + "prony = []\n";
  ASSERT_FALSE(material_of_scene(liver).prony.empty());
  EXPECT_TRUE(material_of_scene(elastic).prony.empty());
  const Scene scene = load_scene_text(with_material(elastic));
  const Scene again = load_scene_text(echo_options(scene_options(), &scene));
  EXPECT_TRUE(again.tissue.material.prony.empty());
}

TEST(SceneMaterial, every_tissue_can_be_named_changed_and_echoed) {
  for (const Tissue& tissue : tissue_table()) {
    const std::string line = "tissue = \"" + std::string(tissue.name) + "\"\n";
    const Scene scene = load_scene_text(with_material(line));
    const Material expected = to_material(tissue.material);
    const Material material = to_material(scene.tissue.material);
    EXPECT_EQ(material.model, expected.model);
    EXPECT_EQ(lame_mu(material), lame_mu(expected));
    EXPECT_EQ(material.prony.size(), expected.prony.size());
    const std::string echo = echo_options(scene_options(), &scene);
    const Scene again = load_scene_text(echo);
    EXPECT_EQ(echo_options(scene_options(), &again), echo);
    EXPECT_EQ(material_of_scene(line + "density = 1234\n").density, 1234);
  }
}

TEST(SceneMaterial, the_page_of_tissues_is_what_the_program_writes) {
  std::ifstream in(TROCAR_SOURCE_DIR "/docs/tissues.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(page, tissues_markdown());  // trocar help tissues --markdown > docs/tissues.md
}

}  // namespace
}  // namespace trocar
