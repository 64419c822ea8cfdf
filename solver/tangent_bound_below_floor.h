// A bound of the tangent stiffness of decoupled materials below the floor of isochoric.h, where
// tangent_bound.h does not hold: norms of the invariants' first and second variations along dF,
// |dI| <= slope |dF| and |d2I| <= curvature |dF|^2, finite through J = 0.
#pragma once

#include "solver/elementary.h"
#include "solver/tangent_bound.h"

namespace trocar {

template <class Pack>
struct Variation {
  Pack size, slope, curvature;
};

// y = 1/J extended, z = -y'/y, Phi = y^(2k/3). From dJ = cof F : dF and d2J = 2 sum s_k (dF_ii
// dF_jj - dF_ij dF_ji), at most 2 max s |dF|^2:
//   |dPhi| <= 2k/3 z |cof F| Phi |dF|,
//   |d2Phi| <= [ 2k/3 (y''/y |cof F|^2 + 2 z max s) + max(0, k (k-1)) (2/3 z |cof F|)^2 ] Phi
//   |dF|^2.
template <class Pack>
struct FloorBound {
  Pack stretch, most_stretch, least_stretch;       // |F|, max s, min s
  Pack area, most_area, least_area;                // the same of cof F
  Pack log_slope, log_curvature, log_y, distance;  // z, y''/y, log y, |J - 1|
};

// Then there is nothing to replace, and the norms, half of a bound's work, are spared.
template <class Pack>
[[gnu::always_inline]] inline bool is_above_floor(const Deformation<Pack>& d) {
  return !is_any(d.iso.extended > 0.0);
}

template <class Pack>
[[gnu::always_inline]] inline FloorBound<Pack> floor_bound(const Deformation<Pack>& d,
                                                           const Stretches<Pack>& x) {
  const Pack(&s)[3] = x.s;
  const Pack area[3] = {s[1] * s[2], s[2] * s[0], s[0] * s[1]};
  const auto norm = [](const Pack(&v)[3]) __attribute__((always_inline)) {
    return square_root(Pack(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  };
  const auto most = [](const Pack(&v)[3], double sign) __attribute__((always_inline)) {
    const auto one = real<Pack>(sign);
    return one * larger(larger(Pack(one * v[0]), Pack(one * v[1])), Pack(one * v[2]));
  };
  const Pack log_y = 1.5 * log1p_of(d.iso.q);
  // y'' / y = 2 / J0^3 / y
  const Pack curvature =
      real<Pack>(2 / (volume_floor * volume_floor * volume_floor)) * (1.0 + expm1_of(Pack(-log_y)));
  return {norm(s),        most(s, 1),    most(s, -1), norm(area), most(area, 1),
          most(area, -1), d.iso.inverse, curvature,   log_y,      absolute(d.change.j)};
}

// y^(2k/3) G(F).
template <class Pack>
[[gnu::always_inline]] inline Variation<Pack> times_power_of_y(const FloorBound<Pack>& b,
                                                               const Pack& k,
                                                               const Variation<Pack>& G) {
  const Pack twothirds = zero_of(k) + real<Pack>(2.0 / 3), kk = k * (k - 1.0);
  const Pack Phi = 1.0 + expm1_of(Pack(twothirds * k * b.log_y));
  const Pack step = twothirds * b.log_slope * b.area;
  const Pack dPhi = k * step;
  const Pack d2Phi =
      twothirds * k * (b.log_curvature * b.area * b.area + 2.0 * b.log_slope * b.most_stretch) +
      larger(zero_of(k), kk) * step * step;
  return {Phi * G.size, Phi * (dPhi * G.size + G.slope),
          Phi * (d2Phi * G.size + 2.0 * dPhi * G.slope + G.curvature)};
}

// |F|^2 y^(2/3), |cof F|^2 y^(4/3) with |d cof F| <= 2 max s |dF|, |cof dF| <= |dF|^2 / sqrt(3).
template <class Pack>
[[gnu::always_inline]] inline Variation<Pack> variation_of_I1bar(const FloorBound<Pack>& b) {
  const Pack one = zero_of(b.area) + 1.0;
  return times_power_of_y(b, one, {b.stretch * b.stretch, 2.0 * b.stretch, 2.0 * one});
}
template <class Pack>
[[gnu::always_inline]] inline Variation<Pack> variation_of_I2bar(const FloorBound<Pack>& b) {
  const Pack D = 2.0 * b.most_stretch, two = zero_of(D) + 2.0;
  return times_power_of_y(b, two,
                          {b.area * b.area, 2.0 * b.area * D,
                           2.0 * D * D + 4.0 * b.area * real<Pack>(0.57735026918962576)});
}
// |F a0|^2 y^(2/3)
template <class Pack>
[[gnu::always_inline]] inline Variation<Pack> variation_of_I4bar(const FloorBound<Pack>& b,
                                                                 const Pack& I4) {
  const Pack one = zero_of(I4) + 1.0;
  return times_power_of_y(b, one, {I4, 2.0 * square_root(larger(zero_of(I4), I4)), 2.0 * one});
}

// Where J lies below the floor, stiffening is that of `isochoric` >= |d2W_iso| / |dF|^2 and of the
// pressure, K (cof F : dF)^2 + K j d2J.
template <class Pack>
[[gnu::always_inline]] inline void replace_below_floor(const Deformation<Pack>& d,
                                                       const FloorBound<Pack>& b,
                                                       const Pack& isochoric,
                                                       const Pack (&K_and_mu)[2],
                                                       Pack& stiffening) {
  const Pack K = K_and_mu[0], mu = K_and_mu[1];
  const Pack below = stiffening_of(Pack(K * b.most_area * b.most_area),
                                   Pack(isochoric + 2.0 * K * b.distance * b.most_stretch),
                                   Pack(K - real<Pack>(2.0 / 3) * mu), mu);
  stiffening = d.iso.extended > 0.0 ? below : stiffening;
}

}  // namespace trocar
