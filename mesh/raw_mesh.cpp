// Cells of a mesh file, their tags and their groups.
#include "mesh/raw_mesh.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "base/sort_unique.h"

namespace trocar {

int n_cell_corners(CellKind kind) {
  constexpr std::array<int, 6> n = {1, 2, 3, 4, 4, 8};
  return n[static_cast<std::size_t>(kind)];
}

int cell_dimension(CellKind kind) {
  constexpr std::array<int, 6> dimension = {0, 1, 2, 2, 3, 3};
  return dimension[static_cast<std::size_t>(kind)];
}

const char* cell_kind_name(CellKind kind) {
  constexpr std::array<const char*, 6> name = {"point",      "line",        "triangle",
                                               "quadrangle", "tetrahedron", "hexahedron"};
  return name[static_cast<std::size_t>(kind)];
}

void reserve_cells(RawMesh& raw, std::size_t n) {
  raw.cell_kind.reserve(n);
  raw.cell_tag.reserve(n);
  raw.cell_group.reserve(n);
}

void add_cell(RawMesh& raw, CellKind kind, std::span<const std::int32_t> corners, std::int64_t tag,
              std::int32_t group) {
  constexpr std::size_t limit = std::numeric_limits<std::int32_t>::max();
  if (raw.cell_corner.size() + corners.size() > limit)
    throw InputError(raw.file + ": the elements have more than " + std::to_string(limit) +
                     " corners in all");
  raw.cell_kind.push_back(kind);
  raw.cell_tag.push_back(tag);
  raw.cell_group.push_back(group);
  raw.cell_corner.insert(raw.cell_corner.end(), corners.begin(), corners.end());
}

void make_group_lists(RawMesh& raw) {
  std::vector<std::int32_t> tags = raw.cell_group;
  sort_unique(tags);
  tags.erase(std::remove(tags.begin(), tags.end(), 0), tags.end());
  raw.group_offset.resize(tags.size() + 2);
  std::iota(raw.group_offset.begin() + 1, raw.group_offset.end(), 0);
  for (std::int32_t& group : raw.cell_group)
    if (group != 0) group = 1 + place_in(tags, group);
  raw.group_tag = std::move(tags);
}

TagIndex::TagIndex(std::span<const std::int64_t> tag) : tag_(tag) {
  if (tag.empty()) return;
  const auto [low, high] = std::minmax_element(tag.begin(), tag.end());
  low_ = *low;
  const auto range = static_cast<std::uint64_t>(*high) - static_cast<std::uint64_t>(low_);
  is_dense_ = range < 2 * tag.size() + 64;
  if (is_dense_) {
    position_.assign(range + 1, -1);
    fill_dense();
  } else {
    fill_sorted();
  }
}

void TagIndex::fill_dense() {
  for (std::size_t i = 0; i < tag_.size(); ++i) {
    std::int32_t& position = position_[tag_[i] - low_];
    if (position >= 0 && duplicate_ < 0) duplicate_ = static_cast<std::int32_t>(i);
    position = static_cast<std::int32_t>(i);
  }
}

void TagIndex::fill_sorted() {
  position_.resize(tag_.size());
  std::iota(position_.begin(), position_.end(), 0);
  std::sort(position_.begin(), position_.end(), [this](std::int32_t a, std::int32_t b) {
    return tag_[a] != tag_[b] ? tag_[a] < tag_[b] : a < b;
  });
  for (std::size_t k = 1; k < position_.size(); ++k)
    if (tag_[position_[k]] == tag_[position_[k - 1]] && duplicate_ < 0) duplicate_ = position_[k];
}

std::int32_t TagIndex::find(std::int64_t tag) const {
  if (is_dense_) {
    const auto k = static_cast<std::uint64_t>(tag) - static_cast<std::uint64_t>(low_);
    return tag >= low_ && k < position_.size() ? position_[k] : -1;
  }
  const auto found =
      std::lower_bound(position_.begin(), position_.end(), tag,
                       [this](std::int32_t i, std::int64_t t) { return tag_[i] < t; });
  return found != position_.end() && tag_[*found] == tag ? *found : -1;
}

}  // namespace trocar
