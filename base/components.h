// All components of a field of vectors, one after the other: for arithmetic on whole fields, which
// Eigen does some components at a time.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"

namespace trocar {

inline Eigen::Map<const Eigen::ArrayXd> components(std::span<const Vec3> field) {
  return {field.empty() ? nullptr : field.front().data(), 3 * std::ssize(field)};
}
inline Eigen::Map<Eigen::ArrayXd> components(std::vector<Vec3>& field) {
  return {field.empty() ? nullptr : field.front().data(), 3 * std::ssize(field)};
}

}  // namespace trocar
