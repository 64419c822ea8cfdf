#include "cutting/cut_plane_present.h"

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

// Calls use(e, ratio) for all elements that the cut changes.
template <class Use>
void for_changed(const PlanePatch& before, const PlanePatch& after, const Use& use) {
  const double least = least_ratio(before);
  const std::vector<Vec2> present = taken_along(before, after);
  for (int e = 0; e < after.n_elements(); ++e)
    if (const double A = area(after, e); A != before.area[e] || after.corner[e] != before.corner[e])
      use(e, area_in(present, after.corner[e]) / (A * least));
}

}  // namespace

void pull_back(const PlanePatch& before, std::span<const std::uint8_t> is_cut, PlanePatch& after) {
  if (before.present.empty()) return;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<std::uint8_t> is_pulled(after.node.size(), 0);
    bool is_done = true;
    for_changed(before, after, [&](int e, double ratio) {
      if (ratio >= least_present_ratio) return;
      for (const int i : after.corner[e])
        if (is_cut[i] == 0 && after.x[i] != before.X[i]) is_pulled[i] = 1, is_done = false;
    });
    if (is_done) return;
    for (std::size_t i = 0; i < is_pulled.size(); ++i)
      if (is_pulled[i] != 0) after.x[i] = 0.5 * (after.x[i] + before.X[i]);
  }
}

Crushed find_crushed(const PlanePatch& before, const PlanePatch& after) {
  Crushed crushed;
  if (before.present.empty()) return crushed;
  for_changed(before, after, [&](int e, double ratio) {
    if (ratio >= crushed.ratio) return;
    const auto& [a, b, c] = after.corner[e];
    crushed = {ratio, (after.x[a] + after.x[b] + after.x[c]) / 3};
  });
  return crushed;
}

}  // namespace trocar
