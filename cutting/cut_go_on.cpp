#include "cutting/cut_go_on.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "base/box.h"
#include "base/sort_unique.h"
#include "cutting/cut_rim.h"

namespace trocar {

// Over h: how far from its own crossings a stroke looks for those of others, and how far beside its
// surface they may lie.
static constexpr double reach_along = 1, reach_beside = 0.35;
// Cosine of the angle between the surfaces. Blades that cross at once must not take each other's
// sides for theirs where they do.
static constexpr double along_left = 0.87, along_beside = 0.966;

template <class T, class Key>
static void add_each_once(const std::vector<T>& more, const Key& key, std::vector<T>& places) {
  places.insert(places.end(), more.begin(), more.end());
  sort_unique_by(places, key);
}

static std::array<double, 3> by_place(const Vec3& X) {
  return {X.x(), X.y(), X.z()};
}

static std::array<double, 6> by_point(const SurfacePoint& p) {
  return {p.X.x(), p.X.y(), p.X.z(), p.N.x(), p.N.y(), p.N.z()};
}

static void add_numbers(const std::vector<std::int32_t>& more, std::vector<std::int32_t>& numbers) {
  numbers.insert(numbers.end(), more.begin(), more.end());
  sort_unique(numbers);
}

// Of the elements of `opened`.
static void add_masks(const std::vector<OfElement<std::uint8_t>>& more,
                      std::vector<OfElement<std::uint8_t>>& opened) {
  for (auto& [e, mask] : opened)
    if (const std::uint8_t* other = find_element(more, e))
      mask = static_cast<std::uint8_t>(mask | *other);
}

static auto knows(const CutKnown& known) {
  return [&known](std::int32_t e) {
    return std::ranges::binary_search(known.hit, e, {}, &CutHit::element);
  };
}

static void add_known(const CutKnown& more, CutKnown& known) {
  const auto is_known = knows(more);
  std::erase_if(known.hit, [&](const CutHit& hit) { return is_known(hit.element); });
  std::erase_if(known.side, [&](const auto& entry) { return is_known(entry.element); });
  const auto n_kept = static_cast<std::ptrdiff_t>(known.hit.size());
  known.hit.insert(known.hit.end(), more.hit.begin(), more.hit.end());
  std::ranges::inplace_merge(known.hit, known.hit.begin() + n_kept, {}, &CutHit::key);
  merge_elements(known.side, more.side);
  std::vector<OfElement<std::uint8_t>> opened = more.opened;
  add_masks(known.opened, opened);
  merge_elements(known.opened, opened);
  add_numbers(more.surface_node, known.surface_node);
  add_numbers(more.parted_node, known.parted_node);
}

static void add_surface(const std::vector<SurfacePoint>& parted,
                        const std::vector<SurfacePoint>& at_end, const std::vector<Vec3>& rim,
                        CutLeft& left) {
  add_each_once(parted, by_point, left.parted);
  add_each_once(at_end, by_point, left.at_end);
  add_each_once(rim, by_place, left.rim);
}

void add_left(const CutLeft& other, CutStroke& stroke) {
  add_known(other, stroke.left);
  add_surface(other.parted, other.at_end, other.rim, stroke.left);
  // With what a third blade has parted, but for what it parts from now on: of 288 pairs of blades
  // that met, keeping that parted two more.
  stroke.beside = {};
  stroke.taken.clear();
}

static std::vector<SurfacePoint> parted_points(const CutStroke& stroke) {
  std::vector<SurfacePoint> points;
  for (const CutHit& hit : stroke.hit)
    if (find_element(stroke.opened, hit.element) != nullptr) points.push_back({hit.X, hit.N});
  return points;
}

CutLeft left_by(const CutStroke& stroke) {
  CutLeft left = stroke.left;
  add_known(stroke, left);
  add_surface(parted_points(stroke), {}, stroke.rim, left);
  if (stroke.mean_edge > 0) keep_ends(stroke.mean_edge, left);
  return left;
}

// Of the stroke's sides: +1 as the earlier one had them, -1 the other way round, 0 not along it.
static int agreement(const CutHit& left, std::span<const CutHit> found, double h,
                     double least_cosine) {
  const CutHit* nearest = nullptr;
  double least = reach_along * h;
  for (const CutHit& hit : found)
    if (const double distance = (hit.X - left.X).norm(); distance < least) {
      least = distance;
      nearest = &hit;
    }
  if (nearest == nullptr) return 0;
  const double cosine = nearest->N.dot(left.N);
  if (std::abs(nearest->N.dot(left.X - nearest->X)) > reach_beside * h ||
      std::abs(cosine) < least_cosine)
    return 0;
  return cosine > 0 ? 1 : -1;
}

// Of an element whose crossings these are.
static int agreement(std::span<const CutHit> left, std::span<const CutHit> found, double h,
                     double least_cosine) {
  for (const CutHit& hit : left)
    if (const int agrees = agreement(hit, found, h, least_cosine); agrees != 0) return agrees;
  return 0;
}

namespace {

// A crossing as the stroke has it, and its sides: -1 where the one that left it had them the other
// way round.
struct TakenHit {
  CutHit hit;
  int agrees;
};

// What is taken up; of elements, ascending.
struct TakenUp {
  std::vector<std::int32_t> element;
  std::vector<TakenHit> hit;
  std::vector<OfElement<std::int8_t>> side;
  std::vector<OfElement<std::uint8_t>> opened;
};

}  // namespace

// What is known of an element but for its crossings.
static void take_up_element(const Mesh& mesh, const CutKnown& from, std::int32_t e, int agrees,
                            CutStroke& stroke, TakenUp& taken) {
  taken.element.push_back(e);
  const std::int8_t* side = find_element(from.side, e);
  if (side != nullptr && find_element(stroke.side, e) == nullptr)
    taken.side.push_back({e, static_cast<std::int8_t>(agrees * *side)});
  if (const std::uint8_t* mask = find_element(from.opened, e)) taken.opened.push_back({e, *mask});
  for (const std::int32_t i : mesh.corners(e)) {
    if (std::ranges::binary_search(from.surface_node, i)) stroke.surface_node.push_back(i);
    if (std::ranges::binary_search(from.parted_node, i)) stroke.parted_node.push_back(i);
  }
}

static void add_to_stroke(TakenUp& taken, CutStroke& stroke) {
  merge_elements(stroke.side, taken.side);
  add_masks(stroke.opened, taken.opened);
  merge_elements(stroke.opened, taken.opened);
  taken.side.clear();
  taken.opened.clear();
}

// Elements near crossings of `found`, with theirs.
static TakenUp take_up_crossed(const Mesh& mesh, std::span<const CutHit> found, double least_cosine,
                               CutKnown& from, CutStroke& stroke) {
  Box around;
  for (const CutHit& hit : found) around.add(hit.X);
  const auto is_near = [&](const CutHit& hit) {
    return around.holds(hit.X, reach_along * stroke.mean_edge);
  };
  TakenUp taken;
  std::vector<CutHit> left;
  const std::vector<CutHit>& all = from.hit;
  for (auto begin = all.begin(), end = begin; begin != all.end(); begin = end) {
    while (end != all.end() && end->element == begin->element) ++end;
    const std::span<const CutHit> hits(begin, end);
    const int agrees = std::ranges::any_of(hits, is_near)
                           ? agreement(hits, found, stroke.mean_edge, least_cosine)
                           : 0;
    if (agrees == 0) {
      left.insert(left.end(), begin, end);
      continue;
    }
    for (CutHit hit : hits) {
      hit.is_first_plus = hit.is_first_plus == (agrees > 0);
      hit.N *= agrees;
      taken.hit.push_back({hit, agrees});
      stroke.hit.push_back(hit);
    }
    take_up_element(mesh, from, begin->element, agrees, stroke, taken);
  }
  from.hit = std::move(left);
  add_to_stroke(taken, stroke);
  return taken;
}

// The nearest within `reach` [m] of X, nullptr if there is none.
static const TakenHit* nearest_to(const Vec3& X, const std::vector<TakenHit>& taken, double reach) {
  const auto distance = [&](const TakenHit& t) { return (t.hit.X - X).squaredNorm(); };
  const auto nearest = std::ranges::min_element(taken, {}, distance);
  return nearest != taken.end() && distance(*nearest) < reach * reach ? &*nearest : nullptr;
}

// Elements that have a side, but no crossing, beside those that are taken up.
static void take_up_uncrossed(const Mesh& mesh, const CutKnown& from, CutStroke& stroke,
                              TakenUp& taken) {
  Box around;
  for (const TakenHit& t : taken.hit) around.add(t.hit.X);
  const double reach = reach_along * stroke.mean_edge;
  for (const auto& [e, side] : from.side) {
    const Vec3 X = element_centre(mesh, e);
    if (!around.holds(X, reach) || find_element(stroke.side, e) != nullptr || knows(from)(e))
      continue;
    if (const TakenHit* beside = nearest_to(X, taken.hit, reach))
      take_up_element(mesh, from, e, beside->agrees, stroke, taken);
  }
  add_to_stroke(taken, stroke);
}

// Where the earlier strokes ended there: beyond, nothing is parted.
static void take_up_rim(const std::vector<TakenHit>& taken, CutStroke& stroke) {
  const double h = stroke.mean_edge;
  const auto is_taken = [&](const Vec3& R) {
    const TakenHit* nearest = nearest_to(R, taken, reach_along * h);
    return nearest != nullptr &&
           std::abs(nearest->hit.N.dot(R - nearest->hit.X)) <= reach_beside * h;
  };
  std::vector<Vec3>& left = stroke.left.rim;
  const auto kept = std::ranges::stable_partition(left, std::not_fn(is_taken));
  stroke.rim.insert(stroke.rim.end(), kept.begin(), kept.end());
  left.erase(kept.begin(), kept.end());
}

static TakenUp take_up(const Mesh& mesh, std::span<const CutHit> found, double least_cosine,
                       CutKnown& from, CutStroke& stroke) {
  if (from.hit.empty() || found.empty()) return {};
  TakenUp taken = take_up_crossed(mesh, found, least_cosine, from, stroke);
  if (taken.hit.empty()) return {};
  take_up_uncrossed(mesh, from, stroke, taken);
  sort_unique(taken.element);
  add_numbers(taken.element, stroke.fresh);
  std::erase_if(from.side, [&](const auto& entry) {
    return std::ranges::binary_search(taken.element, entry.element) &&
           find_element(stroke.side, entry.element) != nullptr;
  });
  sort_hits(stroke.hit);  // its own come first
  sort_unique(stroke.surface_node);
  sort_unique(stroke.parted_node);
  return taken;
}

static void take_up_beside(const Mesh& mesh, std::span<const CutHit> found, CutStroke& stroke) {
  add_numbers(take_up(mesh, found, along_beside, stroke.beside, stroke).element, stroke.taken);
}

void take_up_left(const Mesh& mesh, std::span<const CutHit> found, CutStroke& stroke) {
  take_up_rim(take_up(mesh, found, along_left, stroke.left, stroke).hit, stroke);
  take_up_beside(mesh, found, stroke);
}

CutKnown known_around(const MeshEdit& edit, std::int32_t n_nodes, const CutIndex& index,
                      const CutStroke& stroke) {
  CutKnown known;
  known.parted_node = edit.duplicate_parent;
  for (std::int32_t k = 0; k < std::ssize(edit.duplicate_parent); ++k)
    known.parted_node.push_back(n_nodes + k);
  sort_unique(known.parted_node);
  std::ranges::set_intersection(stroke.surface_node, known.parted_node,
                                std::back_inserter(known.surface_node));
  const std::vector<std::int32_t> around = elements_around(index, known.parted_node);
  for (const std::span<const CutHit> hits : hits_of(stroke, around))
    known.hit.insert(known.hit.end(), hits.begin(), hits.end());
  for (const std::int32_t e : around) {
    if (const std::int8_t* side = find_element(stroke.side, e)) known.side.push_back({e, *side});
    if (const std::uint8_t* mask = find_element(stroke.opened, e))
      known.opened.push_back({e, *mask});
  }
  return known;
}

void go_on_beside(const Mesh& mesh, const CutKnown& other, CutStroke& stroke) {
  add_known(other, stroke.beside);
  Box around;
  for (const CutHit& hit : other.hit) around.add(hit.X);
  std::vector<CutHit> found;
  for (const CutHit& hit : stroke.hit)
    if (around.holds(hit.X, reach_along * stroke.mean_edge) &&
        !std::ranges::binary_search(stroke.taken, hit.element))
      found.push_back(hit);
  take_up_beside(mesh, found, stroke);
}

}  // namespace trocar
