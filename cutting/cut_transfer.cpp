// Hosts by walking from the node's star across facets; validity element by element.
#include "cutting/cut_transfer.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "mesh/barycentric.h"

namespace trocar {

// A host may be this far outside (barycentric): where the outer surface is curved, or between the
// halves of an opened facet.
static constexpr double farthest_outside = 0.5;
// Barycentric: no other element holds such a point.
static constexpr double clearly_inside = 1e-6;
// Present volume over reference volume after the move, against the least around before it.
static constexpr double least_volume_ratio = 0.2;

static double least(const std::array<double, 4>& b) {
  return *std::min_element(b.begin(), b.end());
}

// The element that holds X or, at the boundary, comes nearest to it.
static NodeTransfer find_host(const CutPatch& patch, std::int32_t i, const Vec3& X) {
  NodeTransfer best{i, -1, {}};
  for (const std::int32_t e : patch.star(i)) {
    const std::array<double, 4> b = barycentric(patch.corner[e], patch.X, X);
    if (best.host < 0 || least(b) > least(best.weight)) best = {i, e, b};
    if (least(best.weight) > clearly_inside) return best;
  }
  for (int step = 0; step < 8 && least(best.weight) < 0; ++step) {
    const auto f = std::min_element(best.weight.begin(), best.weight.end()) - best.weight.begin();
    const std::int32_t u = patch.across[best.host][f];
    if (u < 0) break;
    const std::array<double, 4> b = barycentric(patch.corner[u], patch.X, X);
    if (least(b) <= least(best.weight)) break;
    best = {i, u, b};
  }
  // Past parts of split elements a walk may lead nowhere.
  for (std::int32_t e = 0; e < patch.n_elements() && least(best.weight) < -farthest_outside; ++e)
    if (const std::array<double, 4> b = barycentric(patch.corner[e], patch.X, X);
        least(b) > least(best.weight))
      best = {i, e, b};
  return best;
}

// Present over reference volume of the elements around; what was inverted before is not ours to
// judge.
static bool is_valid(const CutPatch& patch, std::int32_t e, const std::vector<Vec3>& X,
                     const std::vector<Vec3>& x) {
  const std::array<std::int32_t, 4>& c = patch.corner[e];
  const double V0 = six_volumes(patch.X, c), v0 = six_volumes(patch.x, c);
  const double V = six_volumes(X, c), v = six_volumes(x, c);
  if (!(V > 0)) return false;
  return v > 0 && v * V0 >= least_volume_ratio * std::min(v0, V0) * V;
}

std::vector<std::int32_t> elements_around(const CutPatch& patch,
                                          std::span<const NodeTransfer> transfer) {
  std::vector<std::int32_t> element;
  for (const NodeTransfer& t : transfer)
    element.insert(element.end(), patch.star(t.node).begin(), patch.star(t.node).end());
  sort_unique(element);
  return element;
}

std::vector<NodeTransfer> transfer_moves(const CutPatch& patch, std::vector<Vec3>& X) {
  std::vector<NodeTransfer> transfer;
  std::vector<Vec3> x = patch.x;
  std::vector<std::uint8_t> is_halved(patch.node.size());
  constexpr int n_halvings = 6;  // then back to where it was
  for (int round = 0;; ++round) {
    std::fill(is_halved.begin(), is_halved.end(), std::uint8_t{0});
    transfer.clear();
    for (std::int32_t i = 0; i < patch.n_nodes(); ++i) {
      x[i] = patch.x[i];
      if (X[i] == patch.X[i]) continue;
      transfer.push_back(find_host(patch, i, X[i]));
      x[i] = interpolate(patch.corner[transfer.back().host], transfer.back().weight, patch.x);
      if (least(transfer.back().weight) < -farthest_outside) is_halved[i] = 1;
    }
    for (const std::int32_t e : elements_around(patch, transfer))
      if (!is_valid(patch, e, X, x))
        for (const std::int32_t j : patch.corner[e]) is_halved[j] = 1;
    bool is_done = true;
    for (const NodeTransfer& t : transfer) {
      if (is_halved[t.node] == 0) continue;
      const Vec3& from = patch.X[t.node];
      X[t.node] = round < n_halvings ? Vec3(from + 0.5 * (X[t.node] - from)) : from;
      is_done = false;
    }
    if (is_done) return transfer;
  }
}

}  // namespace trocar
