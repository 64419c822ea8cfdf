#include "solver/material_stress.h"

#include <gtest/gtest.h>

#include "solver/material_setup.h"

namespace trocar {
namespace {

Mat3 some_F() {
  Mat3 F;
  F << 1.3, 0.2, -0.1, 0.05, 0.9, 0.15, -0.2, 0.1, 1.1;
  return F;
}

Mat3 cauchy_stress(const Material& material, const Mat3& F) {
  return first_piola_stress(material, unit_fibre(material), F - Mat3::Identity()) * F.transpose() /
         F.determinant();
}

// sigma = mu J^(-5/3) dev B + K (J - 1) I
TEST(MaterialStress, of_a_neo_hookean_solid_is_its_closed_form) {
  const Material material{.young_modulus = 5000, .poisson_ratio = 0.4};
  const double mu = lame_mu(material), K = lame_lambda(material) + 2 * mu / 3;
  const Mat3 F = some_F(), B = F * F.transpose();
  const double J = F.determinant();
  const Mat3 expected = mu * std::pow(J, -5.0 / 3) * (B - B.trace() / 3 * Mat3::Identity()) +
                        K * (J - 1) * Mat3::Identity();
  EXPECT_LT((cauchy_stress(material, F) - expected).norm(), 1e-12 * expected.norm());
}

// That of any model is symmetric, turns with the body and is zero at rest.
TEST(MaterialStress, of_every_model_is_that_of_a_solid) {
  const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  for (const MaterialModel model :
       {MaterialModel::st_venant_kirchhoff, MaterialModel::neo_hookean,
        MaterialModel::mooney_rivlin, MaterialModel::yeoh, MaterialModel::transversely_isotropic,
        MaterialModel::holzapfel_gasser_ogden}) {
    const Material material{.model = model,
                            .c10 = 500,
                            .c01 = 300,
                            .c1 = 700,
                            .c2 = 200,
                            .eta = 4000,
                            .k1 = 3000,
                            .k2 = 2,
                            .kappa = 0.1};
    const Mat3 sigma = cauchy_stress(material, some_F());
    EXPECT_GT(sigma.norm(), 100);
    EXPECT_LT((sigma - sigma.transpose()).norm(), 1e-12 * sigma.norm());
    const Mat3 turned = cauchy_stress(material, turn * some_F());
    EXPECT_LT((turned - turn * sigma * turn.transpose()).norm(), 1e-12 * sigma.norm());
    EXPECT_LT(cauchy_stress(material, Mat3::Identity()).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace trocar
