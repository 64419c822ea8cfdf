#include "solver_body.h"

#include <gtest/gtest.h>

namespace trocar {

// Test bodies are too small for threads; invariance_test.cpp asks for more where it wants them.
[[maybe_unused]] static const bool is_one_thread = (set_thread_count(1), true);

Body::Body() = default;
Body::Body(const Body& other) = default;
Body::Body(Body&& other) noexcept = default;
Body& Body::operator=(const Body& other) = default;
Body& Body::operator=(Body&& other) noexcept = default;
Body::~Body() = default;

std::vector<double> mass_of(const Mesh& mesh, const BodyOptions& options) {
  std::vector<double> density;
  for (const Material& material : options.materials) density.push_back(material.density);
  return lumped_mass(mesh, density, options.solver.thickness);
}

Body make_body(Mesh mesh, BodyOptions options, const std::vector<std::int32_t>& owner, int rank) {
  Body body;
  body.mesh = std::move(mesh);
  body.materials = options.materials;
  if (options.fixed.empty()) options.fixed.assign(body.mesh.X.size(), 0);
  body.mass = mass_of(body.mesh, options);
  body.part = owner.empty() ? whole_part(body.mesh) : make_part(body.mesh, owner, rank);
  body.model =
      build_model(body.mesh, body.part, body.materials, options.fixed, body.mass, options.solver);
  body.state = make_state(body.model);
  body.scratch = make_scratch(body.model);
  return body;
}

void put_node_by_node(Body& body) {
  Model& model = body.model;
  if (!model.is_by_component) return;
  model.is_by_component = false;
  model.sums.window.clear();
  model.sums.stride_nodes.clear();
  for (ElementBlocks& blocks : model.blocks) {
    blocks.row_break.clear();
    blocks.n_aligned = 0;
    blocks.row_start.clear();
    blocks.row_target.clear();
  }
  const AlignedVector<float> by_component = model.position;
  if (!by_component.empty()) model.position.assign(4 * static_cast<std::size_t>(model.n_local), 0);
  for (std::size_t k = 0; k < model.position.size(); ++k)
    if (k % 4 < 3)
      model.position[k] =
          by_component[k % 4 * static_cast<std::size_t>(component_stride(model.n_local)) + k / 4];
  body.scratch = make_scratch(model);
}

Watch look(Body& body) {
  average_volume_change(body.model, body.state, body.scratch);
  return watch(body.model, body.part, body.state);
}

HighestFrequency search_frequency(Body& body, const FrequencyOptions& options) {
  State probe = body.state;
  const auto forces = [&](std::vector<double>& u, std::vector<double>& f) {
    probe.u.swap(u);
    compute_force(body.model, probe, body.scratch);
    f = body.scratch.force;
    probe.u.swap(u);
  };
  return find_highest_frequency(body.model, body.part, body.state, forces, options, Communicator());
}

void shake(std::vector<double>& values, double amount, std::uint64_t seed) {
  Noise noise(seed);
  for (double& value : values) value += amount * noise();
}

const std::vector<double>& force(Body& body) {
  Neighbours none;
  find_force(body.model, none, body.state, body.scratch);
  return body.scratch.force;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double stored_energy(Body& body) {
  average_volume_change(body.model, body.state, body.scratch);
  EnergyTerms terms;
  energy_terms(body.model, body.part, body.state, terms);
  return sum(terms.strain) + sum(terms.hourglass) + sum(terms.volumetric);
}

void step(Body& body, double dt) {
  Neighbours none;
  find_force(body.model, none, body.state, body.scratch);
  integrate(body.model, body.scratch, {}, dt, body.state);
}

void step_freely(const Model& model, Neighbours& neighbours, double dt, State& state,
                 Scratch& scratch) {
  step_others(model, neighbours, {}, dt, state, scratch);
  step_waiting(model, {}, {}, dt, state, scratch);
}

void step_freely(Body& body, double dt) {
  Neighbours none;
  step_freely(body.model, none, dt, body.state, body.scratch);
}

double step_and_measure(Body& body, const std::function<void()>& step) {
  const double W = stored_energy(body);
  const std::vector<double> before = body.state.v;
  step();
  double T = 0;
  for (std::size_t k = 0; k < before.size(); ++k)
    T += .5 * body.model.mass[k / 3] * before[k] * body.state.v[k];
  return T + W;
}

double step_and_measure(Body& body, double dt) {
  return step_and_measure(body, [&] { step(body, dt); });
}

double least_element_step(const Body& body) {
  return *std::min_element(body.model.element_step.begin(), body.model.element_step.end());
}

std::vector<Mesh> irregular_elements() {
  return {single_element(ElementType::tri3, {{0, 0, 0}, {.011, .002, 0}, {.003, .009, 0}}),
          single_element(ElementType::tet4,
                         {{0, 0, 0}, {.010, .001, 0}, {.002, .012, .001}, {.001, .002, .009}}),
          single_element(ElementType::hex8, {{0, 0, 0},
                                             {.011, .001, -.001},
                                             {.012, .010, .001},
                                             {-.001, .009, 0},
                                             {.001, -.001, .010},
                                             {.010, 0, .011},
                                             {.0115, .0105, .0095},
                                             {0, .011, .0105}})};
}

Mesh irregular_patch(Formulation formulation) {
  Mesh mesh = irregular_elements()[static_cast<std::size_t>(shape_of(formulation))];
  if (formulation == Formulation::tet4_nodal_pressure) {
    mesh.X.emplace_back(.009, .010, .011);
    add_element(mesh, ElementType::tet4, std::vector<std::int32_t>{1, 4, 2, 3});
  }
  return mesh;
}

std::vector<Formulation> all_formulations() {
  std::vector<Formulation> all;
  for (int f = 0; f < n_formulations; ++f) all.push_back(static_cast<Formulation>(f));
  return all;
}

SolverOptions with(Formulation formulation, SolverOptions options) {
  of_shape(shape_of(formulation), options.tri3, options.tet4, options.hex8) = formulation;
  return options;
}

bool is_possible(Formulation formulation, MaterialModel model) {
  const KernelsOfPrecision& kernels = kernels_of(Simd::scalar).of[0];
  const LawKind law = kernels.element[static_cast<int>(formulation)].law;
  return kernels.law[static_cast<int>(law)][static_cast<int>(model)].stress != nullptr;
}

const std::vector<MaterialModel>& all_models() {
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

Material material_of(MaterialModel model, double mu, double K, double density) {
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

void expect_second_call_changes_nothing(Body body) {
  shake(body.state.u, 1e-3, 4);
  force(body);
  body.state.time = .07;
  shake(body.state.u, 1e-4, 5);
  const std::vector<double> first = force(body), history = body.state.history;
  EXPECT_EQ(force(body), first);
  EXPECT_EQ(body.state.history, history);
}

}  // namespace trocar
