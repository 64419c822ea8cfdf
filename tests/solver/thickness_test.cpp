// The thickness of sheets against the closed form of the linear law.
#include "solver/thickness.h"

#include <gtest/gtest.h>

#include "solver_body.h"

using namespace trocar;

static Body sheet(Formulation formulation, Precision precision) {
  return make_body(make_rectangle(.04, .02, 5, 3),
                   {.materials = {material_of(MaterialModel::linear, 1000, 3000)},
                    .solver = with(formulation, {.precision = precision})});
}

// s33 = lambda (e11 + e22 + e33) + 2 mu e33 = 0, in each of the elements.
TEST(Thickness, of_a_linear_sheet_falls_with_the_strain_in_its_plane) {
  const double mu = 1000, lambda = 3000 - 2 * mu / 3;
  for (const Precision precision : precisions) {
    Body body = sheet(Formulation::tri3_plane_stress, precision);
    displace(body, [](const Vec3& X) {
      return Vec3(.1 * X.x() + 4 * X.x() * X.y(), .05 * X.y() - .2 * X.x(), 0);
    });
    const double rounding = precision == Precision::in_double ? 1e-12 : 1e-5;
    for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
      Eigen::Matrix2d dX, du;
      for (int k = 0; k < 2; ++k) {
        const std::int32_t a = body.mesh.corners(e)[0], b = body.mesh.corners(e)[k + 1];
        for (int j = 0; j < 2; ++j) {
          dX(j, k) = body.mesh.X[b][j] - body.mesh.X[a][j];
          du(j, k) = body.state.u[3 * b + j] - body.state.u[3 * a + j];
        }
      }
      const double e33 = -lambda / (lambda + 2 * mu) * (du * dX.inverse()).trace();
      EXPECT_NEAR(thickness_stretch(body.model, body.state, e), 1 + e33, rounding) << e;
    }
  }
}

TEST(Thickness, of_plane_strain_does_not_change) {
  Body body = sheet(Formulation::tri3_plane_strain, Precision::in_double);
  shake(body.state.u, 1e-3, 3);
  EXPECT_EQ(thickness_stretch(body.model, body.state, 0), 1);
}
