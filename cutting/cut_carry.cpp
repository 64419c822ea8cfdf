// Material points by barycentric coordinates; edits between two frames are met by keeping the
// reference position.
#include "cutting/cut_carry.h"

#include <algorithm>
#include <array>

namespace trocar {

// A point this far outside (barycentric) still counts as inside: rounding at facets.
static constexpr double tolerance = 1e-9;
// A point outside goes with the element beside it up to this far (barycentric, heights):
// tissue that runs from the blade and comes back must not pass it uncut.
static constexpr double reach = 3.0;

static std::array<double, 4> barycentric(const Mesh& mesh, std::int32_t e, std::span<const Vec3> X,
                                         const Vec3& point) {
  const std::span<const std::int32_t> c = mesh.corners(e);
  Mat3 D;
  for (int k = 0; k < 3; ++k) D.col(k) = X[c[k + 1]] - X[c[0]];
  const Vec3 b = D.inverse() * (point - X[c[0]]);
  return {1 - b.x() - b.y() - b.z(), b.x(), b.y(), b.z()};
}

static Vec3 at(const Mesh& mesh, std::int32_t e, std::span<const Vec3> X,
               const std::array<double, 4>& b) {
  Vec3 point = Vec3::Zero();
  for (std::size_t a = 0; a < 4; ++a) point += b[a] * X[mesh.corners(e)[a]];
  return point;
}

// Cheaper than barycentric coordinates, and rarely true. `margin` [m].
static bool box_holds(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x, const Vec3& point,
                      double margin) {
  Vec3 low = x[mesh.corners(e)[0]], high = low;
  for (const std::int32_t i : mesh.corners(e).subspan(1)) {
    low = low.cwiseMin(x[i]);
    high = high.cwiseMax(x[i]);
  }
  return ((point - low).array() >= -margin).all() && ((high - point).array() >= -margin).all();
}

// `last`: element that the point went with before, -1 for none.
static BladePoint locate(const Mesh& mesh, std::span<const Vec3> x,
                         std::span<const std::int32_t> near, std::int32_t last, const Vec3& point,
                         double margin) {
  BladePoint best{.x = point};
  double most = -reach;
  const auto try_element = [&](std::int32_t e) {
    const std::array<double, 4> b = barycentric(mesh, e, x, point);
    const double least = *std::min_element(b.begin(), b.end());
    if (least <= most) return;
    most = least;
    best = {e, least >= -tolerance, at(mesh, e, mesh.X, b), point};
  };
  for (const std::int32_t e : near) {
    if (box_holds(mesh, e, x, point, margin)) try_element(e);
    if (most >= 0) return best;
  }
  if (last >= 0) try_element(last);
  return best;
}

// Whether an element holds some of the points that divide the pieces of a polyline into four.
static bool holds_some(const Mesh& mesh, std::span<const Vec3> x, std::int32_t e,
                       std::span<const Vec3> line) {
  constexpr int parts = 4;
  for (std::size_t k = 0; k + 1 < line.size(); ++k)
    for (int j = 0; j <= parts; ++j) {
      const Vec3 point = line[k] + (line[k + 1] - line[k]) * (1.0 * j / parts);
      if (!box_holds(mesh, e, x, point, 0)) continue;
      const std::array<double, 4> b = barycentric(mesh, e, x, point);
      if (*std::min_element(b.begin(), b.end()) >= 0) return true;
    }
  return false;
}

void remember_edge(const Mesh& mesh, std::span<const Vec3> x, const BladeSweep& sweep,
                   std::span<const std::int32_t> near, CutStroke& stroke) {
  const auto locate_from = [&](std::int32_t last, const Vec3& point) {
    return locate(mesh, x, near, last, point, stroke.mean_edge);
  };
  const std::vector<BladePoint> last = std::move(stroke.edge);
  if (last.empty() && std::ranges::any_of(sweep.before, [&](const Vec3& point) {
        return locate_from(-1, point).is_inside;
      }))
    stroke.ends_in_tissue = true;
  stroke.edge.clear();
  for (std::size_t k = 0; k < sweep.after.size(); ++k)
    stroke.edge.push_back(locate_from(k < last.size() ? last[k].element : -1, sweep.after[k]));
  if (stroke.edge.front().is_inside || stroke.edge.back().is_inside) stroke.ends_in_tissue = true;
  stroke.at_edge.clear();
  for (const std::int32_t e : near)
    if (holds_some(mesh, x, e, sweep.after)) stroke.at_edge.push_back(e);
}

BladeSweep carry_edge(const Mesh& mesh, std::span<const Vec3> x, const BladeSweep& sweep,
                      const CutStroke& stroke) {
  BladeSweep carried = sweep;
  if (stroke.edge.size() != sweep.before.size()) return carried;
  constexpr std::size_t none = ~std::size_t{0};
  std::vector<Vec3> way(stroke.edge.size(), Vec3::Zero());
  std::vector<std::size_t> inside;
  for (std::size_t k = 0; k < way.size(); ++k) {
    const BladePoint& p = stroke.edge[k];
    if (p.element < 0) continue;
    way[k] = at(mesh, p.element, x, barycentric(mesh, p.element, mesh.X, p.X)) - p.x;
    inside.push_back(k);
  }
  for (std::size_t k = 0; k < way.size(); ++k) {
    std::size_t nearest = none, least = none;
    for (const std::size_t j : inside) {
      const std::size_t distance = j > k ? j - k : k - j;
      if (distance >= least) continue;
      least = distance;
      nearest = j;
    }
    if (nearest != none) carried.before[k] += way[nearest];
  }
  return carried;
}

}  // namespace trocar
