// Sets of numbers that grow together, with path halving; a set's root is its lowest number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace trocar {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : above_(n) { std::iota(above_.begin(), above_.end(), 0); }

  std::int32_t root(std::int32_t k) {
    while (above_[k] != k) k = above_[k] = above_[above_[k]];
    return k;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = root(a);
    b = root(b);
    above_[std::max(a, b)] = std::min(a, b);
  }
  // (n) of each number.
  std::vector<std::int32_t> roots() && {
    for (std::size_t k = 0; k < above_.size(); ++k) above_[k] = root(static_cast<std::int32_t>(k));
    return std::move(above_);
  }

 private:
  std::vector<std::int32_t> above_;
};

}  // namespace trocar
