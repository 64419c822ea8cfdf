// What a block kernel asks of an element, for those with one stress point: Element has
// strain(value, u) with the mean gradient H, forces(value, strain, V P, f) and
// hourglass_energy(value, strain).
#pragma once

#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/tensor.h"

namespace trocar {

template <class Pack>
struct ElementEnergy {
  Pack strain, hourglass;  // [J]
};

template <class Pack>
struct ElementWatch {
  Pack J;           // least det F
  Pack stiffening;  // growth of the bound of omega^2 (stiffening.h)
};

template <class Element>
struct OnePoint {
  static constexpr Formulation formulation = Element::formulation;
  static constexpr int n_corners = Element::n_corners;
  static constexpr int n_values = Element::n_values;
  static constexpr int n_points = 1;  // force asks the law for one stress at each (viscosity.h)

  // f: corner forces of the present displacements u. [N], [m]
  template <class Law, class Pack>
  [[gnu::always_inline]] static void force(const BlockValues<Pack>& value, const Law& law,
                                           const Pack (&u)[n_corners][3], Pack (&f)[n_corners][3]) {
    const auto strain = Element::strain(value, u);
    Element::forces(value, strain, law.stress(strain.H), f);
  }

  template <class Law, class Pack>
  [[gnu::always_inline]] static ElementEnergy<Pack> energy(const BlockValues<Pack>& value,
                                                           const Law& law,
                                                           const Pack (&u)[n_corners][3]) {
    const auto strain = Element::strain(value, u);
    return {law.energy(strain.H), Element::hourglass_energy(value, strain)};
  }

  template <class Law, class Pack>
  [[gnu::always_inline]] static ElementWatch<Pack> watch(const BlockValues<Pack>& value,
                                                         const Law& law,
                                                         const Pack (&u)[n_corners][3]) {
    const Tensor<Pack> H = Element::strain(value, u).H;
    return {1.0 + volume_change(H, cofactor(H)), law.stiffening(H)};
  }
};

}  // namespace trocar
