// Breadth-first search over the stars of nodes. A band's cut through the body is connected to the
// surface or to its begin, and passes from element to element through nodes of both.
#include "cutting/cut_near.h"

#include <algorithm>

namespace trocar {

// Beyond which sides of the box a node lies, in index.ring: bits 0 to 5; and how far the search is.
static constexpr unsigned all_sides = 63, is_searched = 64, is_queued = 128;

namespace {

struct Search {
  const Mesh& mesh;
  CutIndex& index;
  std::span<const Vec3> x;
  const BandBox& box;
  std::vector<std::int32_t> seen;     // nodes with a mark in index.ring
  std::vector<std::int32_t> queue;    // nodes
  std::vector<std::int32_t> element;  // found so far
};

}  // namespace

static unsigned outside(const BandBox& box, const Vec3& p) {
  const Vec3 q = box.axes.transpose() * p;
  unsigned code = 0;
  for (int d = 0; d < 3; ++d)
    code |= (q[d] < box.low[d] ? 1U << d : 0U) | (q[d] > box.high[d] ? 8U << d : 0U);
  return code;
}

static std::uint8_t& mark_of(Search& search, std::int32_t i) {
  std::uint8_t& mark = search.index.ring[i];
  if (mark != no_ring) return mark;
  mark = static_cast<std::uint8_t>(outside(search.box, search.x[i]));
  search.seen.push_back(i);
  return mark;
}

static void put_in_queue(Search& search, std::int32_t i) {
  std::uint8_t& mark = mark_of(search, i);
  if ((mark & is_queued) != 0) return;
  mark |= is_queued;
  search.queue.push_back(i);
}

// Takes up the elements around node i that no searched node has.
static void search_star(Search& search, std::int32_t i) {
  for (const std::int32_t e : search.index.star(i)) {
    const std::span<const std::int32_t> corner = search.mesh.corners(e);
    unsigned common = all_sides, any = 0;
    for (const std::int32_t j : corner) {
      common &= mark_of(search, j);
      any |= mark_of(search, j);
    }
    if (common != 0 || (any & is_searched) != 0) continue;
    if (search.mesh.element_type[e] == ElementType::tet4) search.element.push_back(e);
    for (const std::int32_t j : corner) put_in_queue(search, j);
  }
  mark_of(search, i) |= is_searched;
}

static std::vector<std::int32_t> run(Search& search) {
  for (std::size_t k = 0; k < search.queue.size(); ++k) search_star(search, search.queue[k]);
  for (const std::int32_t i : search.seen) search.index.ring[i] = no_ring;
  std::sort(search.element.begin(), search.element.end());
  return std::move(search.element);
}

namespace {

// The box widened by 1.75 of the longest edge: a triangle that meets the box has a corner within
// 0.58 of its longest edge of it, and edges may be stretched to three times their length.
static constexpr double most_stretch = 3, margin_edges = 1.75;

class WideBox {
 public:
  WideBox(const BandBox& box, double longest_edge) : box_(box) {
    const Vec3 margin = Vec3::Constant(margin_edges * longest_edge);
    box_.low -= margin;
    box_.high += margin;
    const Vec3 middle = box_.axes * (0.5 * (box_.low + box_.high));
    const Vec3 reach = box_.axes.cwiseAbs() * (0.5 * (box_.high - box_.low));
    low_ = middle - reach;
    high_ = middle + reach;
  }
  bool holds(const Vec3& p) const { return may_hold(p, 0) && outside(box_, p) == 0; }
  // Points within `reach` of p, by the same box along the axes of space: cheap, and without
  // branches, for most points are far away in no pattern.
  bool may_hold(const Vec3& p, double reach) const {
    return (p[0] >= low_[0] - reach) & (p[0] <= high_[0] + reach) & (p[1] >= low_[1] - reach) &
           (p[1] <= high_[1] + reach) & (p[2] >= low_[2] - reach) & (p[2] <= high_[2] + reach);
  }

 private:
  BandBox box_;
  Vec3 low_, high_;
};

}  // namespace

// Puts the nodes in the wide box into the queue: of the first clusters, and loose ones.
template <class Wanted>
static void search_box(Search& search, std::size_t n_clusters, const Wanted& is_wanted) {
  const NodeClusters& clusters = search.index.clusters;
  const WideBox wide(search.box, search.index.longest_edge);
  const auto look_at = [&](std::int32_t i) {
    if (is_wanted(i) && wide.holds(search.x[i])) put_in_queue(search, i);
  };
  for (std::size_t c = 0; c < n_clusters; ++c) {
    const std::int32_t middle = clusters.middle[c];
    if (middle < 0 || !wide.may_hold(search.x[middle], most_stretch * clusters.reach[c])) continue;
    std::ranges::for_each(clusters.nodes(c), look_at);
  }
  std::ranges::for_each(clusters.loose, look_at);
}

std::vector<std::int32_t> near_elements(const Mesh& mesh, CutIndex& index, std::span<const Vec3> x,
                                        const BandBox& box) {
  Search search{mesh, index, x, box, {}, {}, {}};
  search_box(search, index.clusters.middle.size(), [](std::int32_t) { return true; });
  return run(search);
}

std::vector<std::int32_t> near_elements(const Mesh& mesh, CutIndex& index, std::span<const Vec3> x,
                                        const BandBox& box, std::span<const std::int32_t> begin) {
  Search search{mesh, index, x, box, {}, {}, {}};
  search_box(search, index.clusters.n_with_surface,
             [&](std::int32_t i) { return index.is_surface[i] != 0; });
  for (const std::int32_t e : begin)
    for (const std::int32_t i : mesh.corners(e)) put_in_queue(search, i);
  return run(search);
}

}  // namespace trocar
