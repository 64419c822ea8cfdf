// Material points by barycentric coordinates; edits between two frames are met by keeping the
// reference position.
#include "cutting/cut_carry.h"

#include <algorithm>
#include <array>

namespace trocar {

// A point this far outside (barycentric) still counts as inside: rounding at facets.
static constexpr double tolerance = 1e-9;

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

// Cheaper than barycentric coordinates, and rarely true.
static bool box_holds(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x,
                      const Vec3& point) {
  Vec3 low = x[mesh.corners(e)[0]], high = low;
  for (const std::int32_t i : mesh.corners(e).subspan(1)) {
    low = low.cwiseMin(x[i]);
    high = high.cwiseMax(x[i]);
  }
  const double margin = 1e-6 * (high - low).maxCoeff();  // far more than `tolerance` reaches
  return ((point - low).array() >= -margin).all() && ((high - point).array() >= -margin).all();
}

static BladePoint locate(const Mesh& mesh, std::span<const Vec3> x,
                         std::span<const std::int32_t> near, const Vec3& point) {
  for (const std::int32_t e : near) {
    if (!box_holds(mesh, e, x, point)) continue;
    const std::array<double, 4> b = barycentric(mesh, e, x, point);
    if (*std::min_element(b.begin(), b.end()) >= -tolerance)
      return {e, at(mesh, e, mesh.X, b), point};
  }
  return {-1, Vec3::Zero(), point};
}

void remember_edge(const Mesh& mesh, std::span<const Vec3> x, const BladeSweep& sweep,
                   std::span<const std::int32_t> near, CutStroke& stroke) {
  const auto is_inside = [&](const Vec3& point) {
    return locate(mesh, x, near, point).element >= 0;
  };
  if (stroke.edge.empty() && std::ranges::any_of(sweep.before, is_inside))
    stroke.ends_in_tissue = true;
  stroke.edge.clear();
  for (const Vec3& point : sweep.after) stroke.edge.push_back(locate(mesh, x, near, point));
  if (stroke.edge.front().element >= 0 || stroke.edge.back().element >= 0)
    stroke.ends_in_tissue = true;
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
