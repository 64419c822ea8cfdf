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

void append_triangle(const Surface& from, std::size_t t, Surface& surface) {
  surface.triangle.push_back(from.triangle[t]);
  surface.element.push_back(from.element[t]);
  surface.is_cut.push_back(from.is_cut[t]);
  surface.is_quad_half.push_back(from.is_quad_half[t]);
}

// Ascending by element: those of `fresh` in place of the old ones of the edited elements.
Surface merged(const Surface& old, const Surface& fresh, std::span<const std::int32_t> elements) {
  Surface surface;
  std::size_t next = 0;
  for (std::size_t t = 0; t < old.triangle.size(); ++t) {
    if (std::binary_search(elements.begin(), elements.end(), old.element[t])) continue;
    for (; next < fresh.triangle.size() && fresh.element[next] < old.element[t]; ++next)
      append_triangle(fresh, next, surface);
    append_triangle(old, t, surface);
  }
  for (; next < fresh.triangle.size(); ++next) append_triangle(fresh, next, surface);
  return surface;
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
  std::vector<std::int32_t> node = merged_nodes(surface, fresh, edit.nodes);
  surface = merged(surface, fresh, edit.elements);
  surface.node = std::move(node);
}

}  // namespace trocar
