#include "mesh/surface_edit.h"

#include <algorithm>
#include <iterator>

#include "base/sort_unique.h"

namespace trocar {

namespace {

// Of the elements alone.
Surface fresh_surface(const Mesh& mesh, const SurfaceEdit& edit) {
  const std::vector<std::uint8_t> is_boundary = boundary_facets(edit.around.mesh);
  Surface fresh;
  std::size_t k = 0;
  for (const std::int32_t e : edit.elements) {
    while (edit.around.element[k] != e) ++k;
    for (int f = 0; f < n_facets(mesh.element_type[e]); ++f)
      if ((is_boundary[k] >> f & 1) != 0) add_facet(fresh, mesh, e, f);
  }
  return fresh;
}

// Triangles [begin, end) of the surface before the edit, or of the fresh ones.
struct Run {
  std::size_t begin, end;
  bool is_fresh;
};

// Ascending by element: those of `fresh` in place of the old ones of the edited elements.
std::vector<Run> merged_runs(const Surface& old, const Surface& fresh,
                             std::span<const std::int32_t> elements) {
  std::vector<Run> runs;
  auto from = old.element.begin(), from_fresh = fresh.element.begin();
  const auto add = [&](auto begin, auto end, auto first, bool is_fresh) {
    if (begin != end)
      runs.push_back({static_cast<std::size_t>(begin - first),
                      static_cast<std::size_t>(end - first), is_fresh});
  };
  for (const std::int32_t e : elements) {
    const auto begin = std::lower_bound(from, old.element.end(), e);
    const auto end_fresh = std::upper_bound(from_fresh, fresh.element.end(), e);
    add(from, begin, old.element.begin(), false);
    add(from_fresh, end_fresh, fresh.element.begin(), true);
    from = std::upper_bound(begin, old.element.end(), e);
    from_fresh = end_fresh;
  }
  add(from, old.element.end(), old.element.begin(), false);
  return runs;
}

template <class T>
void merge(const std::vector<T>& fresh, std::span<const Run> runs, std::vector<T>& values) {
  std::vector<T> merged;
  merged.reserve(values.size() + fresh.size());
  for (const Run& run : runs) {
    const std::vector<T>& from = run.is_fresh ? fresh : values;
    merged.insert(merged.end(), from.begin() + static_cast<std::ptrdiff_t>(run.begin),
                  from.begin() + static_cast<std::ptrdiff_t>(run.end));
  }
  values = std::move(merged);
}

// Only facets between the edit's nodes change: the other nodes stay on the surface or off it.
std::vector<std::int32_t> merged_nodes(const Surface& old, const Surface& fresh,
                                       std::span<const std::int32_t> nodes) {
  std::vector<std::int32_t> kept, of_fresh, here, all;
  std::set_difference(old.node.begin(), old.node.end(), nodes.begin(), nodes.end(),
                      std::back_inserter(kept));
  for (const std::array<std::int32_t, 3>& triangle : fresh.triangle)
    of_fresh.insert(of_fresh.end(), triangle.begin(), triangle.end());
  sort_unique(of_fresh);
  std::set_intersection(of_fresh.begin(), of_fresh.end(), nodes.begin(), nodes.end(),
                        std::back_inserter(here));
  std::merge(kept.begin(), kept.end(), here.begin(), here.end(), std::back_inserter(all));
  return all;
}

}  // namespace

void update_surface(const Mesh& mesh, const SurfaceEdit& edit, Surface& surface) {
  if (mesh.dimension() == 2) {
    surface = boundary_surface(mesh);
    return;
  }
  const Surface fresh = fresh_surface(mesh, edit);
  const std::vector<Run> runs = merged_runs(surface, fresh, edit.elements);
  merge(fresh.triangle, runs, surface.triangle);
  merge(fresh.is_cut, runs, surface.is_cut);
  merge(fresh.is_quad_half, runs, surface.is_quad_half);
  merge(fresh.element, runs, surface.element);
  surface.node = merged_nodes(surface, fresh, edit.nodes);
}

}  // namespace trocar
