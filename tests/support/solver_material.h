// Stress and energy of a material alone, at a deformation gradient.
#pragma once

#include <array>

#include "solver/material_list.h"
#include "solver/material_setup.h"
#include "solver_body.h"

namespace trocar {

inline Tensor<double> tensor(const Mat3& A) {
  Tensor<double> T;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) T(i, j) = A(i, j);
  return T;
}

inline Mat3 matrix(const Tensor<double>& T) {
  Mat3 A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) A(i, j) = T(i, j);
  return A;
}

// The constants of the table: mu = 1000 Pa, K = 49000 Pa.
inline constexpr double mu = 1000, K = 49000, lambda = K - 2 * mu / 3;

// The table's material in the first lane of a block, volume 1; fibres along x, the two families in
// the plane of x and y.
template <class M, class Pack = double>
struct BlockOfOne {
  using Real = RealOf<Pack>;
  std::array<Real, static_cast<std::size_t>(M::n_values) * block_lanes<Pack>> number{};
  explicit BlockOfOne(const Material& material = material_of(M::model, mu, K)) {
    std::array<double, M::n_values> value{};
    fill_material(material, 1, Vec3(1, 0, 0), value);
    for (std::size_t k = 0; k < value.size(); ++k)
      number[k * block_lanes<Pack>] = static_cast<Real>(value[k]);
  }
  BlockValues<Pack> values() const { return {number.data()}; }
};

template <class M>
Mat3 stress(const Mat3& F) {
  return matrix(M::stress(tensor(F - Mat3::Identity()), BlockOfOne<M>().values()));
}
template <class M>
double energy(const Mat3& F) {
  return M::energy(tensor(F - Mat3::Identity()), BlockOfOne<M>().values());
}

template <class... Ms, class Body>
void for_each_material(TypeList<Ms...>, const Body& body) {
  (body.template operator()<Ms>(), ...);
}

}  // namespace trocar
