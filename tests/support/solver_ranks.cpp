#include "solver_ranks.h"

#include "base/threads.h"

namespace trocar {

BodyOptions options_for(const Mesh& mesh, const SolverOptions& solver) {
  const bool is_averaged = solver.tet4 == Formulation::tet4_nodal_pressure;
  const auto model = [&](MaterialModel other) {
    return is_averaged ? MaterialModel::neo_hookean : other;
  };
  BodyOptions options{
      .materials = {material_of(MaterialModel::neo_hookean, 1000, 9000),
                    material_of(model(MaterialModel::st_venant_kirchhoff), 1500, 5000),
                    material_of(model(MaterialModel::linear), 800, 4000)},
      .solver = solver};
  options.solver.mass_damping = 2;
  options.solver.gravity = Vec3(0, 1, -9.81);
  if (!is_averaged) options.materials[0].prony = {{.3, .01}, {.2, 1}};
  options.fixed.assign(mesh.X.size(), 0);
  for (std::size_t i = 0; i < mesh.X.size(); ++i)
    if (mesh.X[i].x() == 0) options.fixed[i] = 7;
  return options;
}

void exchange(std::vector<Body>& ranks, const std::vector<std::int32_t>& owner,
              std::vector<double> State::*field, int width) {
  for (Body& body : ranks)
    for (std::int32_t k = body.part.n_owned; k < body.part.n_local(); ++k) {
      const std::int32_t global = body.part.node_global[k];
      const Body& other = ranks[owner[global]];
      const std::int32_t there = other.part.node_local[global];
      for (int j = 0; j < width; ++j)
        (body.state.*field)[width * k + j] = (other.state.*field)[width * there + j];
    }
}

void average(std::vector<Body>& ranks, const std::vector<std::int32_t>& owner) {
  for (Body& body : ranks) average_volume_change(body.model, body.state, body.scratch);
  exchange(ranks, owner, &State::theta, ranks[0].model.averages.n_fields);
}

void step(std::vector<Body>& ranks, const std::vector<std::int32_t>& owner, double dt,
          Motion motion) {
  average(ranks, owner);
  for (Body& body : ranks)
    if (motion == Motion::at_once) {
      step_freely(body, dt);
    } else {
      compute_force(body.model, body.state, body.scratch);
      integrate(body.model, body.scratch, {}, dt, body.state);
    }
  exchange(ranks, owner, &State::u, 3);
  exchange(ranks, owner, &State::v, 3);
}

RanksResult collect(const std::vector<Body>& ranks, std::size_t n_nodes) {
  RanksResult result{.u = std::vector<double>(3 * n_nodes), .v = std::vector<double>(3 * n_nodes)};
  for (const Body& body : ranks) {
    for (std::int32_t k = 0; k < 3 * body.part.n_owned; ++k) {
      const std::int32_t global = 3 * body.part.node_global[k / 3] + k % 3;
      result.u[global] = body.state.u[k];
      result.v[global] = body.state.v[k];
    }
    const Watch w = watch(body.model, body.part, body.state);
    if (w.stable_step < result.stable_step) result.stable_element = w.stable_element;
    result.stable_step = std::min(result.stable_step, w.stable_step);
    result.least_J = std::min(result.least_J, w.least_J);
    EnergyTerms terms;
    energy_terms(body.model, body.part, body.state, terms);
    result.strain.insert(result.strain.end(), terms.strain.begin(), terms.strain.end());
    result.volumetric.insert(result.volumetric.end(), terms.volumetric.begin(),
                             terms.volumetric.end());
  }
  std::sort(result.strain.begin(), result.strain.end());
  std::sort(result.volumetric.begin(), result.volumetric.end());
  return result;
}

RanksResult run_on_ranks(const Mesh& mesh, const SolverOptions& solver, int n_steps, int n_ranks,
                         int n_threads, Motion motion) {
  const int before = thread_count();
  set_thread_count(n_threads);
  const std::vector<std::int32_t> owner = partition_nodes(mesh, n_ranks);
  std::vector<Body> ranks;
  for (int rank = 0; rank < n_ranks; ++rank)
    ranks.push_back(make_body(mesh, options_for(mesh, solver), owner, rank));
  for (int k = 0; k < n_steps; ++k) step(ranks, owner, 2e-4, motion);
  average(ranks, owner);
  RanksResult result = collect(ranks, mesh.X.size());
  set_thread_count(before);
  return result;
}

}  // namespace trocar
