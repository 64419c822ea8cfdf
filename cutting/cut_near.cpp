// Breadth-first search over the stars of nodes. A band's cut through the body is connected to the
// surface or to its begin, and passes from element to element through nodes of both.
#include "cutting/cut_near.h"

#include <algorithm>

#include "mesh/element_boxes.h"

namespace trocar {

// Beyond which sides of the box a node lies, in index.ring: bits 0 to 5; and how far the search is.
static constexpr unsigned all_sides = 63, is_searched = 64, is_queued = 128;

namespace {

struct NearSearch {
  const Mesh& mesh;
  CutIndex& index;
  std::span<const Vec3> x;
  const OrientedBox& box;
  Box around;                       // of `box`
  std::vector<std::int32_t> seen;   // nodes with a mark in index.ring
  std::vector<std::int32_t> queue;  // nodes
  NearElements found;
};

}  // namespace

// Of a node whose position nobody has asked for: no element that the box may meet has it.
static constexpr unsigned not_asked = all_sides;

static unsigned outside(const OrientedBox& box, const Vec3& p) {
  if (p.hasNaN()) return not_asked;
  const Vec3 q = box.axes.transpose() * p;
  unsigned code = 0;
  for (int d = 0; d < 3; ++d)
    code |= (q[d] < box.low[d] ? 1U << d : 0U) | (q[d] > box.high[d] ? 8U << d : 0U);
  return code;
}

static std::uint8_t& mark_of(NearSearch& search, std::int32_t i) {
  std::uint8_t& mark = search.index.ring[i];
  if (mark != no_ring) return mark;
  mark = static_cast<std::uint8_t>(outside(search.box, search.x[i]));
  search.seen.push_back(i);
  return mark;
}

static void put_in_queue(NearSearch& search, std::int32_t i) {
  std::uint8_t& mark = mark_of(search, i);
  if ((mark & is_queued) != 0) return;
  mark |= is_queued;
  search.queue.push_back(i);
}

// Takes up the elements around node i that no searched node has.
static void search_star(NearSearch& search, std::int32_t i) {
  for (const std::int32_t e : search.index.star(i)) {
    const std::span<const std::int32_t> corner = search.mesh.corners(e);
    unsigned common = all_sides, any = 0;
    bool is_asked = true;
    for (const std::int32_t j : corner) {
      const unsigned mark = mark_of(search, j);
      common &= mark;
      any |= mark;
      is_asked = is_asked && (mark & all_sides) != not_asked;
    }
    if (common != 0 || !is_asked || (any & is_searched) != 0) continue;
    if (!element_box(search.mesh, e, search.x).overlaps(search.around)) continue;
    const bool is_tet = search.mesh.element_type[e] == ElementType::tet4;
    (is_tet ? search.found.tets : search.found.hexahedra).push_back(e);
    for (const std::int32_t j : corner) put_in_queue(search, j);
  }
  mark_of(search, i) |= is_searched;
}

static NearElements run(NearSearch& search) {
  for (std::size_t k = 0; k < search.queue.size(); ++k) search_star(search, search.queue[k]);
  for (const std::int32_t i : search.seen) search.index.ring[i] = no_ring;
  std::ranges::sort(search.found.tets);
  std::ranges::sort(search.found.hexahedra);
  return std::move(search.found);
}

static NearSearch search_for(const Mesh& mesh, CutIndex& index, const PresentPositions& positions,
                             const OrientedBox& box) {
  return {mesh, index, positions.x(), box, box.around(), {}, {}, {}};
}

NearElements near_elements(const Mesh& mesh, CutIndex& index, PresentPositions& positions,
                           const OrientedBox& box) {
  NearSearch search = search_for(mesh, index, positions, box);
  for (const std::int32_t i : positions.nodes_near(box)) put_in_queue(search, i);
  return run(search);
}

NearElements near_elements(const Mesh& mesh, CutIndex& index, PresentPositions& positions,
                           const OrientedBox& box, std::span<const std::int32_t> begin) {
  NearSearch search = search_for(mesh, index, positions, box);
  for (const std::int32_t i : positions.nodes_near(box))
    if (index.is_surface[i] != 0) put_in_queue(search, i);
  for (const std::int32_t e : begin)
    for (const std::int32_t i : mesh.corners(e)) put_in_queue(search, i);
  return run(search);
}

}  // namespace trocar
