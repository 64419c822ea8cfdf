// Eigenvalues of symmetric 3 x 3 tensors with + - * / and sqrt alone, a sixth of the work of
// symmetric_eigen.h, to rounding of the deviator's size (its root where two are equal).
#pragma once

#include "solver/tensor.h"

namespace trocar {

// With m = tr A / 3, p^2 = |dev A|^2 / 6 and c = det(dev A) / (2 p^3) in [-1, 1] the eigenvalues
// are m + 2 p y, y the roots of 4 y^3 - 3 y = c: cosines of a third of c's angle and of that turned
// by 120 degrees (Smith 1961, without its arc cosine).
template <class Pack>
struct DeviatorInvariants {
  Pack m, p;
  Pack c;  // but for rounding in [-1, 1]; 0 without a deviator
};

template <class Pack>
[[gnu::always_inline]] inline DeviatorInvariants<Pack> deviator_invariants(
    const SymmetricTensor<Pack>& A) {
  const Pack m = trace(A) * real<Pack>(1.0 / 3);
  SymmetricTensor<Pack> D = A;
  for (int i = 0; i < 3; ++i) D.v[i] -= m;
  const auto& d = D.v;
  const Pack p2 =
      (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + 2.0 * (d[3] * d[3] + d[4] * d[4] + d[5] * d[5])) *
      real<Pack>(1.0 / 6);
  const Pack p = square_root(p2), p3 = p2 * p;
  const SymmetricTensor<Pack> C = cofactor(D);
  const Pack det = d[0] * C.v[0] + d[3] * C.v[3] + d[5] * C.v[5];
  return {m, p, p3 > 0.0 ? 0.5 * det / p3 : zero_of(m)};
}

template <class Pack>
struct EigenvalueRoots {
  Pack m, p, y;  // the largest root, in [1/2, 1]
};

// The polynomial is convex at its largest root, so that Newton comes from above from the second
// iterate on: the result is exact or a hair too large.
template <class Pack>
[[gnu::always_inline]] inline EigenvalueRoots<Pack> eigenvalue_roots(
    const SymmetricTensor<Pack>& A) {
  const auto [m, p, ratio] = deviator_invariants(A);
  const Pack zero = m - m, one = zero + 1.0;
  const Pack c = ratio > 1.0 ? one : (ratio < -1.0 ? -one : ratio);
  Pack y = 0.5 + 0.5 * square_root(Pack(0.5 * (1.0 + c)));
  for (int k = 0; k < 4; ++k) {
    const Pack slope = 12.0 * y * y - 3.0;
    const Pack step = (y * (4.0 * y * y - 3.0) - c) / slope;
    y -= slope > real<Pack>(1e-9) ? step : zero;
  }
  return {m, p, y};
}

template <class Pack>
[[gnu::always_inline]] inline Pack largest_eigenvalue(const SymmetricTensor<Pack>& A) {
  const EigenvalueRoots<Pack> roots = eigenvalue_roots(A);
  return roots.m + 2.0 * roots.p * roots.y;
}

// All three, the largest first.
template <class Pack>
[[gnu::always_inline]] inline void find_eigenvalues(const SymmetricTensor<Pack>& A,
                                                    Pack (&value)[3]) {
  const EigenvalueRoots<Pack> roots = eigenvalue_roots(A);
  const Pack& y = roots.y;
  const Pack sine2 = 1.0 - y * y;
  const Pack half = -0.5 * y;
  const Pack turn = square_root(Pack(0.75 * (sine2 > 0.0 ? sine2 : zero_of(y))));
  value[0] = roots.m + 2.0 * roots.p * y;
  value[1] = roots.m + 2.0 * roots.p * (half + turn);
  value[2] = roots.m + 2.0 * roots.p * (half - turn);
}

}  // namespace trocar
