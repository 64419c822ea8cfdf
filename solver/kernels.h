// What the kernels of one instruction set offer: a table of functions over blocks, resolved once
// per formulation, material model and precision. Raw pointers only, because each instruction set is
// compiled on its own.
#pragma once

#include <cstdint>

#include "solver/element_list.h"
#include "solver/material_list.h"

namespace trocar {

// Blocks of one list, from its first to its n-th, and where their results go. `data` and the
// results of a kernel are of the list's precision.
struct BlockTask {
  const double* u;             // (n_local * 3) [m]
  const std::int32_t* corner;  // [block][corner][lane] local node
  const void* data;            // [block][value][lane]
  std::int64_t n_blocks;
  // For elements that average volume changes: theta of node i at theta[i * n_fields], and the share
  // s (element_tet4_nodal_pressure.h).
  const double* theta;
  std::int64_t n_fields;
  double element_share;
};

// Numbers of a corner force in Scratch::slot: x, y, z and one that keeps them aligned.
inline constexpr int slot_width = 4;

// Corner forces [N] to [block][corner][lane][slot_width].
using ForceKernel = void (*)(const BlockTask& task, void* slot);
// The same of viscoelastic elements; their history, [block][point][number][lane] of doubles, goes
// along (viscosity.h).
struct ViscousStep;
using ViscousForceKernel = void (*)(const BlockTask& task, const ViscousStep& step, double* history,
                                    void* slot);
// Strain and hourglass energy [J] to [block][lane].
using EnergyKernel = void (*)(const BlockTask& task, double* strain, double* hourglass);
// Least det F and growth of the bound of omega^2 (stiffening.h) to [block][lane].
using WatchKernel = void (*)(const BlockTask& task, double* J, double* stiffening);
// K V (J - 1) [J] to [block][lane].
using VolumeKernel = void (*)(const BlockTask& task, double* K_V_j);

// Owned nodes whose corner forces are complete.
struct SumTask {
  const void* slot;
  const std::int64_t* slot_offset;  // of every owned node
  const std::int64_t* slot_index;
  const double* mass;        // of every owned node [kg]
  const double* gravity;     // (3) [m/s^2]
  double* force;             // (n_owned * 3) [N]
  const std::int32_t* node;  // those to sum
  std::int64_t n_nodes;
};
// force = m g - corner forces in the order of slot_index, summed in double.
using SumKernel = void (*)(const SumTask& task);

// All kernels null: the element can't be of this material.
struct BlockKernels {
  int n_corners, n_values;
  int n_material_values;  // of n_values, the first ones
  ForceKernel force;
  EnergyKernel energy;
  WatchKernel watch;
  int n_points;                      // with a history each; 0: viscosity is not available
  ViscousForceKernel viscous_force;  // nullptr then
  VolumeKernel volume_change;        // null: the element averages no volume changes
};

struct KernelsOfPrecision {
  SumKernel sum;
  BlockKernels block[n_formulations][n_material_models];
};

struct Kernels {
  KernelsOfPrecision of[n_precisions];  // in the order of Precision
};

}  // namespace trocar
