// Set-up of the four-node tetrahedra.
#include "solver/element_setup.h"
#include "solver/element_tet4.h"

namespace trocar {

ElementConstants constants_tet4(const ElementInput& input) {
  const Vec3 d1 = input.X[1] - input.X[0], d2 = input.X[2] - input.X[0];
  const Vec3 d3 = input.X[3] - input.X[0];
  const double det = d1.dot(d2.cross(d3));
  ElementConstants c{.volume = det / 6};
  if (!(c.volume > 0)) return c;
  const std::array<Vec3, 3> B = {d2.cross(d3) / det, d3.cross(d1) / det, d1.cross(d2) / det};
  SymmetricTensor<double> G{};
  add_gradient(-(B[0] + B[1] + B[2]), G);
  for (std::size_t a = 0; a < 3; ++a) {
    add_gradient(B[a], G);
    for (std::size_t j = 0; j < 3; ++j)
      c.value[ElementTet4::value_B + 3 * a + j] = B[a][static_cast<Eigen::Index>(j)];
  }
  c.omega2 = frequency_bound(G, 4, input);
  return c;
}

// Averages of volume changes hold no more energy than the changes themselves (Jensen), so that the
// bound of the plain tetrahedron holds.
ElementConstants constants_tet4_nodal_pressure(const ElementInput& input) {
  return constants_tet4(input);
}

}  // namespace trocar
