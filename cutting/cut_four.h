// Four numbers at a time, for functions that are compiled twice: for AVX2 and without it. The
// operations and their order are the same, so that the bits do not depend on the machine.
#pragma once

#include <cstdint>

#include "base/vec.h"

// No function here is ever called: all are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace trocar {

// Without `aligned` its alignment would depend on what a function is compiled for.
using Four [[gnu::vector_size(32), gnu::aligned(32)]] = double;
using FourMask [[gnu::vector_size(32), gnu::aligned(32)]] = std::int64_t;  // lanes of 0 or -1

inline bool has_avx2() {
  return __builtin_cpu_supports("avx2") != 0;
}

[[gnu::always_inline]] inline double sum(const Four& a) {
  return (a[0] + a[2]) + (a[1] + a[3]);
}
[[gnu::always_inline]] inline bool is_positive(const Four& a) {
  return a[0] > 0 && a[1] > 0 && a[2] > 0 && a[3] > 0;
}

// The coordinates of four points.
struct FourPoints {
  [[gnu::always_inline]] FourPoints(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
      : x{a.x(), b.x(), c.x(), d.x()}, y{a.y(), b.y(), c.y(), d.y()} {}
  Four x, y;
};

// Columns of the 4 x 4 numbers whose rows are a, b, c, d.
struct FourColumns {
  [[gnu::always_inline]] FourColumns(const Four& a, const Four& b, const Four& c, const Four& d) {
    constexpr FourMask low{0, 4, 2, 6}, high{1, 5, 3, 7}, first{0, 1, 4, 5}, second{2, 3, 6, 7};
    const Four ab_low = __builtin_shuffle(a, b, low), ab_high = __builtin_shuffle(a, b, high);
    const Four cd_low = __builtin_shuffle(c, d, low), cd_high = __builtin_shuffle(c, d, high);
    column[0] = __builtin_shuffle(ab_low, cd_low, first);
    column[1] = __builtin_shuffle(ab_high, cd_high, first);
    column[2] = __builtin_shuffle(ab_low, cd_low, second);
    column[3] = __builtin_shuffle(ab_high, cd_high, second);
  }
  Four column[4];
};

// Four vectors of space.
struct FourVectors {
  Four x, y, z;
};
[[gnu::always_inline]] inline FourVectors operator+(const FourVectors& a, const FourVectors& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[gnu::always_inline]] inline FourVectors operator-(const FourVectors& a, const FourVectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[gnu::always_inline]] inline FourVectors operator*(const Four& s, const FourVectors& a) {
  return {s * a.x, s * a.y, s * a.z};
}
[[gnu::always_inline]] inline FourVectors cross(const FourVectors& a, const FourVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[gnu::always_inline]] inline Four dot(const FourVectors& a, const FourVectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace trocar
