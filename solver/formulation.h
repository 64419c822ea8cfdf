// How an element of the mesh is computed: its kind of integration and kinematics. One of them for
// each shape in a model (SolverOptions).
#pragma once

#include <cstdint>

namespace trocar {

enum class Formulation : std::uint8_t {
  tri3_plane_strain,
  tri3_plane_stress,
  tet4,
  tet4_nodal_pressure,
  hex8_one_point,
  hex8_enhanced,
  hex8_full,
};

// What an element asks a material for: the stress of its own strain; of the thickness without
// stress, too (law_plane_stress.h); at a pressure averaged over its neighbours
// (law_averaged_pressure.h).
enum class LawKind : std::uint8_t { local, plane_stress, averaged_pressure };
inline constexpr int n_law_kinds = 3;

// Numbers that elements compute with and add up; the motion of nodes is in double always.
enum class Precision : std::uint8_t { in_double, in_single };
inline constexpr int n_precisions = 2;

// "hex8-one-point"; "double".
const char* name_of(Formulation formulation);
const char* name_of(Precision precision);

}  // namespace trocar
