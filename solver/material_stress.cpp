#include "solver/material_stress.h"

#include "solver/law_of_material.h"

namespace trocar {

Mat3 first_piola_stress(const Material& material, const Vec3& fibre, const Mat3& H) {
  Tensor<double> gradient{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) gradient.v[i][j] = H(i, j);
  Mat3 P = Mat3::Zero();
  with_law_of(material, fibre, [&]<class Law>(std::type_identity<Law>, const auto& values) {
    const Tensor<double> stress = Law::stress(gradient, values);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P(i, j) = stress.v[i][j];
  });
  return P;
}

}  // namespace trocar
