#include "bench/step_slots.h"

#include "solver/pack.h"
#include "solver/simd.h"

namespace trocar {

namespace {

// slot(k): of the k-th corner.
template <class Real, class Slot>
[[gnu::always_inline]] inline void move_corners(Real* from, std::int64_t n, Real* slots,
                                                const Slot& slot) {
  PackOf<Real, 4> corner, zero{};
  for (std::int64_t k = 0; k < n; ++k) {
    __builtin_memcpy(&corner, from + 4 * k, sizeof corner);
    __builtin_memcpy(from + 4 * k, &zero, sizeof zero);
    __builtin_memcpy(slots + 4 * slot(k), &corner, sizeof corner);
  }
}

template <class Real, class Slot>
[[gnu::always_inline]] inline void sum_corners(const Real* slots, const std::int32_t* offset,
                                               std::int64_t n, std::int32_t ahead, Real* sum,
                                               const Slot& slot) {
  PackOf<Real, 4> corner;
  for (std::int64_t k = 0; k < n; ++k) {
    PackOf<Real, 4> of_node{};
    for (std::int64_t at = offset[k]; at < offset[k + 1]; ++at) {
      if (ahead > 0) __builtin_prefetch(slots + 4 * slot(at + ahead));
      __builtin_memcpy(&corner, slots + 4 * slot(at), sizeof corner);
      of_node += corner;
    }
    __builtin_memcpy(sum + 4 * k, &of_node, sizeof of_node);
  }
}

constexpr auto in_order = [](std::int64_t k) __attribute__((always_inline)) {
  return k;
};
constexpr auto numbered = [](const std::int32_t* number) __attribute__((always_inline)) {
  return [number](std::int64_t k) __attribute__((always_inline)) {
    return std::int64_t{number[k]};
  };
};

template <class Real>
struct LoopsSse2 {
  static void store(Real* from, std::int64_t n, Real* slots) {
    move_corners(from, n, slots, in_order);
  }
  static void spread(Real* from, const std::int32_t* place, std::int64_t n, Real* slots) {
    move_corners(from, n, slots, numbered(place));
  }
  static void collect(const Real* slots, const std::int32_t* offset, const std::int32_t* slot,
                      std::int64_t n, std::int32_t ahead, Real* sum) {
    sum_corners(slots, offset, n, ahead, sum, numbered(slot));
  }
  static void add_up(const Real* slots, const std::int32_t* offset, std::int64_t n,
                     std::int32_t ahead, Real* sum) {
    sum_corners(slots, offset, n, ahead, sum, in_order);
  }
};

// What is inlined there is compiled for the attribute's instruction set.
template <class Real>
struct LoopsAvx2 {
  [[gnu::target("avx2")]] static void store(Real* from, std::int64_t n, Real* slots) {
    move_corners(from, n, slots, in_order);
  }
  [[gnu::target("avx2")]] static void spread(Real* from, const std::int32_t* place, std::int64_t n,
                                             Real* slots) {
    move_corners(from, n, slots, numbered(place));
  }
  [[gnu::target("avx2")]] static void collect(const Real* slots, const std::int32_t* offset,
                                              const std::int32_t* slot, std::int64_t n,
                                              std::int32_t ahead, Real* sum) {
    sum_corners(slots, offset, n, ahead, sum, numbered(slot));
  }
  [[gnu::target("avx2")]] static void add_up(const Real* slots, const std::int32_t* offset,
                                             std::int64_t n, std::int32_t ahead, Real* sum) {
    sum_corners(slots, offset, n, ahead, sum, in_order);
  }
};

template <class Loops, class Real>
SlotLoops<Real> table() {
  return {Loops::store, Loops::spread, Loops::collect, Loops::add_up};
}

template <class Real>
SlotLoops<Real> widest() {
  if (active_simd() >= Simd::avx2) return table<LoopsAvx2<Real>, Real>();
  return table<LoopsSse2<Real>, Real>();
}

}  // namespace

SlotLoops<double> slot_loops(double) {
  return widest<double>();
}
SlotLoops<float> slot_loops(float) {
  return widest<float>();
}

}  // namespace trocar
