// 3 x 3 tensors of packs, written out: the loops unroll into registers.
#pragma once

#include "solver/pack.h"

namespace trocar {

template <class Pack>
struct Tensor {
  Pack v[3][3];
  [[gnu::always_inline]] Pack& operator()(int i, int j) { return v[i][j]; }
  [[gnu::always_inline]] const Pack& operator()(int i, int j) const { return v[i][j]; }
};

// Symmetric: 00 11 22 01 12 20.
template <class Pack>
struct SymmetricTensor {
  Pack v[6];
};
// Position in SymmetricTensor of component (i, j).
inline constexpr int symmetric_index[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

template <class Pack>
[[gnu::always_inline]] inline Pack trace(const Tensor<Pack>& A) {
  return A(0, 0) + A(1, 1) + A(2, 2);
}
template <class Pack>
[[gnu::always_inline]] inline Pack trace(const SymmetricTensor<Pack>& A) {
  return A.v[0] + A.v[1] + A.v[2];
}

template <class Pack>
[[gnu::always_inline]] inline Tensor<Pack> cofactor(const Tensor<Pack>& A) {
  Tensor<Pack> C;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int k = (i + 1) % 3, l = (i + 2) % 3, m = (j + 1) % 3, n = (j + 2) % 3;
      C(i, j) = A(k, m) * A(l, n) - A(k, n) * A(l, m);
    }
  return C;
}

template <class Pack>
[[gnu::always_inline]] inline SymmetricTensor<Pack> cofactor(const SymmetricTensor<Pack>& A) {
  const auto& a = A.v;
  return {{a[1] * a[2] - a[4] * a[4], a[2] * a[0] - a[5] * a[5], a[0] * a[1] - a[3] * a[3],
           a[5] * a[4] - a[3] * a[2], a[3] * a[5] - a[4] * a[0], a[3] * a[4] - a[5] * a[1]}};
}

// A A for symmetric A.
template <class Pack>
[[gnu::always_inline]] inline SymmetricTensor<Pack> square(const SymmetricTensor<Pack>& A) {
  const auto& a = A.v;
  return {{a[0] * a[0] + a[3] * a[3] + a[5] * a[5], a[3] * a[3] + a[1] * a[1] + a[4] * a[4],
           a[5] * a[5] + a[4] * a[4] + a[2] * a[2], a[0] * a[3] + a[3] * a[1] + a[5] * a[4],
           a[3] * a[5] + a[1] * a[4] + a[4] * a[2], a[5] * a[0] + a[4] * a[3] + a[2] * a[5]}};
}

// A S for symmetric S.
template <class Pack>
[[gnu::always_inline]] inline Tensor<Pack> product(const Tensor<Pack>& A,
                                                   const SymmetricTensor<Pack>& S) {
  Tensor<Pack> R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      R(i, j) = A(i, 0) * S.v[symmetric_index[0][j]] + A(i, 1) * S.v[symmetric_index[1][j]] +
                A(i, 2) * S.v[symmetric_index[2][j]];
  return R;
}

// 2E = H + H^T + H^T H, twice the Green strain from the displacement gradient.
template <class Pack>
[[gnu::always_inline]] inline SymmetricTensor<Pack> twice_green_strain(const Tensor<Pack>& H) {
  const auto entry = [&](int i, int j) __attribute__((always_inline)) {
    return H(i, j) + H(j, i) + (H(0, i) * H(0, j) + H(1, i) * H(1, j) + H(2, i) * H(2, j));
  };
  return {{entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)}};
}

// What F = I + H does to volumes and areas, without cancellation at small H:
// j = J - 1 = tr H + tr cof H + det H,  cof F = (1 + tr H) I - H^T + cof H.
template <class Pack>
struct VolumeChange {
  Pack j;
  Tensor<Pack> cof_F;
};

template <class Pack>
[[gnu::always_inline]] inline Pack volume_change(const Tensor<Pack>& H, const Tensor<Pack>& cof_H) {
  const Pack det_H = H(0, 0) * cof_H(0, 0) + H(0, 1) * cof_H(0, 1) + H(0, 2) * cof_H(0, 2);
  return trace(H) + (trace(cof_H) + det_H);
}

template <class Pack>
[[gnu::always_inline]] inline VolumeChange<Pack> volume_and_area_change(const Tensor<Pack>& H) {
  VolumeChange<Pack> change;
  const Tensor<Pack> cof_H = cofactor(H);
  change.j = volume_change(H, cof_H);
  const Pack diagonal = 1.0 + trace(H);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      change.cof_F(i, k) = cof_H(i, k) - H(k, i);
      if (i == k) change.cof_F(i, k) += diagonal;
    }
  return change;
}

}  // namespace trocar
