// Relaxation of hourglass forces, written once for any pack and element. As viscosity.h pulls P
// back to S = F^-1 P, hourglass displacements are pulled back to Q_p = F^-1 q_p and relax by the
// same branches:
//   g_p = sum_r A_pr q'_r,  q'_p = q_p + F O_p,  O_p = sum_b h_b,p - sum_b g_b Q_p
// (viscous_history.h), so that rotations do nothing, the force of a step of strain is the elastic
// one and that of a relaxed element 1 - sum g of it. The element makes its forces of q' as of any
// q. Those of q itself have no moment; what O adds has one, of the skew part of
//   sum_p (F G_p) (x) q_p = F M F^T,  M = sum_p G_p (x) Q_p,  G_p = sum_r A_pr O_r,
// which the stress V P = -F skew M balances, to rounding (below the floor of isochoric.h nearly).
// In the law of small strain F is I, and moments are those about the undeformed corners: zero.
#pragma once

#include "solver/element_hex8.h"
#include "solver/hourglass_history.h"
#include "solver/kernel_groups.h"
#include "solver/viscous_history.h"

namespace trocar {

template <class Pack, class Element, bool is_small_strain>
struct HourglassLoops {
  using Vectors = Pack[n_hourglass_modes][3];

  static void relax(const BlockTask& task, const ViscousStep& step, double* history,
                    void* balance) {
    for_groups<Pack>(task, [&](const Group<Pack>& group, std::int64_t, int lane) {
      const Stash<Pack> q{group.stash.at + (tensor_values + Element::kept_q) * block_lanes<Pack>};
      const Tensor<Pack> H = group.stash.get_tensor(0);
      Vectors Q, O;
      pull_back(H, q, Q);
      for (int p = 0; p < n_hourglass_modes; ++p)
        for (int i = 0; i < 3; ++i)
          O[p][i] = advance_history<HistoryCall::moves_history>(step, n_hourglass_components,
                                                                3 * p + i, Q[p][i], history + lane);
      add_forward(H, O, q);
      const BlockValues<Pack> stiffness{
          group.value.at + (task.n_material_values + Element::value_k) * block_lanes<Pack>};
      Stash<Pack>{static_cast<RealOf<Pack>*>(balance) + lane}.put_tensor(
          0, balance_of(H, stiffness, O, Q));
    });
  }

 private:
  // Q_p = F^-1 q_p = (cof F)^T q_p / J
  [[gnu::always_inline]] static void pull_back(const Tensor<Pack>& H, const Stash<Pack>& q,
                                               Vectors& Q) {
    const VolumeChange<Pack> change = volume_and_area_change(H);
    const Tensor<Pack>& A = change.cof_F;
    const Pack inverse_J = finite_inverse_J(change.j);
    for (int p = 0; p < n_hourglass_modes; ++p) {
      const Pack x = q.get(3 * p), y = q.get(3 * p + 1), z = q.get(3 * p + 2);
      const Pack of_small[3] = {x, y, z};
      for (int i = 0; i < 3; ++i)
        Q[p][i] = is_small_strain ? of_small[i]
                                  : Pack((A(0, i) * x + A(1, i) * y + A(2, i) * z) * inverse_J);
    }
  }

  // q_p += F O_p
  [[gnu::always_inline]] static void add_forward(const Tensor<Pack>& H, const Vectors& O,
                                                 const Stash<Pack>& q) {
    for (int p = 0; p < n_hourglass_modes; ++p)
      for (int i = 0; i < 3; ++i) {
        Pack sum = q.get(3 * p + i) + O[p][i];
        if constexpr (!is_small_strain)
          sum += H(i, 0) * O[p][0] + H(i, 1) * O[p][1] + H(i, 2) * O[p][2];
        q.put(3 * p + i, sum);
      }
  }

  // -F skew M
  [[gnu::always_inline]] static Tensor<Pack> balance_of(const Tensor<Pack>& H,
                                                        const BlockValues<Pack>& stiffness,
                                                        const Vectors& O, const Vectors& Q) {
    Tensor<Pack> P, K;
    for (int k = 0; k < 9; ++k) P(k / 3, k % 3) = zero_of(H(0, 0));
    if constexpr (!is_small_strain) {
      Vectors G;
      Element::Hourglass::forces(stiffness, O, G);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          K(i, j) = zero_of(H(0, 0));
          for (int p = 0; p < n_hourglass_modes; ++p)
            K(i, j) += 0.5 * (G[p][j] * Q[p][i] - G[p][i] * Q[p][j]);
        }
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          P(i, j) = K(i, j) + (H(i, 0) * K(0, j) + H(i, 1) * K(1, j) + H(i, 2) * K(2, j));
    }
    return P;
  }
};

template <class Pack>
void add_hourglass_balance(const BlockTask& task, const void* balance) {
  for_groups<Pack>(task, [&](const Group<Pack>& group, std::int64_t, int lane) {
    for (int k = 0; k < tensor_values; ++k) {
      const auto* const at = static_cast<const RealOf<Pack>*>(balance) + lane;
      group.stash.put(k, Pack(group.stash.get(k) + load<Pack>(at + k * block_lanes<Pack>)));
    }
  });
}

template <class Pack, class... Elements>
HourglassKernels hourglass_kernels(TypeList<Elements...>) {
  HourglassKernels kernels{};
  ((kernels.relax[0][static_cast<int>(Elements::formulation)] =
        HourglassLoops<Pack, Elements, false>::relax,
    kernels.relax[1][static_cast<int>(Elements::formulation)] =
        HourglassLoops<Pack, Elements, true>::relax),
   ...);
  kernels.balance = add_hourglass_balance<Pack>;
  return kernels;
}

}  // namespace trocar
