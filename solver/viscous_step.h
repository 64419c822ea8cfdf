// The factors that bring viscoelastic histories forward by one step (viscosity.h).
#pragma once

namespace trocar {

inline constexpr int max_prony_branches = 4;

// Numbers of history at a point: S_iso where the history stands, then h of each branch.
[[gnu::always_inline]] constexpr int history_of_point(int n_branches) {
  return 6 * (1 + n_branches);
}

// The factors of one step, equal for all elements of a list.
struct ViscousStep {
  int n_branches = 0;
  double share_sum = 0;
  double decay[max_prony_branches] = {};  // exp(-x)
  double gain[max_prony_branches] = {};   // g (1 - exp(-x)) / x
};

}  // namespace trocar
