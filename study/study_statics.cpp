#include "study/study_statics.h"

#include "base/timers.h"
#include "solver/relax.h"

namespace trocar {

namespace {

// What is out of balance, relative to the reaction: in single precision forces round to a few 1e-6
// of it, and the references are known to a few 1e-4.
constexpr double tolerance = 1e-5;
constexpr std::int64_t most_iterations = 40000;  // 24 cells take 7000

std::vector<PrescribedNode> held_nodes(const StudyBody& body, const StaticBox& box) {
  std::vector<PrescribedNode> held;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    if (const std::optional<Vec3> u = box.moved(body.mesh.X[i]))
      held.push_back({.node = i, .u_next = *u});
  return held;
}

}  // namespace

Outcome relax_box(const Case& c, const StaticBox& box,
                  const std::function<double(const StudyBody&)>& value) {
  Outcome outcome;
  const double start = thread_seconds();
  outcome.h = box.size[0] / box.n[0];
  StudyBody body =
      make_study_body(make_box(Vec3::Zero(), box.size, box.n, c.method.elements), outcome.h,
                      box.material, box.fixed, solver_options(c.method, c.precision));
  const std::vector<PrescribedNode> held = held_nodes(body, box);
  const double ready = thread_seconds();
  const Relaxation relaxed = relax(
      body.model, {.prescribed = held, .max_iterations = most_iterations, .tolerance = tolerance},
      body.state, body.scratch);
  outcome.stepping_seconds = thread_seconds() - ready;
  outcome.setup_seconds = ready - start;
  outcome.n_elements = body.mesh.n_elements();
  outcome.n_steps = relaxed.iterations;
  outcome.value = value(body);
  if (!relaxed.is_converged) outcome.trouble = "the relaxation did not converge";
  return outcome;
}

Vec3 reaction_above(const StudyBody& body, double least_z) {
  Vec3 R = Vec3::Zero();
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
    if (body.mesh.X[i].z() >= least_z) R -= Vec3::Map(&body.scratch.force[3 * i]);
  return R;
}

}  // namespace trocar
