// The paper's algorithm on triangle meshes (Serby, Harders and Szekely 2001, section 3): cut
// points, nearest nodes displaced onto them, both mesh errors repaired, springs and Lennard-Jones
// particles around the cut, area optimisation, partner nodes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "cutting/cut_constraints.h"
#include "cutting/cut_figures.h"
#include "mesh/edit.h"
#include "mesh/mesh.h"

namespace trocar {

// The parameters of the paper's combined system, which it left to future work to adjust;
// docs/cutting-parameters.md shows what each of them does.
struct CutPlaneOptions {
  bool is_robust = true;    // quality flips, sliding along straight boundaries, tips kept clear of
                            // the boundary; false: as published
  double spring = 1;        // s_spring of eq. 6
  double particle = 0.1;    // s_particle of eq. 6
  int repulsion = 12;       // n of eq. 5 …
  int attraction = 6;       // … and m < n
  double threshold = 1e-4;  // displacement of a step that ends the homogenisation, in mean edges
  int most_steps = 4;       // of the homogenisation
  int area_sweeps = 4;      // of the area step over all nodes
  int rings = 3;            // vicinity that is homogenised
  double least_step = 0;    // floor under the step bounds of elements [m], see least_step_bound:
                            // what would sink below, or further, is not cut. 0: none
  double room_ahead = 0;    // h: a path that ends inside, nearer than this before a boundary, is
                            // not cut, as what is left would have no room. For paths that may
                            // grow; 0: all are cut
  bool operator==(const CutPlaneOptions&) const = default;
};
// As published: homogenised until the threshold, without flips for quality.
CutPlaneOptions published_options();

// Default of least_step over the body's bound before it was cut: random cuts that do not graze the
// boundary keep 0.63 or more by themselves (docs/cutting-2d.md).
inline constexpr double plane_step_ratio = 0.5;
// Of the elements of a plane mesh the least 2 A / sqrt(sum of squared edges), which over the wave
// speed bounds the stable step. [m]
double least_step_bound(const Mesh& mesh);

// Cuts the plane mesh (tri3) along the polyline `path` (>= 2 points, reference configuration, z =
// 0). Ends inside the body stay closed (crack tips); ends on or beyond the boundary open it. If
// `continued_tip` >= 0 the path starts at that node, the tip of an earlier part of the same cut.
// Nodes between regions of the mesh stay where these meet. Throws InputError for other element
// types. Afterwards `tip` is the node at the inner end of the path, -1 if it ends on the boundary.
// `rest`: the end of the path inside the body that is too short to be cut by itself, behind an
// older cut; what is to be cut next begins with it.
struct PlaneCut {
  MeshEdit edit;
  CutFigures figures;
  std::int32_t tip = -1;
  std::vector<Vec3> rest;
};
PlaneCut cut_plane(const Mesh& mesh, std::span<const Vec3> path, std::int32_t continued_tip,
                   const CutConstraints& constraints, const CutPlaneOptions& options);

}  // namespace trocar
