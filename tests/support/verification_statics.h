// Static problems of boxes: ways to compute them, supports, loads, relaxation.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "solver/element_setup.h"
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

inline SolverOptions solver_options(const Variant& variant) {
  SolverOptions options{.hourglass = variant.hourglass,
                        .precision = variant.precision,
                        .own_volume_stiffness = variant.own_volume_stiffness};
  if (shape_of(variant.formulation) == ElementType::hex8)
    options.hex8 = variant.formulation;
  else
    options.tet4 = variant.formulation;
  return options;
}

inline std::string mesh_name(const Variant& variant, const std::array<int, 3>& n) {
  return std::string(variant.name) + " " + std::to_string(n[0]) + " x " + std::to_string(n[1]) +
         " x " + std::to_string(n[2]);
}

// Supports by position; the body is the box [0, size] after `map`.
struct BoxProblem {
  Vec3 size;
  std::array<int, 3> n;
  Material material;
  std::function<FixedMask(const Vec3& X)> fixed;
  Vec3 gravity = Vec3::Zero();
  std::function<Vec3(const Vec3& X)> map;  // of reference positions; empty: none
};

inline Body make_box_body(const Variant& variant, const BoxProblem& problem) {
  Mesh mesh = make_box(Vec3::Zero(), problem.size, problem.n, variant.elements);
  BodyOptions options{.materials = {problem.material}, .solver = solver_options(variant)};
  options.solver.gravity = problem.gravity;
  for (Vec3& X : mesh.X) {
    options.fixed.push_back(problem.fixed ? problem.fixed(X) : FixedMask{0});
    if (problem.map) X = problem.map(X);
  }
  return make_body(std::move(mesh), options);
}

// Share of node X in a uniform traction on a face of the box that lies across `axis`.
inline double face_share(const Vec3& X, const Vec3& size, const std::array<int, 3>& n, int axis) {
  double share = 1;
  for (int j = 0; j < 3; ++j) {
    if (j == axis) continue;
    const bool is_edge = X[j] < 1e-9 * size[j] || X[j] > (1 - 1e-9) * size[j];
    share *= (is_edge ? 0.5 : 1.0) / n[static_cast<std::size_t>(j)];
  }
  return share;
}

inline std::vector<double> load_by(const Body& body,
                                   const std::function<Vec3(const Vec3& X)>& force) {
  std::vector<double> load;
  for (const Vec3& X : body.mesh.X)
    for (const double f : Vec3(force(X))) load.push_back(f);
  return load;
}

// Relaxes and insists on convergence; says what it took.
inline Relaxation settle(Body& body, const RelaxTask& task) {
  const Relaxation result = relax(body.model, task, body.state, body.scratch);
  std::printf("relaxed in %lld iterations to %.1e\n", static_cast<long long>(result.iterations),
              result.residual);
  EXPECT_TRUE(result.is_converged);
  return result;
}

// Displacement of the node nearest to reference position X.
inline Vec3 displacement_at(const Body& body, const Vec3& X) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < body.mesh.X.size(); ++i)
    if ((body.mesh.X[i] - X).squaredNorm() < (body.mesh.X[nearest] - X).squaredNorm()) nearest = i;
  EXPECT_LT((body.mesh.X[nearest] - X).norm(), 1e-9 * (1 + X.norm()));
  return Vec3::Map(&body.state.u[3 * nearest]);
}

// Force that supports and holders apply to the nodes for which `is_part`.
template <class IsPart>
Vec3 reaction_of(const Body& body, const IsPart& is_part) {
  Vec3 R = Vec3::Zero();
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
    if (is_part(body.mesh.X[i])) R -= Vec3::Map(&body.scratch.force[3 * i]);
  return R;
}

}  // namespace trocar
