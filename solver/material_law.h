// A material bound to the constants of a pack's worth of elements: what elements ask for stress.
#pragma once

#include "solver/block_data.h"
#include "solver/deformation.h"
#include "solver/tensor.h"

namespace trocar {

template <class MaterialType, class Pack>
struct Law {
  using Material = MaterialType;
  BlockValues<Pack> value;

  // The strain that the others want, from that of the element.
  [[gnu::always_inline]] Tensor<Pack> full_strain(const Tensor<Pack>& H) const { return H; }
  // First Piola-Kirchhoff stress times the element's volume. [J]
  [[gnu::always_inline]] Tensor<Pack> stress(const Tensor<Pack>& H) const {
    return Material::stress(H, value);
  }
  // And at a pressure (times the volume) that others determine, if Material::is_decoupled.
  [[gnu::always_inline]] Tensor<Pack> stress(const Deformation<Pack>& d) const {
    return Material::stress(d, value);
  }
  [[gnu::always_inline]] Tensor<Pack> stress_at_pressure(const Deformation<Pack>& d,
                                                         const Pack& pressure) const {
    return Material::stress_at(d, pressure, value);
  }
  // Strain energy times the element's volume. [J]
  [[gnu::noinline]] Pack energy(const Tensor<Pack>& H) const { return Material::energy(H, value); }
  // Its part that doesn't depend on J, if Material::is_decoupled.
  [[gnu::noinline]] Pack isochoric_energy(const Tensor<Pack>& H) const {
    return Material::isochoric_energy(H, value);
  }
  // Growth of the bound of omega^2 (stiffening.h), for all kinds of law.
  [[gnu::noinline]] Pack stiffening(const Tensor<Pack>& H) const {
    return Material::stiffening(H, value);
  }
};

}  // namespace trocar
