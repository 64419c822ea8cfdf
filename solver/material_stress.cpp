#include "solver/material_stress.h"

#include <array>

#include "solver/block_data.h"
#include "solver/material_list.h"
#include "solver/material_setup.h"

namespace trocar {

// Of an element of the volume 1, in the first lane of its block.
template <class Law>
static Mat3 stress_of(const Material& material, const Vec3& fibre, const Mat3& H) {
  std::array<double, std::size_t{max_material_values} * block_lanes<double>> number{};
  std::array<double, max_material_values> value{};
  fill_material(material, 1, fibre, value);
  for (std::size_t k = 0; k < value.size(); ++k) number[k * block_lanes<double>] = value[k];
  Tensor<double> gradient{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) gradient.v[i][j] = H(i, j);
  const Tensor<double> stress = Law::stress(gradient, BlockValues<double>{number.data()});
  Mat3 P;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) P(i, j) = stress.v[i][j];
  return P;
}

template <class... Laws>
static Mat3 stress_of(const Material& material, const Vec3& fibre, const Mat3& H,
                      TypeList<Laws...>) {
  Mat3 P = Mat3::Zero();
  ((Laws::model == material.model ? static_cast<void>(P = stress_of<Laws>(material, fibre, H))
                                  : static_cast<void>(0)),
   ...);
  return P;
}

Mat3 first_piola_stress(const Material& material, const Vec3& fibre, const Mat3& H) {
  return stress_of(material, fibre, H, MaterialList{});
}

}  // namespace trocar
