// What the kernels of one instruction set offer, resolved once per formulation, material model and
// precision. Elements and laws meet in the stash: an element's kernel leaves there the strain at
// each point, the law's puts stress in its place, the element's makes forces of it. So an element
// is compiled once, not once a material. Raw pointers only, because each instruction set is
// compiled on its own.
#pragma once

#include <cstdint>
#include <limits>

#include "solver/element_list.h"
#include "solver/material_list.h"

namespace trocar {

// Blocks of one list that follow each other. `data`, `stash` and what kernels put there are of the
// list's precision.
struct BlockTask {
  const double* u = nullptr;  // (n_local * 3) [m]
  // Component i of node k at u_x[i * u_stride + k], for rows; null: there is none.
  const double* u_x = nullptr;
  std::int64_t u_stride = 0;
  const float* position = nullptr;           // Model::position [m]
  std::int64_t position_stride = 0;          // from component to component; 0: node by node
  const std::int32_t* corner = nullptr;      // [block][corner][lane] local node
  const std::uint32_t* row = nullptr;        // [eight lanes] of row_order.h
  const std::uint32_t* row_break = nullptr;  // [block] of node_layout.h, by component
  bool is_aligned = false;                   // all of them, by component (row_order.h)
  // [block][corner] there: the first lane's node and its place of a ForceKernel's sum
  const std::int32_t *row_start = nullptr, *row_target = nullptr;
  const void* data = nullptr;  // [block][value][lane]: the material's, the element's
  std::int64_t n_blocks = 0;
  std::int64_t n_values = 0, n_material_values = 0;
  // [block][value][lane]: H, then V P, of each point (row by row), then what the element keeps.
  void* stash = nullptr;
  std::int64_t n_points = 0, n_stash = 0;
  // Value of point 0 that is its share of the element, and values from point to point; 0: one
  // point.
  std::int64_t share = 0, share_stride = 0;
  // For elements that average volume changes: theta of node i at theta[i * n_fields], and the share
  // s (element_tet4_nodal_pressure.h).
  const double* theta = nullptr;
  std::int64_t n_fields = 0;
  double element_share = 0;
  std::int64_t sum_stride = 0;  // of a ForceKernel
};

using ElementKernel = void (*)(const BlockTask& task);
// Adds corner forces [N] to sum[4 * target + (x, y, z)], or to sum[target + (x, y, z) * sum_stride]
// if that is not 0, element after element; target [block][corner][lane]; sums are of the list's
// precision.
using ForceKernel = void (*)(const BlockTask& task, const std::int32_t* target, void* sum);
// K V (J - 1) or an energy [J] to [block][lane].
using ValueKernel = void (*)(const BlockTask& task, double* to);

struct ElementKernels {
  int n_corners, n_points;
  int n_values;  // behind those of the material
  int n_stash;   // values of a lane in the stash
  LawKind law;
  bool reads_positions;       // BlockTask::position
  int share, share_stride;    // as in BlockTask, without the material's values
  ElementKernel strain;       // to the stash
  ForceKernel force;          // from the stash
  ValueKernel hourglass;      // energy, from the stash
  ValueKernel volume_change;  // null: the element averages no volume changes
};

// Viscoelastic elements have a history, [block][point][number][lane] of doubles (viscosity.h).
struct ViscousStep;
using ViscousKernel = void (*)(const BlockTask& task, const ViscousStep& step, double* history);
// What a look asks for.
struct WatchLimits {
  const double* enough;  // [block][lane] a growth up to this may come out as 1
  double J = std::numeric_limits<double>::infinity();
  double at_rest = 0;  // growth counts as this where it is less
};
// Least det F and growth of the bound of omega^2 (stiffening.h) to [block][lane]. Whether a lane's
// J is at most that of the limits, its growth at least enough, or one of them no number.
using WatchKernel = bool (*)(const BlockTask& task, const WatchLimits& limits, double* J,
                             double* stiffening);

// All null: elements of this kind can't be of this material.
struct LawKernels {
  ElementKernel stress;          // in place of strain, in the stash
  ViscousKernel viscous_stress;  // null: viscosity is not available
  ValueKernel energy;
  WatchKernel watch;
};

// Hourglass forces that relax with the isochoric stress (hourglass_history.h). While the strain is
// in the stash: history ([number][lane]) to the present, in place of the hourglass displacements
// those that make the relaxed forces, and to `balance` ([9][lane], of the list's precision) the
// stress that is missing then.
using HourglassRelaxKernel = void (*)(const BlockTask& task, const ViscousStep& step,
                                      double* history, void* balance);
// V P += balance, as soon as the stress is in the stash.
using HourglassBalanceKernel = void (*)(const BlockTask& task, const void* balance);
struct HourglassKernels {
  // Of elements without hourglass forces null. By whether the law is that of small strain.
  HourglassRelaxKernel relax[2][n_formulations];
  HourglassBalanceKernel balance;
};

struct KernelsOfPrecision {
  ElementKernels element[n_formulations];
  HourglassKernels hourglass;
  LawKernels law[n_law_kinds][n_material_models];
};

// force[3 i + j] = mass[i] gravity[j] - sum[4 i + j], or sum[i + j sum_stride] if that is not 0,
// and zero in place of the sum.
template <class Real>
struct NodeForces {
  const double* mass;  // [kg]
  double gravity[4];   // and a zero [m/s^2]
  Real* sum;           // [N]
  double* force;       // [N]
  std::int64_t sum_stride = 0;
};

// Beside FixedMask: a node that stays, with its force, when the others move.
inline constexpr std::uint8_t waits = 8;

// v = keep v + gain force / inertia, zero where a bit of fixed is set; u = u + dt v.
struct NodeMotion {
  double keep, gain, dt;
  const double* inertia;      // [kg]
  const std::uint8_t* fixed;  // FixedMask, or waits
  const double* force;        // [N]
  double *v, *u;              // [m/s], [m]
};

// v = (v + after) / 2, the velocity in the middle of a step; swept += dt v v and work += dt force v
// where they are given.
struct NodeWorks {
  double dt = 0;
  const double *after = nullptr, *force = nullptr;         // [m/s], [N]
  double *v = nullptr, *swept = nullptr, *work = nullptr;  // [m/s], [m^2/s], [J]
};

// Nodes ascend.
template <class Real>
using NodeForceKernel = void (*)(const NodeForces<Real>& task, const std::int32_t* node,
                                 std::int64_t n);
// The same and then the motion, which takes the force at once: `force` is that of waiting nodes,
// and motion's is not asked for.
template <class Real>
using NodeStepKernel = void (*)(const NodeForces<Real>& task, const NodeMotion& motion,
                                const std::int32_t* node, std::int64_t n);

// The sum of node[k] += that of place + k, which becomes zero; no node is among the places.
template <class Real>
using PlaceKernel = void (*)(Real* sum, std::int64_t sum_stride, std::int64_t place,
                             const std::int32_t* node, std::int64_t n);

// The nodes' part of a step.
struct NodeKernels {
  NodeForceKernel<double> force;
  NodeForceKernel<float> force_of_singles;
  NodeStepKernel<double> step;
  NodeStepKernel<float> step_of_singles;
  PlaceKernel<double> add_places;
  PlaceKernel<float> add_places_of_singles;
  void (*motion)(const NodeMotion& task, std::int64_t begin, std::int64_t end);
  void (*works)(const NodeWorks& task, std::int64_t n);  // of n components
  // to[i + j * stride] = from[3 i + j], i < n
  void (*split)(const double* from, std::int64_t n, double* to, std::int64_t stride);
};

struct Kernels {
  NodeKernels nodes;
  KernelsOfPrecision of[n_precisions];  // in the order of Precision
  int n_material_values[n_material_models];
};

}  // namespace trocar
