#include "solver_multirate.h"

namespace trocar {

Mesh with_sliver(BoxElements elements, std::uint64_t seed, int n) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.05, .04, .04), {5 * n, 4 * n, 4 * n}, elements);
  jitter(mesh, .03, seed);
  const auto near = [](const Vec3& X) { return (X - Vec3(.03, .02, .02)).norm(); };
  auto node = std::min_element(mesh.X.begin(), mesh.X.end(),
                               [&](const Vec3& a, const Vec3& b) { return near(a) < near(b); });
  node->x() += .009 / n;
  return mesh;
}

Refined::Refined(const Mesh& mesh, BodyOptions options)
    : body(make_body(mesh, std::move(options))) {
  plan = plan_multirate(body.mesh, node_corners(body.mesh),
                        resting_elements(body.mesh, body.materials, body.model.options));
  const std::vector<std::int32_t> owner(body.mesh.X.size(), 0);
  multirate = make_multirate(plan,
                             {.mesh = body.mesh,
                              .materials = body.materials,
                              .node_owner = owner,
                              .part = body.part,
                              .model = body.model},
                             alone);
}

const std::vector<double>& refined_force(Refined& refined, double dt,
                                         std::span<const PrescribedNode> held) {
  Body& body = refined.body;
  force(body);
  refine_force({.model = body.model, .state = body.state, .prescribed = held, .dt = dt},
               *refined.multirate, body.scratch);
  return body.scratch.force;
}

void refined_step(Refined& refined, double dt, std::span<PrescribedNode> held) {
  refined_force(refined, dt, held);
  integrate(refined.body.model, refined.body.scratch, held, dt, refined.body.state);
}

double refined_step_and_measure(Refined& refined, double dt) {
  return step_and_measure(refined.body, [&] { refined_step(refined, dt); });
}

}  // namespace trocar
