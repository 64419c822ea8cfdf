#include "solver/hex8_reference.h"

#include "mesh/mesh.h"

namespace trocar {

namespace {

double triple(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a.dot(b.cross(c));
}

}  // namespace

int hex_mode_sign(int m, int a) {
  const auto& [x, y, z] = hex_corner_xi[a];
  const int sign[n_hex_modes] = {x, y, z, y * z, z * x, x * y, x * y * z};
  return sign[m];
}

HexModes position_modes(std::span<const Vec3> X) {
  HexModes modes;
  for (int m = 0; m < n_hex_modes; ++m) {
    Vec3& mode = modes[m];
    mode = Vec3::Zero();
    for (int a = 1; a < 8; ++a) mode += hex_mode_sign(m, a) * (X[a] - X[0]);
  }
  return modes;
}

double hexahedron_volume(const HexModes& x) {
  return 8 * (triple(x[0], x[1], x[2]) +
              (triple(x[4], x[3], x[2]) + triple(x[5], x[1], x[3]) + triple(x[0], x[5], x[4])) / 3);
}

HexModes volume_gradient(const HexModes& x) {
  return {x[1].cross(x[2]) + x[5].cross(x[4]) / 3,
          x[2].cross(x[0]) + x[3].cross(x[5]) / 3,
          x[0].cross(x[1]) + x[4].cross(x[3]) / 3,
          (x[2].cross(x[4]) + x[5].cross(x[1])) / 3,
          (x[3].cross(x[2]) + x[0].cross(x[5])) / 3,
          (x[1].cross(x[3]) + x[4].cross(x[0])) / 3,
          Vec3::Zero()};
}

}  // namespace trocar
