// Constants of one element from its reference positions, in the layout of element_<type>.h, and a
// bound of its highest frequency (frequency_bound).
#pragma once

#include <array>
#include <span>

#include "base/vec.h"
#include "mesh/mesh.h"
#include "solver/block_data.h"
#include "solver/formulation.h"
#include "solver/tensor.h"

namespace trocar {

// Shape that the formulation is for.
constexpr ElementType shape_of(Formulation formulation) {
  constexpr ElementType shape[] = {ElementType::tri3, ElementType::tri3, ElementType::tet4,
                                   ElementType::tet4, ElementType::hex8, ElementType::hex8,
                                   ElementType::hex8};
  return shape[static_cast<int>(formulation)];
}

// Of what there is one for each shape, that of `shape`.
template <class T>
T& of_shape(ElementType shape, T& tri3, T& tet4, T& hex8) {
  T* const of[] = {&tri3, &tet4, &hex8};
  return *of[static_cast<int>(shape)];
}

struct ElementInput {
  std::span<const Vec3> X;    // (n_corners) [m]
  double lambda = 0, mu = 0;  // [Pa]
  double density = 0;         // [kg/m^3]
  double hourglass = 0;       // c_mu, hex8_one_point
  double thickness = 0;       // [m], tri3
};

inline constexpr int max_element_values = 80;  // hex8_full

struct ElementConstants {
  std::array<double, max_element_values> value{};  // of element_<type>.h
  double volume = 0;                               // [m^3]; not positive: the rest means nothing
  double omega2 = 0;  // no free element of this kind vibrates faster [1/s^2]
};

ElementConstants element_constants(Formulation formulation, const ElementInput& input);

// In element_<type>_setup.cpp, e.g. element_tet4_setup.cpp.
ElementConstants constants_tri3(const ElementInput& input);
ElementConstants constants_tri3_plane_stress(const ElementInput& input);
ElementConstants constants_tet4(const ElementInput& input);
ElementConstants constants_tet4_nodal_pressure(const ElementInput& input);
ElementConstants constants_hex8(const ElementInput& input);
ElementConstants constants_hex8_enhanced(const ElementInput& input);
ElementConstants constants_hex8_full(const ElementInput& input);

// G = sum_a B_a (x) B_a grows by one gradient. [1/m^2]
void add_gradient(const Vec3& B, SymmetricTensor<double>& G);
// omega^2 <= (n/rho) (lambda+ tr G + 2 mu lambda_max(G)): the volumetric and the shear part of the
// element's energy bounded each on its own; exact for cubes.
double frequency_bound(const SymmetricTensor<double>& G, int n_corners, const ElementInput& input);

}  // namespace trocar
