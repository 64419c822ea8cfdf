// Values in ascending order, each once, and their places there.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

namespace trocar {

template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

// The same by a key (as of std::ranges): the first of those with equal ones stays.
template <class T, class Key>
void sort_unique_by(std::vector<T>& values, Key key) {
  std::ranges::stable_sort(values, {}, key);
  const auto same = std::ranges::unique(values, {}, key);
  values.erase(same.begin(), same.end());
}

// All that are in one or both; ascending, as they are.
inline std::vector<std::int32_t> united(std::span<const std::int32_t> a,
                                        std::span<const std::int32_t> b) {
  std::vector<std::int32_t> all;
  std::ranges::set_union(a, b, std::back_inserter(all));
  return all;
}

// Numbers of nodes or elements around one place mostly lie close together: then by a bit for each
// number between the least and the greatest.
inline void sort_unique(std::vector<std::int32_t>& values) {
  constexpr std::uint64_t bits = 64;
  if (values.size() < bits) return sort_unique<std::int32_t>(values);
  const auto [least, greatest] = std::ranges::minmax(values);
  const auto place = [&](std::int32_t value) {
    return static_cast<std::uint64_t>(std::int64_t{value} - least);
  };
  const std::uint64_t n_words = place(greatest) / bits + 1;
  if (n_words > 4 * values.size()) return sort_unique<std::int32_t>(values);
  std::vector<std::uint64_t> words(n_words, 0);
  for (const std::int32_t value : values)
    words[place(value) / bits] |= std::uint64_t{1} << place(value) % bits;
  values.clear();
  for (std::uint64_t k = 0; k < n_words; ++k)
    for (std::uint64_t word = words[k]; word != 0; word &= word - 1)
      values.push_back(least + static_cast<std::int32_t>(k * bits) + std::countr_zero(word));
}

// Of the first that is not less.
inline std::int32_t place_in(std::span<const std::int32_t> sorted, std::int32_t value) {
  return static_cast<std::int32_t>(std::ranges::lower_bound(sorted, value) - sorted.begin());
}
// Of the value; -1 if it is not among them.
inline std::int32_t find_in(std::span<const std::int32_t> sorted, std::int32_t value) {
  const std::int32_t place = place_in(sorted, value);
  return place < std::ssize(sorted) && sorted[place] == value ? place : -1;
}

}  // namespace trocar
