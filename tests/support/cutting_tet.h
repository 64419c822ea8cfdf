// Bodies, blades and checks that the tests of the 3D cut share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "cutting/cut_index.h"
#include "cutting/cut_patch.h"
#include "cutting/cut_tet.h"
#include "mesh/edit.h"
#include "mesh/facets.h"
#include "mesh/generate.h"
#include "mesh/quality.h"

namespace trocar::cutting_test {

// Present position of a reference position.
using Deformation = std::function<Vec3(const Vec3&)>;
inline Vec3 at_rest(const Vec3& X) {
  return X;
}

inline CutIndex index_of(const Mesh& mesh) {
  CutIndex index;
  update_index(mesh, index);
  return index;
}

struct Body {
  Mesh mesh;
  std::vector<Vec3> x;
  std::vector<std::uint8_t> is_held;

  explicit Body(Mesh m) : mesh(std::move(m)), x(mesh.X), is_held(mesh.X.size(), 0) {}
  void deform(const Deformation& map) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = map(mesh.X[i]);
  }
};

// What was done to a body, summed over its edits.
struct Ledger {
  CutFigures total;
  int n_edits = 0;
  double deviation_sum = 0;
};

// An edit, applied to mesh and positions as engine does it.
inline void apply(const MeshEdit& edit, const CutFigures& figures, Body& body, Ledger& ledger) {
  ledger.total.n_refused += figures.n_refused;
  if (edit.is_empty()) return;
  std::vector<double> field;
  for (const Vec3& p : body.x) field.insert(field.end(), {p.x(), p.y(), p.z()});
  apply_edit(edit, body.mesh, 3, field);
  apply_edit(edit, body.mesh);
  body.x.clear();
  for (std::size_t i = 0; i + 2 < field.size(); i += 3)
    body.x.emplace_back(field[i], field[i + 1], field[i + 2]);
  for (const std::int32_t parent : edit.duplicate_parent) {
    const std::uint8_t held = body.is_held[parent];
    body.is_held.push_back(held);
  }
  ++ledger.n_edits;
  CutFigures& total = ledger.total;
  total.n_opened_facets += figures.n_opened_facets;
  total.n_moved += figures.n_moved;
  total.n_beside += figures.n_beside;
  total.n_duplicated += figures.n_duplicated;
  total.n_turned += figures.n_turned;
  total.n_chips += figures.n_chips;
  total.n_pulled_back += figures.n_pulled_back;
  total.n_inverted += figures.n_inverted;
  total.least_quality = std::min(total.least_quality, figures.least_quality);
  total.largest_deviation = std::max(total.largest_deviation, figures.largest_deviation);
  ledger.deviation_sum += figures.mean_deviation * figures.n_duplicated;
  total.mean_edge = figures.mean_edge;
}

inline MeshEdit advance(TetCutter& cutter, Body& body, const BladeSweep& sweep, bool is_last,
                        Ledger& ledger) {
  CutFigures figures;
  MeshEdit edit = cutter.advance(body.mesh, body.x, body.is_held, sweep, is_last, figures);
  apply(edit, figures, body, ledger);
  return edit;
}

// The edge of a blade at time t in [0, 1], present configuration.
using Blade = std::function<std::vector<Vec3>(double t)>;

// A straight edge of `n` + 1 points from `from` to `to` that moves by `way`.
inline Blade straight_blade(const Vec3& from, const Vec3& to, const Vec3& way, int n = 8) {
  return [=](double t) {
    std::vector<Vec3> edge;
    for (int k = 0; k <= n; ++k) edge.push_back(from + (to - from) * (double(k) / n) + t * way);
    return edge;
  };
}

// Positions at time t in [0, 1] of a body that moves while it is cut.
using Motion = std::function<Vec3(const Vec3& X, double t)>;

// One stroke: moves the blade through the body in n_steps frames.
inline Ledger cut(Body& body, const Blade& blade, const Vec3& normal, int n_steps,
                  TetCutter& cutter, const Motion& motion = nullptr) {
  Ledger ledger;
  cutter.start_stroke();
  for (int k = 0; k < n_steps; ++k) {
    if (motion) body.deform([&](const Vec3& X) { return motion(X, double(k) / n_steps); });
    const BladeSweep sweep{blade(double(k) / n_steps), blade(double(k + 1) / n_steps), normal};
    advance(cutter, body, sweep, k + 1 == n_steps, ledger);
  }
  return ledger;
}

