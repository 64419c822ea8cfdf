// The least of many values of which few change at a time, by the least ones of blocks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trocar {

class LeastOfMany {
 public:
  LeastOfMany() = default;
  explicit LeastOfMany(std::span<const double> values);

  // values: as many as before, with others in `places` alone.
  void change(std::span<const double> values, std::span<const std::int64_t> places);
  // The greatest double of no values.
  double value() const;

 private:
  std::vector<double> of_block_;
};

}  // namespace trocar
