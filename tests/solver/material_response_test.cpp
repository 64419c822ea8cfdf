#include "solver/material_response.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

// W' = c1 + 2 c2 x of I1 - 3 = x: in simple shear by g, x = g^2, the stress is 2 g (c1 + 2 c2 g^2),
// which falls beyond g = sqrt(c1 / (6 |c2|)).
TEST(MaterialResponse, yeoh_with_a_negative_c2_falls_where_its_stress_has_its_maximum) {
  Material material{.model = MaterialModel::yeoh, .c1 = 900, .c2 = -900.0 / (6 * 0.4 * 0.4)};
  // In tension with x = s^2 + 2/s - 3 the maximum of 2 (s - 1/s^2) (c1 + 2 c2 x) comes first.
  const auto stress = [&](double s) {
    return (s - 1 / (s * s)) * (material.c1 + 2 * material.c2 * (s * s + 2 / s - 3));
  };
  double s = 1;
  while (stress(s + 1e-4) > stress(s)) s += 1e-4;
  const std::string sentence = softening_of(material);
  ASSERT_TRUE(sentence.starts_with("its stress falls beyond a stretch of ")) << sentence;
  // Within the step of the search and three digits.
  EXPECT_NEAR(std::stod(sentence.substr(sentence.rfind(' '))), s, 0.5 / 80 + 0.005);
}

TEST(MaterialResponse, of_sound_constants_is_none) {
  for (const MaterialModel model :
       {MaterialModel::neo_hookean, MaterialModel::transversely_isotropic,
        MaterialModel::holzapfel_gasser_ogden})
    EXPECT_EQ(softening_of({.model = model, .eta = 1000, .k1 = 1000, .k2 = 5}), "");
  EXPECT_EQ(softening_of({.model = MaterialModel::mooney_rivlin, .c10 = 300, .c01 = 200}), "");
  EXPECT_EQ(softening_of({.model = MaterialModel::yeoh, .c1 = 900, .c2 = 300, .c3 = 10}), "");
  EXPECT_EQ(softening_of({.model = MaterialModel::ogden, .ogden = {{{500, 8}, {500, -4}}}}), "");
}

TEST(MaterialResponse, of_linear_laws_is_not_asked_for) {
  EXPECT_EQ(softening_of({.model = MaterialModel::st_venant_kirchhoff}), "");
  EXPECT_EQ(softening_of({.model = MaterialModel::linear}), "");
}

}  // namespace
}  // namespace trocar
