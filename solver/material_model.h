// Names of the material laws; material_<name>.h has the formulas.
#pragma once

#include <cstdint>

namespace trocar {

enum class MaterialModel : std::uint8_t {
  linear,
  st_venant_kirchhoff,
  neo_hookean,
  mooney_rivlin,
  yeoh,
  ogden,
  transversely_isotropic,
  holzapfel_gasser_ogden
};

}  // namespace trocar
