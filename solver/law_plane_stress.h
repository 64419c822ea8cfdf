// A material whose thickness is free: the stretch F33 is the one without stress, P33(F33) = 0,
// found anew each time from the strain in the plane. For a viscoelastic material it is the whole
// stress that vanishes, overstress included.
#pragma once

#include "solver/element_tri3_plane_stress.h"
#include "solver/material_law.h"

namespace trocar {

template <class LawType, class Pack>
struct LawPlaneStress {
  LawType law;
  BlockValues<Pack> value;  // of the element

  [[gnu::always_inline]] Tensor<Pack> stress(const Tensor<Pack>& H) const {
    if constexpr (has_history)
      return law.stress(full_strain(H));  // which moves its history on, once
    else
      return trial_stress(full_strain(H));
  }
  [[gnu::always_inline]] Pack energy(const Tensor<Pack>& H) const {
    return law.energy(full_strain(H));
  }
  // A free thickness can only soften: the bound of plane strain in the same F holds.
  [[gnu::always_inline]] Pack stiffening(const Tensor<Pack>& full) const {
    return law.stiffening(full);
  }

  // H with the thickness that has no stress, between 1/256 and 256 times that at rest. The start
  // F33 = 1 / (1 + c (A - 1)), A = det of the in-plane F, is exact for small strain and for
  // incompressible materials. Secant steps, at most to half or twice the thickness; P33 rises with
  // F33, and a step that would leave the interval where it changes sign, or that follows one which
  // did not halve P33 (fibres that stiffen exponentially), goes to the middle of that interval. A
  // lane is found after a step of the size of rounding by a slope that was measured nearby (a probe
  // does so where none was), and then stands still: its bits do not depend on its neighbours.
  [[gnu::always_inline]] Tensor<Pack> full_strain(Tensor<Pack> H) const {
    Search s = start(H);
#pragma GCC unroll 1
    for (int k = 0; k < most_steps; ++k) {
      const Pack h = s.h, last = absolute(s.step);
      take_step(s, last);
      s.step = s.h - h;
      const Pack size = absolute(s.step);
      s.is_open = last > near ? s.is_open : (size > least_step ? s.is_open : zero_of(h));
      s.is_open = absolute(s.P33) > 0.0 ? s.is_open : zero_of(h);
      if (!is_any_positive(s.is_open)) break;
      H(2, 2) = s.h;
      const Pack before = s.P33;
      s.P33 = trial_stress(H)(2, 2);
      const Pack slope = s.step / (s.P33 - before);
      s.compliance = slope > 0.0 ? slope : s.compliance;
      s.enough = size > probe ? 0.5 * absolute(before) : absolute(s.P33);
    }
    H(2, 2) = s.h;
    return H;
  }

 private:
  static constexpr bool has_history = requires(const LawType& l, const Tensor<Pack>& H) {
    l.trial_stress(H);
  };
  static constexpr int most_steps = 64;
  static constexpr bool is_double = sizeof(RealOf<Pack>) == sizeof(double);
  static constexpr auto least_step = real<Pack>(is_double ? 1e-13 : 2e-6);
  static constexpr auto probe = real<Pack>(is_double ? 1e-12 : 2e-5);
  static constexpr auto near = real<Pack>(is_double ? 1e-6 : 2e-3);

  struct Search {
    Pack h, P33;
    Pack low, high;   // P33 < 0 < P33 there
    Pack compliance;  // dh/dP33
    Pack step;        // the last one
    Pack is_open;     // 0: it is found
    Pack enough;      // a |P33| above this has not fallen enough
  };

  [[gnu::always_inline]] Search start(Tensor<Pack>& H) const {
    constexpr auto thinnest = real<Pack>(1.0 / 256 - 1), thickest = real<Pack>(255.0);
    const Pack area_change = H(0, 0) + H(1, 1) + (H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0));
    const Pack ratio = value(ElementTri3PlaneStress::value_ratio), change = ratio * area_change;
    const Pack zero = zero_of(change), guess = -change / (1.0 + change);
    Search s;
    s.low = zero + thinnest;
    s.high = zero + thickest;
    // The order of the operands keeps a NaN.
    s.h = guess < s.low ? s.low : (guess > s.high ? s.high : guess);
    H(2, 2) = s.h;
    s.P33 = trial_stress(H)(2, 2);
    // dP33/dF33 ~ lambda A^2 + 2 mu, about what a pressure and a shear modulus make of it
    s.compliance =
        value(ElementTri3PlaneStress::value_compliance) / (1.0 + change * (2.0 + area_change));
    s.step = s.is_open = zero + 1.0;
    s.enough = absolute(s.P33);
    return s;
  }

  // `last`: size of the step before.
  [[gnu::always_inline]] static void take_step(Search& s, const Pack& last) {
    s.low = s.P33 < 0.0 ? s.h : s.low;
    s.high = s.P33 > 0.0 ? s.h : s.high;
    const Pack half = 0.5 * (s.h - 1.0), twice = 2.0 * s.h + 1.0;
    Pack next = s.h - s.compliance * s.P33;
    next = next < half ? half : (next > twice ? twice : next);
    const Pack middle = 0.5 * (s.low + s.high);
    const Pack cautious = middle > twice ? twice : middle;
    next = next >= s.low ? next : cautious;
    next = next <= s.high ? next : cautious;
    next = absolute(s.P33) <= s.enough ? next : cautious;
    const Pack probed = s.P33 < 0.0 ? s.h + probe : s.h - probe;
    const Pack probing = absolute(Pack(next - s.h)) < probe ? probed : next;
    next = last > near ? probing : next;
    next = absolute(s.P33) > 0.0 ? next : s.h;
    s.h = s.is_open > 0.0 ? next : s.h;
  }

  // Out of line: three copies of a material are too much code.
  [[gnu::noinline]] Tensor<Pack> trial_stress(const Tensor<Pack>& H) const {
    if constexpr (has_history)
      return law.trial_stress(H);
    else
      return law.stress(H);
  }

  [[gnu::always_inline]] static bool is_any_positive(const Pack& x) {
    RealOf<Pack> lane[pack_width<Pack>];
    store(lane, x);
    bool is_positive = false;
    for (const RealOf<Pack> each : lane) is_positive = is_positive || each > 0;
    return is_positive;
  }
};

}  // namespace trocar
