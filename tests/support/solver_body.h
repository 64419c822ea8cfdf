// A body on one rank, ready to be stepped, and the small things that tests of solver/ do with it.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/threads.h"
#include "mesh/generate.h"
#include "mesh/mesh.h"
#include "mesh/partition.h"
#include "solver/element_setup.h"
#include "solver/model.h"
#include "solver/neighbours.h"
#include "solver/simd.h"
#include "solver/step.h"
#include "solver/watch.h"

namespace trocar {

// Test bodies are too small for threads; invariance_test.cpp asks for more where it wants them.
inline const bool is_one_thread = (set_thread_count(1), true);

struct Body {
  Mesh mesh;
  std::vector<Material> materials;
  std::vector<double> mass;
  Part part;
  Model model;
  State state;
  Scratch scratch;
};

struct BodyOptions {
  std::vector<Material> materials = {Material{}};
  SolverOptions solver;
  std::vector<FixedMask> fixed;  // empty: free
};

inline std::vector<double> mass_of(const Mesh& mesh, const BodyOptions& options) {
  std::vector<double> density;
  for (const Material& material : options.materials) density.push_back(material.density);
  return lumped_mass(mesh, density, options.solver.thickness);
}

inline Body make_body(Mesh mesh, BodyOptions options = {},
                      const std::vector<std::int32_t>& owner = {}, int rank = 0) {
  Body body;
  body.mesh = std::move(mesh);
  body.materials = options.materials;
  if (options.fixed.empty()) options.fixed.assign(body.mesh.X.size(), 0);
  body.mass = mass_of(body.mesh, options);
  const std::vector<std::int32_t> alone(body.mesh.X.size(), 0);
  body.part = make_part(body.mesh, owner.empty() ? alone : owner, rank);
  body.model =
      build_model(body.mesh, body.part, body.materials, options.fixed, body.mass, options.solver);
  body.state = make_state(body.model);
  body.scratch = make_scratch(body.model);
  return body;
}

inline Watch look(Body& body) {
  average_volume_change(body.model, body.state, body.scratch);
  return watch(body.model, body.part, body.state);
}

// u = field(X) at all local nodes.
template <class Field>
void displace(Body& body, const Field& field) {
  for (std::int32_t i = 0; i < body.model.n_local; ++i) {
    const Vec3 u = field(body.mesh.X[body.part.node_global[i]]);
    for (int j = 0; j < 3; ++j) body.state.u[3 * i + j] = u[j];
  }
}

// Repeatable numbers in [-1, 1] (splitmix64).
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
  }

 private:
  std::uint64_t state_;
};

inline void shake(std::vector<double>& values, double amount, std::uint64_t seed) {
  Noise noise(seed);
  for (double& value : values) value += amount * noise();
}

// External minus internal force of the present displacement.
inline const std::vector<double>& force(Body& body) {
  Neighbours none;
  find_force(body.model, none, body.state, body.scratch);
  return body.scratch.force;
}

inline double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}
// NaN if any value is.
inline double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) {
    if (std::isnan(value)) return value;
    most = std::max(most, std::abs(value));
  }
  return most;
}

// Strain plus hourglass energy of the present displacement.
inline double stored_energy(Body& body) {
  average_volume_change(body.model, body.state, body.scratch);
  EnergyTerms terms;
  energy_terms(body.model, body.part, body.state, terms);
  return sum(terms.strain) + sum(terms.hourglass) + sum(terms.volumetric);
}

inline void step(Body& body, double dt) {
  Neighbours none;
  find_force(body.model, none, body.state, body.scratch);
  integrate(body.model, body.scratch, {}, dt, body.state);
}

inline double least_element_step(const Body& body) {
  return *std::min_element(body.model.element_step.begin(), body.model.element_step.end());
}

inline Mesh one_element(ElementType type, const std::vector<Vec3>& X) {
  Mesh mesh;
  mesh.X = X;
  std::vector<std::int32_t> corner(X.size());
  std::iota(corner.begin(), corner.end(), 0);
  add_element(mesh, type, corner);
  return mesh;
}

// One irregular element of each type, about 1 cm wide.
inline std::vector<Mesh> irregular_elements() {
  return {one_element(ElementType::tri3, {{0, 0, 0}, {.011, .002, 0}, {.003, .009, 0}}),
          one_element(ElementType::tet4,
                      {{0, 0, 0}, {.010, .001, 0}, {.002, .012, .001}, {.001, .002, .009}}),
          one_element(ElementType::hex8, {{0, 0, 0},
                                          {.011, .001, -.001},
                                          {.012, .010, .001},
                                          {-.001, .009, 0},
                                          {.001, -.001, .010},
                                          {.010, 0, .011},
                                          {.0115, .0105, .0095},
                                          {0, .011, .0105}})};
}

// One irregular element, or two tetrahedra where elements share more than forces.
inline Mesh irregular_patch(Formulation formulation) {
  Mesh mesh = irregular_elements()[static_cast<std::size_t>(shape_of(formulation))];
  if (formulation == Formulation::tet4_nodal_pressure) {
    mesh.X.emplace_back(.009, .010, .011);
    add_element(mesh, ElementType::tet4, std::vector<std::int32_t>{1, 4, 2, 3});
  }
  return mesh;
}

inline std::vector<Formulation> all_formulations() {
  std::vector<Formulation> all;
  for (int f = 0; f < n_formulations; ++f) all.push_back(static_cast<Formulation>(f));
  return all;
}
inline constexpr Precision precisions[] = {Precision::in_double, Precision::in_single};

// Options that compute the formulation's shape with it.
inline SolverOptions with(Formulation formulation, SolverOptions options = {}) {
  if (shape_of(formulation) == ElementType::tri3) options.tri3 = formulation;
  if (shape_of(formulation) == ElementType::tet4) options.tet4 = formulation;
  if (shape_of(formulation) == ElementType::hex8) options.hex8 = formulation;
  return options;
}
// Whether elements of the formulation can be of the material.
inline bool is_possible(Formulation formulation, MaterialModel model) {
  const KernelsOfPrecision& kernels = kernels_of(Simd::scalar).of[0];
  const LawKind law = kernels.element[static_cast<int>(formulation)].law;
  return kernels.law[static_cast<int>(law)][static_cast<int>(model)].stress != nullptr;
}

inline const std::vector<MaterialModel>& all_models() {
  static const std::vector<MaterialModel> models = {MaterialModel::linear,
                                                    MaterialModel::st_venant_kirchhoff,
                                                    MaterialModel::neo_hookean,
                                                    MaterialModel::mooney_rivlin,
                                                    MaterialModel::yeoh,
                                                    MaterialModel::ogden,
                                                    MaterialModel::transversely_isotropic,
                                                    MaterialModel::holzapfel_gasser_ogden};
  return models;
}

// The models' parameters from the shear and bulk moduli at small strain, in the ratios of numerics
// V4; only those of the model count.
inline Material material_of(MaterialModel model, double mu, double K, double density = 1000) {
  const double nu = (3 * K - 2 * mu) / (6 * K + 2 * mu);
  Material m{
      .model = model, .young_modulus = 2 * mu * (1 + nu), .poisson_ratio = nu, .density = density};
  m.c10 = .3 * mu, m.c01 = .2 * mu;
  m.c1 = .5 * mu, m.c2 = .1 * mu, m.c3 = .05 * mu;
  m.ogden[0] = {.mu = mu, .alpha = -8};
  m.eta = 2 * mu;
  m.k1 = 2 * mu, m.k2 = 5, m.kappa = .1;
  m.fibre_angle = 3.14159265358979323846 / 6;
  return m;
}

}  // namespace trocar
