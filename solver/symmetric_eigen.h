// Eigenvalues and eigenvectors of symmetric 3 x 3 tensors of packs by Jacobi's rotations: accurate
// to rounding of the largest eigenvalue, whether they are equal or not.
#pragma once

#include "solver/tensor.h"

namespace trocar {

// A = sum_k value[k] vector[k] (x) vector[k], in no order.
template <class Pack>
struct SymmetricEigen {
  Pack value[3];
  Pack vector[3][3];
};

// Turns rows p and q so that a_pq vanishes; r is the third index. The smaller of the two angles:
// t = 2 a_pq / (d + sign(d) sqrt(d^2 + 4 a_pq^2)), d = a_qq - a_pp.
template <class Pack>
[[gnu::always_inline]] inline void rotate_pair(int p, int q, Pack (&a)[3][3], Pack (&v)[3][3]) {
  const int r = 3 - p - q;
  const Pack zero = zero_of(a[p][q]);
  const Pack d = a[q][q] - a[p][p], twice = 2.0 * a[p][q];
  const Pack size = absolute(d) + square_root(Pack(d * d + twice * twice));
  const Pack ratio = twice / (size > 0.0 ? size : zero + 1.0);
  const Pack t = d < 0.0 ? -ratio : ratio;
  const Pack c = 1.0 / square_root(Pack(1.0 + t * t)), s = t * c;
  a[p][p] -= t * a[p][q];
  a[q][q] += t * a[p][q];
  a[p][q] = a[q][p] = zero;
  const Pack rp = a[r][p], rq = a[r][q];
  a[r][p] = a[p][r] = c * rp - s * rq;
  a[r][q] = a[q][r] = s * rp + c * rq;
  for (int i = 0; i < 3; ++i) {
    const Pack vp = v[p][i], vq = v[q][i];
    v[p][i] = c * vp - s * vq;
    v[q][i] = s * vp + c * vq;
  }
}

// One copy for each pack type: it is long.
template <class Pack>
[[gnu::noinline]] void find_eigen(const SymmetricTensor<Pack>& A, SymmetricEigen<Pack>& eigen) {
  Pack a[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      a[i][j] = A.v[symmetric_index[i][j]];
      eigen.vector[i][j] = zero_of(A.v[0]) + (i == j ? 1.0F : 0.0F);
    }
  // Quadratic convergence: off-diagonal shares fall like 1e-1, 1e-2, 1e-5, 1e-10, 1e-20.
  constexpr int n_sweeps = sizeof(RealOf<Pack>) == 8 ? 5 : 4;
#pragma GCC unroll 1
  for (int sweep = 0; sweep < n_sweeps; ++sweep) {
    rotate_pair(0, 1, a, eigen.vector);
    rotate_pair(1, 2, a, eigen.vector);
    rotate_pair(0, 2, a, eigen.vector);
  }
  for (int k = 0; k < 3; ++k) eigen.value[k] = a[k][k];
}

}  // namespace trocar
