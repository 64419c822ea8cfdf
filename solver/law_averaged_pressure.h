// A decoupled material at a mean volume change that others determine, too
// (element_tet4_nodal_pressure.h).
#pragma once

#include "solver/material_law.h"

namespace trocar {

template <class LawType, class Pack>
struct LawAveragedPressure {
  LawType law;
  Pack theta;          // mean over the corners
  RealOf<Pack> share;  // s

  [[gnu::always_inline]] Tensor<Pack> full_strain(const Tensor<Pack>& H) const { return H; }

  [[gnu::always_inline]] Tensor<Pack> stress(const Tensor<Pack>& H) const {
    const Pack j = volume_change(H, cofactor(H));
    return law.stress_at_pressure(H, Pack(law.value(value_K_V) * mixed(j)));
  }
  [[gnu::always_inline]] Tensor<Pack> stress(const Deformation<Pack>& d) const {
    return law.stress_at_pressure(d, Pack(law.value(value_K_V) * mixed(d.change.j)));
  }

  // Without the energy at nodes.
  [[gnu::always_inline]] Pack energy(const Tensor<Pack>& H) const {
    const Pack j = volume_change(H, cofactor(H));
    return law.isochoric_energy(H) + 0.5 * (share * law.value(value_K_V) * j * j);
  }

  // The bound of the plain tetrahedron holds for the averages, but for the pressure's product with
  // d2J = dF : d(cof F) : dF, |d2J| <= 2 |F| |dF|^2.
  [[gnu::always_inline]] Pack stiffening(const Tensor<Pack>& H) const {
    const Pack K = law.value(value_K_V), mu = law.value(value_mu_V), zero = zero_of(K);
    const Pack j = volume_change(H, cofactor(H));
    const Pack F2 = 3.0 + trace(twice_green_strain(H));
    const Pack excess = absolute(Pack(K * (mixed(j) - j))) * square_root(larger(zero, F2));
    const Pack lambda = larger(zero, Pack(K - real<Pack>(2.0 / 3) * mu));
    return law.stiffening(H) + 2.0 * excess / (lambda + 2.0 * mu);
  }

 private:
  [[gnu::always_inline]] Pack mixed(const Pack& j) const { return theta + share * (j - theta); }
};

}  // namespace trocar
