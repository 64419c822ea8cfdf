// Cutting the patch out of the mesh: one cheap pass over all elements, everything else local.
#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/cut_plane_patch.h"
#include "mesh/facets.h"

namespace trocar {

namespace {

constexpr double cos_sharp = 0.8660254037844386;  // 30 degrees
constexpr double cos_straight = 1 - 1e-14;        // 1.4e-7 rad: area changes by rounding only

struct Extraction {
  const Mesh& mesh;
  NodeElements around;
  std::vector<int> local_element, local_node;  // -1 where not in the patch
};

Vec2 plane(const Vec3& X) {
  return {X.x(), X.y()};
}

// Does the segment come nearer to the triangle than the triangle's own size (by bounding boxes)?
bool is_near(const Mesh& mesh, std::int32_t e, const Vec2& p, const Vec2& q) {
  const std::span<const std::int32_t> node = mesh.corners(e);
  const Vec3 &a = mesh.X[node[0]], &b = mesh.X[node[1]], &c = mesh.X[node[2]];
  const Vec2 low(std::min({a.x(), b.x(), c.x()}), std::min({a.y(), b.y(), c.y()}));
  const Vec2 high(std::max({a.x(), b.x(), c.x()}), std::max({a.y(), b.y(), c.y()}));
  if (std::max(p.x(), q.x()) < low.x() || std::max(p.y(), q.y()) < low.y() ||
      std::min(p.x(), q.x()) > high.x() || std::min(p.y(), q.y()) > high.y())
    return false;
  const Vec2 d = q - p, normal(-d.y(), d.x());
  const double reach = 0.5 * (high - low).cwiseProduct(normal.cwiseAbs()).sum();
  return std::abs(normal.dot(0.5 * (low + high) - p)) <= reach;
}

// Adds the elements around a node that were not there.
void add_around(Extraction& extraction, std::int32_t i, std::vector<std::int32_t>& element) {
  extraction.local_node[i] = 0;
  for (const std::int32_t e : extraction.around.of(i))
    if (std::exchange(extraction.local_element[e], 0) < 0) element.push_back(e);
}

void choose_elements(Extraction& extraction, std::span<const Vec2> path, int rings) {
  const Mesh& mesh = extraction.mesh;
  std::vector<std::int32_t> element;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (std::size_t k = 0; k + 1 < path.size() && extraction.local_element[e] < 0; ++k)
      if (is_near(mesh, e, path[k], path[k + 1])) {
        extraction.local_element[e] = 0;
        element.push_back(e);
      }
  std::size_t begin = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t end = element.size();
    for (; begin < end; ++begin)
      for (const std::int32_t i : mesh.corners(element[begin]))
        if (extraction.local_node[i] < 0) add_around(extraction, i, element);
  }
  for (; begin < element.size(); ++begin)
    for (const std::int32_t i : mesh.corners(element[begin])) extraction.local_node[i] = 0;
}

// Gives those that are marked with 0 numbers in their order.
void number(std::vector<int>& local, std::vector<std::int32_t>& global) {
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (local[i] < 0) continue;
    local[i] = static_cast<int>(global.size());
    global.push_back(static_cast<std::int32_t>(i));
  }
}

void number_all(Extraction& extraction, PlanePatch& patch) {
  number(extraction.local_element, patch.element);
  number(extraction.local_node, patch.node);
  patch.X.reserve(patch.node.size());
  for (const std::int32_t i : patch.node) patch.X.push_back(plane(extraction.mesh.X[i]));
  patch.x = patch.X;
}

bool contains(std::span<const std::int32_t> node, std::int32_t i) {
  return node[0] == i || node[1] == i || node[2] == i;
}

int across_edge(const Extraction& extraction, std::int32_t e, std::int32_t a, std::int32_t b) {
  for (const std::int32_t g : extraction.around.of(a)) {
    if (g == e || !contains(extraction.mesh.corners(g), b)) continue;
    return extraction.local_element[g] >= 0 ? extraction.local_element[g] : across_rim;
  }
  return across_boundary;
}

// The facet of element e that lies on the edge from a to b or from b to a.
int facet_on(const PlanePatch& patch, int e, int a, int b) {
  const std::array<int, 3>& corner = patch.corner[e];
  return corner[0] != a && corner[0] != b ? 0 : corner[1] != a && corner[1] != b ? 1 : 2;
}

// Each edge is looked for from one of its elements.
void connect_facets(const Extraction& extraction, PlanePatch& patch) {
  constexpr int unknown = -3;
  patch.across.assign(patch.element.size(), {unknown, unknown, unknown});
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      if (patch.across[e][f] != unknown) continue;
      const int a = patch.corner[e][(f + 1) % 3], b = patch.corner[e][(f + 2) % 3];
      const int g = across_edge(extraction, patch.element[e], patch.node[a], patch.node[b]);
      patch.across[e][f] = g;
      if (g >= 0) patch.across[g][facet_on(patch, g, a, b)] = e;
    }
}

