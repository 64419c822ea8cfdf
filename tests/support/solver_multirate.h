// Bodies with a few small elements, stepped with local time steps.
#pragma once

#include <memory>

#include "mesh_fixtures.h"
#include "solver/multirate.h"
#include "solver_body.h"

namespace trocar {

// A block of 10 mm cells, n times finer, with a node close to a facet.
inline Mesh with_sliver(BoxElements elements, std::uint64_t seed = 5, int n = 1) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.05, .04, .04), {5 * n, 4 * n, 4 * n}, elements);
  jitter(mesh, .03, seed);
  const auto near = [](const Vec3& X) { return (X - Vec3(.03, .02, .02)).norm(); };
  auto node = std::min_element(mesh.X.begin(), mesh.X.end(),
                               [&](const Vec3& a, const Vec3& b) { return near(a) < near(b); });
  node->x() += .009 / n;
  return mesh;
}

struct Refined {
  Body body;
  Communicator alone;
  MultiRatePlan plan;
  std::unique_ptr<MultiRate> multirate;

  explicit Refined(const Mesh& mesh, BodyOptions options = {});
};

inline Refined::Refined(const Mesh& mesh, BodyOptions options)
    : body(make_body(mesh, std::move(options))) {
  plan = plan_multirate(body.mesh, resting_elements(body.mesh, body.materials, body.model.options));
  const std::vector<std::int32_t> owner(body.mesh.X.size(), 0);
  multirate = make_multirate(plan,
                             {.mesh = body.mesh,
                              .materials = body.materials,
                              .node_owner = owner,
                              .part = body.part,
                              .model = body.model},
                             alone);
}

// Of a step dt at the present displacement.
inline const std::vector<double>& refined_force(Refined& refined, double dt,
                                                std::span<const PrescribedNode> held = {}) {
  Body& body = refined.body;
  force(body);
  refine_force({.model = body.model, .state = body.state, .prescribed = held, .dt = dt},
               *refined.multirate, body.scratch);
  return body.scratch.force;
}

inline void refined_step(Refined& refined, double dt, std::span<PrescribedNode> held = {}) {
  refined_force(refined, dt, held);
  integrate(refined.body.model, refined.body.scratch, held, dt, refined.body.state);
}

// The step that it is said to bear. limit_of(body): 2 / omega of what is not fixed.
template <class LimitOf>
double stated_limit(Refined& refined, const LimitOf& limit_of) {
  const double all = limit_of(refined.body);
  refined.body.model.fixed.swap(refined.multirate->coarse_fixed);
  const double coarse = limit_of(refined.body);
  refined.body.model.fixed.swap(refined.multirate->coarse_fixed);
  return std::min(coarse, all * refined.multirate->steps.limit / 2);
}

// Energy at the beginning of a step, with 1/2 m v- · v+, and the step.
inline double refined_step_and_measure(Refined& refined, double dt) {
  Body& body = refined.body;
  const double W = stored_energy(body);
  const std::vector<double> before = body.state.v;
  refined_step(refined, dt);
  double T = 0;
  for (std::size_t k = 0; k < before.size(); ++k)
    T += .5 * body.model.mass[k / 3] * before[k] * body.state.v[k];
  return T + W;
}

}  // namespace trocar
