// Three-node triangle in plane stress: the stretch F33 of the thickness is the one without stress,
// P33(F33) = 0, found anew in each element. A fixed number of secant steps whatever the state, so
// that the bits depend on nothing else.
#pragma once

#include "solver/element_one_point.h"
#include "solver/element_tri3.h"

namespace trocar {

struct ElementTri3PlaneStress {
  static constexpr Formulation formulation = Formulation::tri3_plane_stress;
  static constexpr int n_corners = 3;
  static constexpr int value_ratio = ElementTri3::n_values;  // c = lambda / (lambda + 2 mu)
  static constexpr int value_compliance = value_ratio + 1;   // 1 / ((lambda + 2 mu) V) [1/J]
  static constexpr int n_values = value_compliance + 1;

  template <class Law, class Pack>
  [[gnu::always_inline]] static void force(const BlockValues<Pack>& value, const Law& law,
                                           const Pack (&u)[3][3], Pack (&f)[3][3]) {
    const ElementTri3::Strain<Pack> strain = relaxed_strain(value, law, u);
    ElementTri3::forces(value, strain, law.stress(strain.H), f);
  }

  template <class Law, class Pack>
  [[gnu::always_inline]] static ElementEnergy<Pack> energy(const BlockValues<Pack>& value,
                                                           const Law& law, const Pack (&u)[3][3]) {
    return {law.energy(relaxed_strain(value, law, u).H), zero_of(u[0][0])};
  }

  // A free thickness can only soften: the bound of plane strain in the same F holds.
  template <class Law, class Pack>
  [[gnu::always_inline]] static ElementWatch<Pack> watch(const BlockValues<Pack>& value,
                                                         const Law& law, const Pack (&u)[3][3]) {
    const Tensor<Pack> H = relaxed_strain(value, law, u).H;
    return {1.0 + volume_change(H, cofactor(H)), law.stiffening(H)};
  }

  // H with the thickness that has no stress. The start F33 = 1 / (1 + c (A - 1)), A = det of the
  // in-plane F, is exact for small strain and for incompressible materials. The first step goes by
  // the stiffness at rest, each further one by the last two points while they lie far enough apart
  // to tell a slope, then by the last slope. No step takes more than half of the thickness. The
  // count leaves rounding alone where no in-plane strain exceeds a half (plane_stress_test.cpp).
  template <class Law, class Pack>
  [[gnu::always_inline]] static ElementTri3::Strain<Pack> relaxed_strain(
      const BlockValues<Pack>& value, const Law& law, const Pack (&u)[3][3]) {
    constexpr bool is_double = sizeof(RealOf<Pack>) == sizeof(double);
    constexpr int n_steps = is_double ? 10 : 8;
    constexpr auto least_step = real<Pack>(is_double ? 1e-13 : 2e-6);
    ElementTri3::Strain<Pack> s = ElementTri3::strain(value, u);
    Tensor<Pack>& H = s.H;
    const Pack area_change = H(0, 0) + H(1, 1) + (H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0));
    const Pack change = value(value_ratio) * area_change;
    Pack compliance = value(value_compliance);
    H(2, 2) = -change / (1.0 + change);
    Pack P33 = law.stress(H)(2, 2);
#pragma GCC unroll 1
    for (int k = 0; k < n_steps; ++k) {
      const Pack h = H(2, 2), half = 0.5 * (h - 1.0), next = h - compliance * P33;
      H(2, 2) = next < half ? half : next;
      const Pack before = P33;
      P33 = law.stress(H)(2, 2);
      const Pack step = H(2, 2) - h, slope = step / (P33 - before);
      compliance = absolute(step) > least_step ? slope : compliance;
    }
    return s;
  }
};

}  // namespace trocar
