// Four numbers at a time, for functions that are compiled twice: for AVX2 and without it. The
// operations and their order are the same, so that the bits do not depend on the machine.
#pragma once

#include "base/vec.h"

namespace trocar {

// Without `aligned` its alignment would depend on what a function is compiled for.
using Four [[gnu::vector_size(32), gnu::aligned(32)]] = double;

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

}  // namespace trocar
