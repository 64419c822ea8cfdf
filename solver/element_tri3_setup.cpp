// Set-up of the triangles.
#include "solver/element_setup.h"
#include "solver/element_tri3.h"
#include "solver/element_tri3_plane_stress.h"

namespace trocar {

ElementConstants constants_tri3(const ElementInput& input) {
  const Vec3 d1 = input.X[1] - input.X[0], d2 = input.X[2] - input.X[0];
  const double det = d1.x() * d2.y() - d1.y() * d2.x();
  ElementConstants c{.volume = 0.5 * det * input.thickness};
  if (!(c.volume > 0)) return c;
  const Vec3 B1 = Vec3(d2.y(), -d2.x(), 0) / det, B2 = Vec3(-d1.y(), d1.x(), 0) / det;
  SymmetricTensor<double> G{};
  for (const Vec3& B : {B1, B2, Vec3(-B1 - B2)}) add_gradient(B, G);
  for (int j = 0; j < 2; ++j) {
    c.value[ElementTri3::value_B + j] = B1[j];
    c.value[ElementTri3::value_B + 2 + j] = B2[j];
  }
  c.omega2 = frequency_bound(G, 3, input);
  return c;
}

ElementConstants constants_tri3_plane_stress(const ElementInput& input) {
  ElementConstants c = constants_tri3(input);
  const double stiffness = input.lambda + 2 * input.mu;
  c.value[ElementTri3PlaneStress::value_ratio] = input.lambda / stiffness;
  c.value[ElementTri3PlaneStress::value_compliance] = 1 / (stiffness * c.volume);
  return c;
}

}  // namespace trocar
