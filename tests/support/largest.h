// How large numbers or vectors of a list are, and how far those of two lists are apart: NaN if any
// of them is.
#pragma once

#include <cmath>
#include <iterator>

#include "base/vec.h"
#include "larger_or_nan.h"

namespace trocar {

inline double magnitude(double value) {
  return std::abs(value);
}
inline double magnitude(const Vec3& value) {
  return value.norm();
}

template <class Values>
double largest(const Values& values) {
  double most = 0;
  for (const auto& value : values) most = larger_or_nan(most, magnitude(value));
  return most;
}

// Infinite between lists of different lengths.
template <class A, class B>
double largest_difference(const A& a, const B& b) {
  if (std::size(a) != std::size(b)) return HUGE_VAL;
  double most = 0;
  for (std::size_t k = 0; k < std::size(a); ++k) most = larger_or_nan(most, magnitude(a[k] - b[k]));
  return most;
}

}  // namespace trocar
