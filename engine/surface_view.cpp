#include "engine/surface_view.h"

#include <algorithm>

namespace trocar {

namespace {

// Calls use(node, value) for all surface nodes with a field's (n_local * 3) values.
template <class Use>
void gather(const SurfaceView& view, std::span<const double> field, Communicator& communicator,
            const Use& use) {
  std::vector<double> mine;
  mine.reserve(view.local.size() * 3);
  for (const std::int32_t local : view.local)
    for (std::size_t i = 0; i < 3; ++i)
      mine.push_back(field[static_cast<std::size_t>(local) * 3 + i]);
  const std::vector<double> all = communicator.all_gather(mine);
  for (std::size_t k = 0; k < view.node.size(); ++k)
    use(static_cast<std::size_t>(view.node[k]), Vec3(all[3 * k], all[3 * k + 1], all[3 * k + 2]));
}

}  // namespace

Box box_of(const SurfaceView& view) {
  Box box;
  for (const std::int32_t node : view.node) box.add(view.x[node]);
  return box;
}

SurfaceView make_surface_view(const Surface& surface, std::span<const std::int32_t> node_owner,
                              const Part& part) {
  SurfaceView view;
  update_surface_view(surface, node_owner, part, view);
  return view;
}

void update_surface_view(const Surface& surface, std::span<const std::int32_t> node_owner,
                         const Part& part, SurfaceView& view) {
  if (!view.x.empty()) view.x.resize(node_owner.size(), Vec3::Zero());
  view.node = surface.node;
  const auto owner = [&](std::int32_t node) { return node_owner[node]; };
  const auto by_owner = [&](std::int32_t a, std::int32_t b) { return owner(a) < owner(b); };
  if (!std::is_sorted(view.node.begin(), view.node.end(), by_owner))
    std::stable_sort(view.node.begin(), view.node.end(), by_owner);
  view.local.clear();
  for (const std::int32_t node : view.node)
    if (owner(node) == part.rank) view.local.push_back(part.node_local[node]);
}

void gather_surface(SurfaceView& view, std::span<const Vec3> X, std::span<const double> u,
                    Communicator& communicator) {
  if (view.x.empty()) view.x.assign(X.begin(), X.end());
  gather(view, u, communicator,
         [&](std::size_t node, const Vec3& value) { view.x[node] = X[node] + value; });
}

void gather_velocities(SurfaceView& view, std::span<const double> v, Communicator& communicator) {
  view.v.resize(view.x.size());
  gather(view, v, communicator, [&](std::size_t node, const Vec3& value) { view.v[node] = value; });
}

}  // namespace trocar
