// Lookup and merging of values by element.
#pragma once

#include <algorithm>

#include "base/check.h"
#include "cutting/cut_stroke.h"

namespace trocar {

template <class T>
const T* find_element(const std::vector<OfElement<T>>& values, std::int32_t element) {
  const auto at =
      std::lower_bound(values.begin(), values.end(), element,
                       [](const OfElement<T>& entry, std::int32_t e) { return entry.element < e; });
  return at != values.end() && at->element == element ? &at->value : nullptr;
}

template <class T>
std::vector<const T*> find_elements(const std::vector<OfElement<T>>& values,
                                    std::span<const std::int32_t> element) {
  std::vector<const T*> found(element.size(), nullptr);
  if (element.empty()) return found;
  auto at =
      std::lower_bound(values.begin(), values.end(), element[0],
                       [](const OfElement<T>& entry, std::int32_t e) { return entry.element < e; });
  for (std::size_t k = 0; k < element.size(); ++k) {
    while (at != values.end() && at->element < element[k]) ++at;
    if (at != values.end() && at->element == element[k]) found[k] = &at->value;
  }
  return found;
}

template <class T>
void merge_elements(std::vector<OfElement<T>>& values, const std::vector<OfElement<T>>& changes) {
  DCHECK(std::ranges::is_sorted(changes, {}, &OfElement<T>::element));
  std::vector<OfElement<T>> merged;
  merged.reserve(values.size() + changes.size());
  auto old = values.begin();
  for (const OfElement<T>& change : changes) {
    while (old != values.end() && old->element < change.element) merged.push_back(*old++);
    if (old != values.end() && old->element == change.element) ++old;
    merged.push_back(change);
  }
  merged.insert(merged.end(), old, values.end());
  values = std::move(merged);
}

}  // namespace trocar
