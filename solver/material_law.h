// A material bound to the constants of a pack's worth of elements: what elements ask for stress.
#pragma once

#include "solver/block_data.h"
#include "solver/tensor.h"

namespace trocar {

template <class MaterialType, class Pack>
struct Law {
  using Material = MaterialType;
  BlockValues<Pack> value;

  // First Piola-Kirchhoff stress times the element's volume. [J]
  [[gnu::always_inline]] Tensor<Pack> stress(const Tensor<Pack>& H) const {
    if constexpr (is_short)
      return Material::stress(H, value);
    else
      return long_stress(H);
  }
  // Strain energy times the element's volume. [J]
  [[gnu::noinline]] Pack energy(const Tensor<Pack>& H) const { return Material::energy(H, value); }
  // Their parts that don't depend on J, if Material::is_decoupled.
  [[gnu::always_inline]] Tensor<Pack> isochoric_stress(const Tensor<Pack>& H) const {
    if constexpr (is_short)
      return Material::isochoric_stress(H, value);
    else
      return long_isochoric_stress(H);
  }
  [[gnu::noinline]] Pack isochoric_energy(const Tensor<Pack>& H) const {
    return Material::isochoric_energy(H, value);
  }
  // Growth of the bound of omega^2 (stiffening.h).
  [[gnu::noinline]] Pack stiffening(const Tensor<Pack>& H) const {
    return Material::stiffening(H, value);
  }

 private:
  // Laws with two constants are worth inlining; the code of the others, at every point of every
  // element for every instruction set, made a build of 9 minutes.
  static constexpr bool is_short = Material::n_values == 2;

  [[gnu::noinline]] Tensor<Pack> long_stress(const Tensor<Pack>& H) const {
    return Material::stress(H, value);
  }
  [[gnu::noinline]] Tensor<Pack> long_isochoric_stress(const Tensor<Pack>& H) const {
    return Material::isochoric_stress(H, value);
  }
};

}  // namespace trocar
