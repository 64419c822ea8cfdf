#include "cutting/cut_go_on.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/box.h"
#include "base/sort_unique.h"

namespace trocar {

// Over h: how far from its own crossings a stroke looks for those of others, and how far beside its
// surface they may lie.
static constexpr double reach_along = 1, reach_beside = 0.35;
static constexpr double along_it = 0.87;  // of the angle between the surfaces

// Each once, by its coordinates.
static void sort_points(std::vector<SurfacePoint>& points) {
  const auto key = [](const SurfacePoint& p) {
    return std::array{p.X.x(), p.X.y(), p.X.z(), p.N.x(), p.N.y(), p.N.z()};
  };
  std::ranges::sort(points, {}, key);
  const auto same = std::ranges::unique(points, {}, key);
  points.erase(same.begin(), same.end());
}

void add_left(const CutLeft& more, CutLeft& left) {
  left.hit.insert(left.hit.end(), more.hit.begin(), more.hit.end());
  sort_hits(left.hit);
  left.node.insert(left.node.end(), more.node.begin(), more.node.end());
  sort_unique(left.node);
  left.parted.insert(left.parted.end(), more.parted.begin(), more.parted.end());
  sort_points(left.parted);
}

static std::vector<SurfacePoint> parted_points(const CutStroke& stroke) {
  std::vector<SurfacePoint> points;
  for (const CutHit& hit : stroke.hit)
    if (find_element(stroke.opened, hit.element) != nullptr) points.push_back({hit.X, hit.N});
  return points;
}

static std::vector<CutHit> unparted_hits(const CutStroke& stroke) {
  std::vector<CutHit> hits = stroke.hit;
  std::erase_if(
      hits, [&](const CutHit& hit) { return find_element(stroke.side, hit.element) != nullptr; });
  return hits;
}

CutLeft left_by(const CutStroke& stroke) {
  CutLeft left = stroke.left;
  add_left(
      {.hit = unparted_hits(stroke), .node = stroke.surface_node, .parted = parted_points(stroke)},
      left);
  return left;
}

// Of the stroke's sides: +1 as the earlier one had them, -1 the other way round, 0 not along it.
static int agreement(const CutHit& left, std::span<const CutHit> found, double h) {
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
      std::abs(cosine) < along_it)
    return 0;
  return cosine > 0 ? 1 : -1;
}

void take_up_left(const Mesh& mesh, std::span<const CutHit> found, CutStroke& stroke) {
  if (stroke.left.hit.empty()) return;
  Box around;
  for (const CutHit& hit : found) around.add(hit.X);
  std::vector<CutHit> taken, left;
  std::vector<std::int32_t> node;
  for (const CutHit& hit : stroke.left.hit) {
    const bool is_near = around.holds(hit.X, reach_along * stroke.mean_edge);
    const int agrees = is_near ? agreement(hit, found, stroke.mean_edge) : 0;
    (agrees == 0 ? left : taken).push_back(hit);
    if (agrees == 0) continue;
    if (agrees < 0) {
      taken.back().is_first_plus = !hit.is_first_plus;
      taken.back().N = -hit.N;
    }
    stroke.fresh.push_back(hit.element);
    for (const std::int32_t i : mesh.corners(hit.element)) node.push_back(i);
  }
  if (taken.empty()) return;
  stroke.left.hit = std::move(left);
  sort_unique(stroke.fresh);
  stroke.hit.insert(stroke.hit.end(), taken.begin(), taken.end());  // its own come first
  sort_hits(stroke.hit);
  std::erase_if(node,
                [&](std::int32_t i) { return !std::ranges::binary_search(stroke.left.node, i); });
  stroke.surface_node.insert(stroke.surface_node.end(), node.begin(), node.end());
  sort_unique(stroke.surface_node);
}

}  // namespace trocar
