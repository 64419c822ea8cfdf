// A material whose thickness is free: the stretch F33 is the one without stress, P33(F33) = 0,
// found anew each time. A fixed number of secant steps whatever the state, so that the bits depend
// on nothing else.
#pragma once

#include "solver/element_tri3_plane_stress.h"
#include "solver/material_law.h"

namespace trocar {

template <class LawType, class Pack>
struct LawPlaneStress {
  LawType law;
  BlockValues<Pack> value;  // of the element

  [[gnu::always_inline]] Tensor<Pack> stress(const Tensor<Pack>& H) const {
    return trial_stress(full_strain(H));
  }
  [[gnu::always_inline]] Pack energy(const Tensor<Pack>& H) const {
    return law.energy(full_strain(H));
  }
  // A free thickness can only soften: the bound of plane strain in the same F holds.
  [[gnu::always_inline]] Pack stiffening(const Tensor<Pack>& full) const {
    return law.stiffening(full);
  }

  // H with the thickness that has no stress. The start F33 = 1 / (1 + c (A - 1)), A = det of the
  // in-plane F, is exact for small strain and for incompressible materials. The first step goes by
  // the stiffness at rest, each further one by the last two points while they lie far enough apart
  // to tell a slope, then by the last slope. No step takes more than half of the thickness. The
  // count leaves rounding alone where no in-plane strain exceeds a half (plane_stress_test.cpp).
  [[gnu::always_inline]] Tensor<Pack> full_strain(Tensor<Pack> H) const {
    constexpr bool is_double = sizeof(RealOf<Pack>) == sizeof(double);
    constexpr int n_steps = is_double ? 10 : 8;
    constexpr auto least_step = real<Pack>(is_double ? 1e-13 : 2e-6);
    const Pack area_change = H(0, 0) + H(1, 1) + (H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0));
    const Pack change = value(ElementTri3PlaneStress::value_ratio) * area_change;
    Pack compliance = value(ElementTri3PlaneStress::value_compliance);
    H(2, 2) = -change / (1.0 + change);
    Pack P33 = trial_stress(H)(2, 2);
#pragma GCC unroll 1
    for (int k = 0; k < n_steps; ++k) {
      const Pack h = H(2, 2), half = 0.5 * (h - 1.0), next = h - compliance * P33;
      H(2, 2) = next < half ? half : next;
      const Pack before = P33;
      P33 = trial_stress(H)(2, 2);
      const Pack step = H(2, 2) - h, slope = step / (P33 - before);
      compliance = absolute(step) > least_step ? slope : compliance;
    }
    return H;
  }

 private:
  // Out of line: three copies of a material are too much code.
  [[gnu::noinline]] Tensor<Pack> trial_stress(const Tensor<Pack>& H) const {
    return law.stress(H);
  }
};

}  // namespace trocar