inline Ledger cut(Body& body, const Blade& blade, const Vec3& normal, int n_steps) {
  TetCutter cutter{CutTetOptions{}};
  return cut(body, blade, normal, n_steps, cutter);
}

// The plane through `centre` with `normal`, as a blade that sweeps all of a body of size `size`.
inline Blade plane_blade(const Vec3& centre, const Vec3& normal, double size) {
  const Vec3 along = normal.unitOrthogonal(), way = normal.cross(along);
  const Vec3 begin = centre - size * way;
  return straight_blade(begin - size * along, begin + size * along, 2 * size * way, 16);
}

inline double mass(const Mesh& mesh) {
  double sum = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    sum += mesh.density_factor[e] * element_volume(mesh, e, mesh.X);
  return sum;
}

inline double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) sum += element_volume(mesh, e, mesh.X);
  return sum;
}

// In proportion to the least element bound of the stable step.
inline double least_step_of(const Mesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const auto c = mesh.corners(e);
    least = std::min(least, step_bound(mesh.X, {c[0], c[1], c[2], c[3]}));
  }
  return least;
}

inline int n_pieces(const Mesh& mesh) {
  std::vector<std::int32_t> piece;
  return mesh_pieces(mesh, piece);
}

inline double mean_edge_of(const Mesh& mesh) {
  double sum = 0;
  const auto edges = mesh_edges(mesh);
  for (const auto& [a, b] : edges) sum += (mesh.X[a] - mesh.X[b]).norm();
  return sum / double(edges.size());
}

// Vertices - edges + faces of the boundary.
inline int boundary_euler(const Mesh& mesh) {
  const Surface surface = boundary_surface(mesh);
  std::vector<std::array<std::int32_t, 2>> edge;
  for (const auto& t : surface.triangle)
    for (std::size_t k = 0; k < 3; ++k)
      edge.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::sort(edge.begin(), edge.end());
  edge.erase(std::unique(edge.begin(), edge.end()), edge.end());
  return int(surface.node.size()) - int(edge.size()) + int(surface.triangle.size());
}

// What keeps the boundary from being a closed 2-manifold; empty if nothing does.
inline std::string boundary_fault(const Mesh& mesh) {
  const Surface surface = boundary_surface(mesh);
  std::vector<std::array<std::int32_t, 2>> edge;
  std::vector<std::vector<std::array<std::int32_t, 2>>> link(mesh.X.size());
  for (const auto& t : surface.triangle)
    for (std::size_t k = 0; k < 3; ++k) {
      edge.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
      link[t[k]].push_back({t[(k + 1) % 3], t[(k + 2) % 3]});
    }
  std::sort(edge.begin(), edge.end());
  for (std::size_t begin = 0, end = 0; begin < edge.size(); begin = end) {
    while (end < edge.size() && edge[end] == edge[begin]) ++end;
    if (end - begin != 2)
      return "edge " + std::to_string(edge[begin][0]) + " " + std::to_string(edge[begin][1]) +
             " has " + std::to_string(end - begin) + " boundary facets";
  }
  for (std::size_t i = 0; i < link.size(); ++i) {
    if (link[i].empty()) continue;
    std::int32_t at = link[i][0][0];
    std::size_t n = 0;
    do {
      const auto next =
          std::find_if(link[i].begin(), link[i].end(), [&](const auto& k) { return k[0] == at; });
      at = (*next)[1];
    } while (++n < link[i].size() && at != link[i][0][0]);
    if (n != link[i].size()) return "the link of node " + std::to_string(i) + " is not one cycle";
  }
  return "";
}

// The first thing wrong with a body that was whole and sound before; empty if nothing is.
inline std::string fault(const Body& body) {
  if (const auto broken = validate(body.mesh); !broken.empty()) return broken.front();
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e)
    if (!(element_volume(body.mesh, e, body.x) > 0))
      return "element " + std::to_string(e) + " is inverted in the present configuration";
  return boundary_fault(body.mesh);
}

}  // namespace trocar::cutting_test
