// Four-node tetrahedron with averaged nodal pressure, variational form (after Bonet and Burton
// 1998, per region as Joldes, Wittek and Miller 2009): the volumetric energy counts at nodes,
//   W = sum_e V_e W_iso(F_e) + (1 - s) sum_a (V_a/4) K/2 theta_a^2 + s sum_e V_e K/2 j_e^2,
//   theta_a = sum_e V_e j_e / V_a,  V_a = sum_e V_e,  j = J - 1,
// over the elements of one region at node a. Its exact derivative is the force of a tetrahedron
// with
//   P_e = dW_iso/dF + K ((1 - s) theta_e + s j_e) cof F_e,  theta_e the mean of its corners,
// so that energy is conserved. The small share s binds modes that the averages alone don't see.
#pragma once

#include "solver/element_one_point.h"
#include "solver/element_tet4.h"

namespace trocar {

// A decoupled material at a mean volume change that others determine, too.
template <class LawType, class Pack>
struct LawAtPressure {
  LawType law;
  Pack theta;          // mean over the corners
  RealOf<Pack> share;  // s

  [[gnu::always_inline]] Tensor<Pack> stress(const Tensor<Pack>& H) const {
    const VolumeChange<Pack> change = volume_and_area_change(H);
    const Pack pressure = law.value(value_K_V) * mixed(change.j);
    Tensor<Pack> P = law.isochoric_stress(H);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P(i, j) += pressure * change.cof_F(i, j);
    return P;
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

struct Tet4NodalPressure : OnePoint<ElementTet4> {
  static constexpr Formulation formulation = Formulation::tet4_nodal_pressure;
  static constexpr bool averages_volume = true;
};

template <class Element>
inline constexpr bool averages_volume_v = requires {
  Element::averages_volume;
};

}  // namespace trocar
