// What elements and laws hand each other, a pack's worth of elements at a time: [value][lane], H or
// V P of each point row by row, then what the element keeps for itself (kernels.h).
#pragma once

#include "solver/block_data.h"
#include "solver/tensor.h"

namespace trocar {

inline constexpr int tensor_values = 9;

// The lanes from `at` on.
template <class Pack>
struct Stash {
  RealOf<Pack>* at;

  [[gnu::always_inline]] Pack get(std::int64_t value) const {
    return load<Pack>(at + value * block_lanes<Pack>);
  }
  [[gnu::always_inline]] void put(std::int64_t value, const Pack& x) const {
    store(at + value * block_lanes<Pack>, x);
  }
  [[gnu::always_inline]] Tensor<Pack> get_tensor(std::int64_t point) const {
    Tensor<Pack> A;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) A(i, j) = get(tensor_values * point + 3 * i + j);
    return A;
  }
  [[gnu::always_inline]] void put_tensor(std::int64_t point, const Tensor<Pack>& A) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) put(tensor_values * point + 3 * i + j, A(i, j));
  }
};

}  // namespace trocar
