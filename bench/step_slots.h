// Corner forces between a buffer, slots and nodes; four numbers a corner, x y z and anything.
#pragma once

#include <cstdint>

namespace trocar {

// Loops of one instruction set, as the solver's kernels are.
template <class Real>
struct SlotLoops {
  // n corners to slots one behind the other, or the k-th to slot place[k]; `from` becomes zero.
  void (*store)(Real* from, std::int64_t n, Real* slots);
  void (*spread)(Real* from, const std::int32_t* place, std::int64_t n, Real* slots);
  // Sums of n nodes: of the slots slot[offset[k]] to slot[offset[k + 1] - 1], or of those side by
  // side from offset[k] on. Those that come `ahead` slots later are asked for; 0: none.
  void (*collect)(const Real* slots, const std::int32_t* offset, const std::int32_t* slot,
                  std::int64_t n, std::int32_t ahead, Real* sum);
  void (*add_up)(const Real* slots, const std::int32_t* offset, std::int64_t n, std::int32_t ahead,
                 Real* sum);
};

// With AVX2, which holds four doubles in a register, or with SSE2 if active_simd() is below.
SlotLoops<double> slot_loops(double);
SlotLoops<float> slot_loops(float);

}  // namespace trocar
