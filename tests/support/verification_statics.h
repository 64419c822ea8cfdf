// Static problems of boxes: ways to compute them, supports, loads, relaxation.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "solver/relax.h"
#include "solver_body.h"

namespace trocar {

// A way to compute a body of box cells; a new formulation joins by one line.
struct Variant {
  const char* name;
  BoxElements elements;
  Formulation formulation;
  Precision precision = Precision::in_double;
  double hourglass = 0.1;
  double own_volume_stiffness = SolverOptions{}.own_volume_stiffness;
};

inline const Variant hex_one_point = {"hex8", BoxElements::hex8, Formulation::hex8_one_point};
inline const Variant hex_one_point_single = {"hex8 single", BoxElements::hex8,
                                             Formulation::hex8_one_point, Precision::in_single};
inline const Variant hex_enhanced = {"hex8-enhanced", BoxElements::hex8,
                                     Formulation::hex8_enhanced};
inline const Variant hex_full = {"hex8-full", BoxElements::hex8, Formulation::hex8_full};
inline const Variant tet_plain = {"tet4", BoxElements::tet4_kuhn, Formulation::tet4};
inline const Variant tet_nodal_pressure = {"tet4-nodal-pressure", BoxElements::tet4_kuhn,
                                           Formulation::tet4_nodal_pressure};

SolverOptions solver_options(const Variant& variant);

std::string mesh_name(const Variant& variant, const std::array<int, 3>& n);

inline const Material soft_tissue = {MaterialModel::neo_hookean, 3000, .45, 1000};

// Supports by position; the body is the box [0, size] after `map`.
struct BoxProblem {
  Vec3 size;
  std::array<int, 3> n;
  Material material;
  std::function<FixedMask(const Vec3& X)> fixed;
  Vec3 gravity = Vec3::Zero();
  std::function<Vec3(const Vec3& X)> map;  // of reference positions; empty: none
};

Body make_box_body(const Variant& variant, const BoxProblem& problem);

// Share of node X in a uniform traction on a face of the box that lies across `axis`.
double face_share(const Vec3& X, const Vec3& size, const std::array<int, 3>& n, int axis);

// Of a point of the cube [0, side]^3.
bool is_inside(const Vec3& X, double side);

std::vector<double> load_by(const Body& body, const std::function<Vec3(const Vec3& X)>& force);

// Relaxes and insists on convergence; says what it took.
Relaxation settle(Body& body, const RelaxTask& task);

// Displacement of the node nearest to reference position X.
Vec3 displacement_at(const Body& body, const Vec3& X);

// Force that supports and holders apply to the nodes for which `is_part`.
template <class IsPart>
Vec3 reaction_of(const Body& body, const IsPart& is_part) {
  Vec3 R = Vec3::Zero();
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
    if (is_part(body.mesh.X[i])) R -= Vec3::Map(&body.scratch.force[3 * i]);
  return R;
}

}  // namespace trocar
