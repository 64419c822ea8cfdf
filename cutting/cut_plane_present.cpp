#include "cutting/cut_plane_present.h"

#include <algorithm>

#include "cutting/cut_plane_edit.h"

namespace trocar {

namespace {

constexpr int most_rounds = 8;  // of halved moves

// Where the cut takes the nodes in the deformed body.
std::vector<Vec2> taken_along(const PlanePatch& before, const PlanePatch& after) {
  std::vector<Vec2> present = before.present;
  for (int i = 0; i < after.n_nodes(); ++i) {
    if (after.x[i] == before.X[i]) continue;
    const Host host = find_host(before, i, after.x[i]);
    const auto& [a, b, c] = before.corner[host.element];
    present[i] = host.weight[0] * before.present[a] + host.weight[1] * before.present[b] +
                 host.weight[2] * before.present[c];
  }
  return present;
}

double area_in(const std::vector<Vec2>& x, const std::array<int, 3>& corner) {
  return triangle_area(x[corner[0]], x[corner[1]], x[corner[2]]);
}

double least_ratio(const PlanePatch& before) {
  double least = 1;
  for (int e = 0; e < before.n_elements(); ++e)
    least = std::min(least, area_in(before.present, before.corner[e]) / before.area[e]);
  return least;
}

// What has least; is_pulled (n_nodes) gets nodes beside the cut around elements with too little.
Crushed find_crushed(const PlanePatch& before, std::span<const std::uint8_t> is_cut,
                     double least_before, const PlanePatch& after,
                     std::vector<std::uint8_t>& is_pulled) {
  Crushed crushed;
  const std::vector<Vec2> present = taken_along(before, after);
  for (int e = 0; e < after.n_elements(); ++e) {
    const double A = area(after, e);
    if (A == before.area[e] && after.corner[e] == before.corner[e]) continue;
    const double ratio = area_in(present, after.corner[e]) / (A * least_before);
    const auto& [a, b, c] = after.corner[e];
    if (!(ratio >= crushed.ratio)) crushed = {ratio, (after.x[a] + after.x[b] + after.x[c]) / 3};
    if (ratio >= least_present_ratio) continue;
    for (const int i : {a, b, c})
      if (is_cut[i] == 0 && after.x[i] != before.X[i]) is_pulled[i] = 1;
  }
  return crushed;
}

}  // namespace

Crushed pull_back(const PlanePatch& before, std::span<const std::uint8_t> is_cut,
                  PlanePatch& after) {
  if (before.present.empty()) return {};
  const double least_before = least_ratio(before);
  for (int round = 0;; ++round) {
    std::vector<std::uint8_t> is_pulled(after.node.size(), 0);
    const Crushed crushed = find_crushed(before, is_cut, least_before, after, is_pulled);
    if (round == most_rounds || std::ranges::count(is_pulled, 1) == 0) return crushed;
    for (std::size_t i = 0; i < is_pulled.size(); ++i)
      if (is_pulled[i] != 0) after.x[i] = 0.5 * (after.x[i] + before.X[i]);
  }
}

}  // namespace trocar
