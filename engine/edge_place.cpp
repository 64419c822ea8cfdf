#include "engine/edge_place.h"

#include <cmath>

namespace trocar {

// Columns: three edges, of a hexahedron the means of four parallel ones, of a triangle two and the
// plane's normal.
static Mat3 axes_of(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x) {
  const auto corner = mesh.corners(e);
  const auto at = [&](std::size_t a) { return x[corner[a]]; };
  Mat3 axes;
  if (corner.size() == 8)
    axes << at(1) - at(0) + at(2) - at(3) + at(5) - at(4) + at(6) - at(7),
        at(3) - at(0) + at(2) - at(1) + at(7) - at(4) + at(6) - at(5),
        at(4) - at(0) + at(5) - at(1) + at(6) - at(2) + at(7) - at(3);
  else
    axes << at(1) - at(0), at(2) - at(0), corner.size() == 4 ? Vec3(at(3) - at(0)) : Vec3::UnitZ();
  return corner.size() == 8 ? Mat3(axes / 4) : axes;
}

// By Newton's way: every machine gives the same bits, which std::cbrt does not promise.
static double cube_root(double x) {
  if (!(x > 0)) return 0;
  int exponent = 0;
  std::frexp(x, &exponent);
  double root = std::ldexp(1.0, exponent / 3);  // within a factor of 2
  for (int k = 0; k < 6; ++k) root = (2 * root + x / (root * root)) / 3;
  return root;
}

EdgePlace place_of(const Mesh& mesh, std::span<const Vec3> x, const Location& at, const Vec3& along,
                   const Vec3& ahead) {
  const Mat3 dX = axes_of(mesh, at.element, mesh.X);
  const Mat3 back = dX * axes_of(mesh, at.element, x).inverse();
  const double volume = std::abs(dX.determinant());
  return {.X = interpolate(mesh, at, mesh.X),
          .along = (back * along).normalized(),
          .ahead = (back * ahead).normalized(),
          .size = mesh.dimension() == 2 ? std::sqrt(volume) : cube_root(volume)};
}

}  // namespace trocar