void connect(const Extraction& extraction, PlanePatch& patch) {
  const Mesh& mesh = extraction.mesh;
  const std::size_t n = patch.element.size();
  patch.star.assign(patch.node.size(), 0);
  patch.chain.assign(n, 0);
  patch.corner.resize(n);
  patch.opened.resize(n);
  patch.region.resize(n);
  patch.area.resize(n);
  for (int e = 0; e < patch.n_elements(); ++e) {
    const std::int32_t global = patch.element[e];
    const std::span<const std::int32_t> node = mesh.corners(global);
    for (std::size_t a = 0; a < 3; ++a) {
      patch.corner[e][a] = extraction.local_node[node[a]];
      patch.star[patch.corner[e][a]] = e;
    }
    patch.opened[e] = mesh.cut_facets[global];
    patch.region[e] = mesh.element_region[global];
    patch.area[e] = area(patch, e);
  }
  connect_facets(extraction, patch);
}

void measure_edges(PlanePatch& patch) {
  double sum = 0, least = std::numeric_limits<double>::max();
  int n = 0;
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      if (patch.across[e][f] > e) continue;  // once per edge
      const double l =
          (patch.X[patch.corner[e][(f + 2) % 3]] - patch.X[patch.corner[e][(f + 1) % 3]]).norm();
      least = std::min(least, l);
      sum += l;
      ++n;
    }
  patch.h = n > 0 ? sum / n : 0;
  patch.least_edge = least;
}

// Boundary edges into and out of each node, from which the turn of the boundary follows.
struct BoundaryTurn {
  Vec2 in = Vec2::Zero(), out = Vec2::Zero();
  int n_in = 0;
};

void note_boundary_edge(PlanePatch& patch, int e, int f, std::vector<BoundaryTurn>& turn) {
  const int a = patch.corner[e][(f + 1) % 3], b = patch.corner[e][(f + 2) % 3];
  const Vec2 direction = (patch.X[b] - patch.X[a]).normalized();
  turn[a].out = direction;
  turn[b].in = direction;
  ++turn[b].n_in;
  const bool is_cut = (patch.opened[e] >> f & 1) != 0;
  for (const int i : {a, b}) {
    patch.is_boundary[i] = 1;
    if (is_cut) patch.is_anchored[i] = 1;
  }
}

void classify_nodes(const Extraction& extraction, const CutConstraints& constraints,
                    PlanePatch& patch) {
  const std::size_t n = patch.node.size();
  patch.is_boundary.assign(n, 0);
  patch.is_sharp.assign(n, 0);
  patch.is_held.assign(n, 0);
  patch.is_anchored.assign(n, 0);
  patch.side.assign(n, Vec2::Zero());
  std::vector<BoundaryTurn> turn(n);
  for (int e = 0; e < patch.n_elements(); ++e)
    for (int f = 0; f < 3; ++f)
      if (patch.across[e][f] == across_boundary) note_boundary_edge(patch, e, f, turn);
  for (int i = 0; i < patch.n_nodes(); ++i) {
    const std::span<const std::int32_t> star = extraction.around.of(patch.node[i]);
    // Two fans that touch in a node are left alone.
    const bool is_held = turn[i].n_in > 1 || constraints.is_held[patch.node[i]] != 0;
    bool is_rim = false;
    for (const std::int32_t e : star) {
      is_rim = is_rim || extraction.local_element[e] < 0;
      if (extraction.mesh.element_region[e] != extraction.mesh.element_region[star[0]])
        patch.is_anchored[i] = 1;
    }
    patch.has_held = patch.has_held || is_held;
    patch.is_held[i] = is_rim || is_held ? 1 : 0;
    if (patch.is_boundary[i] == 0) continue;
    const double cosine = turn[i].in.dot(turn[i].out);
    patch.is_sharp[i] = cosine < (patch.is_anchored[i] != 0 ? cos_straight : cos_sharp) ? 1 : 0;
    if (cosine > cos_straight) patch.side[i] = turn[i].out;
  }
}

// Ends of loaded parts of the outline are as corners are: they stay where they are.
void mark_border(const Extraction& extraction, std::span<const BorderEdge> border,
                 PlanePatch& patch) {
  for (const BorderEdge& edge : border) {
    const int i = extraction.local_node[edge[0]];
    if (i < 0 || patch.is_boundary[i] == 0) continue;
    patch.is_sharp[i] = 1;
    patch.side[i] = Vec2::Zero();
  }
}

// The outline of a region ends on the body's outline as in a corner.
void mark_interfaces(const Mesh& mesh, PlanePatch& patch) {
  if (mesh.region_name.size() < 2) return;
  patch.is_interface.assign(patch.node.size(), 0);
  for_interface_edges(patch, [&](int a, int b) {
    for (const int i : {a, b}) {
      patch.is_interface[i] = 1;
      if (patch.is_boundary[i] == 0) continue;
      patch.is_sharp[i] = 1;
      patch.side[i] = Vec2::Zero();
    }
  });
}

}  // namespace

PlanePatch make_patch(const Mesh& mesh, std::span<const Vec2> path,
                      const CutConstraints& constraints, int rings) {
  Extraction extraction{mesh, node_elements(mesh), std::vector<int>(mesh.element_type.size(), -1),
                        std::vector<int>(mesh.X.size(), -1)};
  PlanePatch patch;
  choose_elements(extraction, path, rings);
  number_all(extraction, patch);
  connect(extraction, patch);
  measure_edges(patch);
  classify_nodes(extraction, constraints, patch);
  mark_interfaces(mesh, patch);
  mark_border(extraction, constraints.border, patch);
  if (!constraints.x.empty())
    for (const std::int32_t i : patch.node) patch.present.emplace_back(constraints.x[i].head<2>());
  return patch;
}

}  // namespace trocar
