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
#include "mesh_fixtures.h"
#include "mesh_pieces.h"

namespace trocar::cutting_test {

// Present position of a reference position.
using Deformation = std::function<Vec3(const Vec3&)>;
Vec3 at_rest(const Vec3& X);

CutIndex index_of(const Mesh& mesh);

struct Body {
  Mesh mesh;
  std::vector<Vec3> x;
  std::vector<std::uint8_t> is_held;
  std::vector<BorderEdge> border;  // of its nodes before any cut
  std::string edit_fault;          // what the first edit by advance() that broke it left

  explicit Body(Mesh m) : mesh(std::move(m)), x(mesh.X), is_held(mesh.X.size(), 0) {}
  void deform(const Deformation& map) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = map(mesh.X[i]);
  }
};

// Of all of its elements, in their order.
CutPatch whole_patch(const Body& body);

// What was done to a body, summed over its edits.
struct Ledger {
  CutFigures total;
  int n_edits = 0;
  double deviation_sum = 0;
};

// An edit, applied to mesh and positions as engine does it.
void apply(const MeshEdit& edit, const CutFigures& figures, Body& body, Ledger& ledger);

CutterEdit advance(TetCutter& cutter, Body& body, const BladeSweep& sweep, bool is_last,
                   Ledger& ledger);

// The edge of a blade at time t in [0, 1], present configuration.
using Blade = std::function<std::vector<Vec3>(double t)>;

// A straight edge of `n` + 1 points from `from` to `to` that moves by `way`.
Blade straight_blade(const Vec3& from, const Vec3& to, const Vec3& way, int n = 8);

// Positions at time t in [0, 1] of a body that moves while it is cut.
using Motion = std::function<Vec3(const Vec3& X, double t)>;

// One stroke: moves the blade through the body in n_steps frames, and lets it rest there for the
// cut where that puts nodes on edges first.
Ledger cut(Body& body, const Blade& blade, const Vec3& normal, int n_steps, TetCutter& cutter,
           const Motion& motion = nullptr);

Ledger cut(Body& body, const Blade& blade, const Vec3& normal, int n_steps);

// The plane through `centre` with `normal`, as a blade that sweeps all of a body of size `size`.
Blade plane_blade(const Vec3& centre, const Vec3& normal, double size);

// Through the middle of the unit cube in twenty advances, each of which edits the index alike;
// calls before_advance(k) and after_advance().
Ledger cut_with_index(
    const Vec3& across, Body& body, CutIndex& index,
    const std::function<void(int k)>& before_advance = [](int) {},
    const std::function<void()>& after_advance = [] {});

// The elements that have a corner there become a region of their own.
void add_region(Mesh& mesh, const std::function<bool(const Vec3&)>& is_there);

// Of each region, hexahedra as their tetrahedra.
std::vector<double> region_volumes(const Mesh& mesh);

// In proportion to the least element bound of the stable step.
double least_step_of(const Mesh& mesh);

// Its nodes by up to `amount` off their places in each direction, those of the surface, too [m].
Mesh irregular(Mesh mesh, double amount, unsigned seed);

// Of two planes that cross along a line in the xy plane, `angle` from the x axis; the normals lie
// `tilt` above and below that plane [rad].
std::array<Vec3, 2> crossing_normals(double angle, double tilt);

// What keeps the boundary from being a closed 2-manifold; empty if nothing does.
std::string boundary_fault(const Mesh& mesh);

// The first thing wrong with a body that was whole and sound before, now or after an edit that
// advance() has made; empty if nothing is.
std::string fault(const Body& body);

}  // namespace trocar::cutting_test
