// The law of a material that is known at run time only, for what asks it once and not in kernels.
#pragma once

#include <array>
#include <type_traits>

#include "solver/block_data.h"
#include "solver/material_list.h"
#include "solver/material_setup.h"

namespace trocar {

// Calls body(std::type_identity<Law>, values): the constants are those of an element of the volume
// 1 with this direction of fibres, in the first lane of its block.
template <class Body, class... Laws>
void with_law_of(const Material& material, const Vec3& fibre, const Body& body,
                 TypeList<Laws...> /*laws*/) {
  std::array<double, std::size_t{max_material_values} * block_lanes<double>> number{};
  std::array<double, max_material_values> value{};
  fill_material(material, 1, fibre, value);
  for (std::size_t k = 0; k < value.size(); ++k) number[k * block_lanes<double>] = value[k];
  const BlockValues<double> values{number.data()};
  ((Laws::model == material.model ? body(std::type_identity<Laws>{}, values) : void()), ...);
}

template <class Body>
void with_law_of(const Material& material, const Vec3& fibre, const Body& body) {
  with_law_of(material, fibre, body, MaterialList{});
}

}  // namespace trocar
