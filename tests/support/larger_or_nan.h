// The larger of two numbers, as std::max but for NaN, which stays: a figure that is no number must
// not pass for a small one.
#pragma once

namespace trocar {

template <class T>
T larger_or_nan(T a, T b) {
  return a != a || b <= a ? a : b;
}

}  // namespace trocar
