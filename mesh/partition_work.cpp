#include "mesh/partition_work.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/sort_unique.h"

namespace trocar {

namespace {

constexpr int row_lanes = 8;  // as in solver/row_order.h
// Hexahedra outside rows take 1.2 to 1.3 times as long in double and 1.4 to 1.5 in single precision
// (docs/performance.md, "near box"); other elements never stand in rows.
constexpr double outside_row = 1.4;

// Elements of a part that are computed together, ascending.
struct Lanes {
  std::array<std::int32_t, row_lanes> element{};
  int n = 0;
};

class WorkCount {
 public:
  WorkCount(const Mesh& mesh, std::span<const std::int32_t> node_owner, int n_parts)
      : mesh_(mesh),
        owner_(node_owner),
        next_(static_cast<std::size_t>(n_parts)),
        work_(next_.size(), 0) {
    std::vector<std::int32_t> parts;
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
      parts.clear();
      for (const std::int32_t i : mesh.corners(e)) parts.push_back(owner_[i]);
      sort_unique(parts);
      for (const std::int32_t part : parts) add(e, part);
    }
    for (std::int32_t part = 0; part < n_parts; ++part) finish(part, next_[part]);
  }
  double most() const { return *std::max_element(work_.begin(), work_.end()); }

 private:
  const Mesh& mesh_;
  std::span<const std::int32_t> owner_;
  std::vector<Lanes> next_;
  std::vector<double> work_;

  void add(std::int32_t e, std::int32_t part) {
    Lanes& lanes = next_[part];
    if (lanes.n > 0 && mesh_.element_type[lanes.element[0]] != mesh_.element_type[e])
      finish(part, lanes);
    lanes.element[lanes.n++] = e;
    if (lanes.n == row_lanes) finish(part, lanes);
  }

  void finish(std::int32_t part, Lanes& lanes) {
    if (lanes.n == 0) return;
    const ElementType type = mesh_.element_type[lanes.element[0]];
    const auto one =
        static_cast<double>(corner_work(type) * std::ssize(mesh_.corners(lanes.element[0])));
    const bool is_slow = type == ElementType::hex8 && !is_row(part, lanes);
    work_[part] += row_lanes * one * (is_slow ? outside_row : 1);  // padding takes its time, too
    lanes.n = 0;
  }

  // A part numbers its own nodes first, then those of others.
  bool is_row(std::int32_t part, const Lanes& lanes) const {
    if (lanes.n < row_lanes) return false;
    const std::span<const std::int32_t> first = mesh_.corners(lanes.element[0]);
    for (std::int32_t lane = 1; lane < row_lanes; ++lane) {
      const std::span<const std::int32_t> node = mesh_.corners(lanes.element[lane]);
      for (std::size_t a = 0; a < node.size(); ++a)
        if (node[a] != first[a] + lane || (owner_[node[a]] == part) != (owner_[first[a]] == part))
          return false;
    }
    return true;
  }
};

}  // namespace

int corner_work(ElementType type) {
  switch (type) {
    case ElementType::hex8:
      return 4;
    case ElementType::tet4:
      return 3;
    case ElementType::tri3:
      return 5;
  }
  return 1;
}

double most_work(const Mesh& mesh, std::span<const std::int32_t> node_owner, int n_parts) {
  return WorkCount(mesh, node_owner, n_parts).most();
}

}  // namespace trocar
