// A body of several formulations and materials on ranks that live in one process; the halo is
// copied from the owners.
#pragma once

#include <algorithm>
#include <vector>

#include "mesh_fixtures.h"
#include "solver_body.h"

namespace trocar {

BodyOptions options_for(const Mesh& mesh, const SolverOptions& solver);

struct RanksResult {
  std::vector<double> u, v;  // global
  double stable_step = 1e300, least_J = 1e300;
  std::int32_t stable_element = -1;
  std::vector<double> strain, volumetric;  // sorted
};

void exchange(std::vector<Body>& ranks, const std::vector<std::int32_t>& owner,
              std::vector<double> State::*field, int width);

void average(std::vector<Body>& ranks, const std::vector<std::int32_t>& owner);

// How nodes come to their places: in a pass of their own, or as soon as their forces are known.
enum class Motion { after_forces, at_once };

void step(std::vector<Body>& ranks, const std::vector<std::int32_t>& owner, double dt,
          Motion motion = Motion::after_forces);

RanksResult collect(const std::vector<Body>& ranks, std::size_t n_nodes);

RanksResult run_on_ranks(const Mesh& mesh, const SolverOptions& solver, int n_steps, int n_ranks,
                         int n_threads, Motion motion = Motion::after_forces);

}  // namespace trocar
