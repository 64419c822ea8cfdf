// Bodies with a few small elements, stepped with local time steps.
#pragma once

#include <memory>

#include "mesh_fixtures.h"
#include "solver/multirate.h"
#include "solver_body.h"

namespace trocar {

// A block of 10 mm cells, n times finer, with a node close to a facet.
Mesh with_sliver(BoxElements elements, std::uint64_t seed = 5, int n = 1);

struct Refined {
  Body body;
  Communicator alone;
  MultiRatePlan plan;
  std::unique_ptr<MultiRate> multirate;

  explicit Refined(const Mesh& mesh, BodyOptions options = {});
};

// Of a step dt at the present displacement.
const std::vector<double>& refined_force(Refined& refined, double dt,
                                         std::span<const PrescribedNode> held = {});

void refined_step(Refined& refined, double dt, std::span<PrescribedNode> held = {});

// The step that it is said to bear. limit_of(body): 2 / omega of what is not fixed.
template <class LimitOf>
double stated_limit(Refined& refined, const LimitOf& limit_of) {
  const double all = limit_of(refined.body);
  refined.body.model.fixed.swap(refined.multirate->coarse_fixed);
  const double coarse = limit_of(refined.body);
  refined.body.model.fixed.swap(refined.multirate->coarse_fixed);
  return std::min(coarse, all * refined.multirate->steps.limit / 2);
}

// As step_and_measure().
double refined_step_and_measure(Refined& refined, double dt);

}  // namespace trocar
