#include "cutting/cut_rim.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/sort_unique.h"

namespace trocar {

// Over h: how far from a point of the rim its direction and crossings on both sides are looked for;
// crossings nearer to it are of neither side, ones farther beside the surface of another one.
static constexpr double rim_reach = 1.25, rim_nearest = 0.2, rim_beside = 0.35;
static constexpr double cosine_across_rim = 0.77;  // of the way to a crossing with that across

static Vec3 direction_at(const std::vector<Vec3>& rim, const Vec3& R, double h) {
  Mat3 spread = Mat3::Zero();
  for (const Vec3& other : rim)
    if (const Vec3 d = other - R; d.squaredNorm() < rim_reach * rim_reach * h * h)
      spread += d * d.transpose();
  return Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(2);
}

static bool is_covered(const CutStroke& stroke, const Vec3& R) {
  const double h = stroke.mean_edge;
  std::vector<const CutHit*> near;
  for (const CutHit& hit : stroke.hit)
    if ((hit.X - R).squaredNorm() < rim_reach * rim_reach * h * h) near.push_back(&hit);
  if (near.empty()) return false;
  const auto distance = [&](const CutHit* hit) { return (hit->X - R).squaredNorm(); };
  const Vec3 N = (*std::ranges::min_element(near, {}, distance))->N;
  const Vec3 across = direction_at(stroke.rim, R, h).cross(N).normalized();
  const auto is_passed = [&](double sign) {
    return std::ranges::any_of(near, [&](const CutHit* hit) {
      const Vec3 d = hit->X - R;
      return d.norm() > rim_nearest * h && std::abs(N.dot(d)) < rim_beside * h &&
             sign * across.dot(d) > cosine_across_rim * d.norm();
    });
  };
  return is_passed(1) && is_passed(-1);
}

void drop_covered_rim(CutStroke& stroke) {
  std::vector<Vec3> rim;
  for (const Vec3& R : stroke.rim)
    if (!is_covered(stroke, R)) rim.push_back(R);
  stroke.rim = std::move(rim);
}

// How far from the ends of a slit it is remembered, over h.
static constexpr double reach_of_ends = 2;

namespace {

class SlitEnds {
 public:
  SlitEnds(const std::vector<Vec3>& rim, double h) : point_(rim), reach_(reach_of_ends * h) {
    std::ranges::sort(point_, {}, x_of);
  }

  bool are_near(const Vec3& X) const {
    const auto begin = std::ranges::lower_bound(point_, X.x() - reach_, {}, x_of);
    return std::any_of(begin, std::ranges::upper_bound(point_, X.x() + reach_, {}, x_of),
                       [&](const Vec3& end) { return (end - X).squaredNorm() < reach_ * reach_; });
  }

 private:
  static double x_of(const Vec3& X) { return X.x(); }
  std::vector<Vec3> point_;  // ascending x
  double reach_;             // [m]
};

}  // namespace

template <class T>
static void keep_elements(const std::vector<std::int32_t>& kept,
                          std::vector<OfElement<T>>& values) {
  std::erase_if(
      values, [&](const auto& entry) { return !std::ranges::binary_search(kept, entry.element); });
}

void keep_ends(double h, CutLeft& left) {
  const SlitEnds ends(left.rim, h);
  std::vector<std::int32_t> crossed, kept;
  for (const CutHit& hit : left.hit) {
    crossed.push_back(hit.element);
    if (ends.are_near(hit.X) || find_element(left.side, hit.element) == nullptr)
      kept.push_back(hit.element);
  }
  sort_unique(crossed);
  sort_unique(kept);
  for (const auto& [e, side] : left.side)
    if (!std::ranges::binary_search(crossed, e)) kept.push_back(e);
  std::ranges::sort(kept);
  keep_elements(kept, left.side);
  keep_elements(kept, left.opened);
  std::erase_if(left.hit,
                [&](const CutHit& hit) { return !std::ranges::binary_search(kept, hit.element); });
  left.at_end.clear();
  std::ranges::copy_if(left.parted, std::back_inserter(left.at_end),
                       [&](const SurfacePoint& p) { return ends.are_near(p.X); });
}

void forget_uncrossed(const Mesh& mesh, CutStroke& stroke) {
  const SlitEnds ends(stroke.rim, stroke.mean_edge);
  std::erase_if(stroke.side, [&](const auto& entry) {
    if (std::ranges::binary_search(stroke.hit, entry.element, {}, &CutHit::element)) return false;
    const auto corner = mesh.corners(entry.element);
    return std::ranges::none_of(corner, [&](std::int32_t i) { return ends.are_near(mesh.X[i]); });
  });
}

}  // namespace trocar
