#include "base/least_of_many.h"

#include <algorithm>
#include <array>
#include <limits>

namespace trocar {

static constexpr std::size_t block_size = 512;

static double least_of(std::span<const double> values) {
  std::array<double, 8> least;  // of every eighth: one alone waits for the one before
  least.fill(std::numeric_limits<double>::max());
  for (std::size_t k = 0; k < values.size(); k += least.size())
    for (std::size_t lane = 0; lane < std::min(least.size(), values.size() - k); ++lane)
      least[lane] = std::min(least[lane], values[k + lane]);
  return *std::min_element(least.begin(), least.end());
}

static double least_of_block(std::span<const double> values, std::size_t block) {
  const std::size_t first = block * block_size;
  return least_of(values.subspan(first, std::min(block_size, values.size() - first)));
}

LeastOfMany::LeastOfMany(std::span<const double> values)
    : of_block_((values.size() + block_size - 1) / block_size) {
  for (std::size_t block = 0; block < of_block_.size(); ++block)
    of_block_[block] = least_of_block(values, block);
}

void LeastOfMany::change(std::span<const double> values, std::span<const std::int64_t> places) {
  std::size_t done = of_block_.size();  // places mostly lie close together
  for (const std::int64_t place : places) {
    const std::size_t block = static_cast<std::size_t>(place) / block_size;
    if (block == done) continue;
    of_block_[block] = least_of_block(values, block);
    done = block;
  }
}

double LeastOfMany::value() const {
  return least_of(of_block_);
}

}  // namespace trocar
