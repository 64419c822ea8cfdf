#include "study/study_body.h"

#include <algorithm>
#include <cmath>

#include "base/communicator.h"
#include "engine/body_search.h"
#include "solver/watch.h"

namespace trocar {

namespace {

void run_steps(StudyBody& body, std::int64_t n, double dt,
               const std::function<void(double dt)>& after_step) {
  for (std::int64_t k = 0; k < n; ++k) {
    find_force(body.model, body.neighbours, body.state, body.scratch);
    integrate(body.model, body.scratch, {}, dt, body.state);
    after_step(dt);
  }
}

}  // namespace

StudyBody make_study_body(Mesh mesh, double h, const Material& material,
                          const std::function<FixedMask(const Vec3& X)>& fixed,
                          const SolverOptions& options) {
  StudyBody body;
  body.mesh = std::move(mesh);
  body.h = h;
  std::vector<FixedMask> mask;
  for (const Vec3& X : body.mesh.X) mask.push_back(fixed ? fixed(X) : FixedMask{0});
  body.mass = lumped_mass(body.mesh, std::vector<double>{material.density}, options.thickness);
  body.part = whole_part(body.mesh);
  body.model =
      build_model(body.mesh, body.part, std::vector<Material>{material}, mask, body.mass, options);
  body.state = make_state(body.model);
  body.scratch = make_scratch(body.model);
  return body;
}

double stable_step(StudyBody& body) {
  const Watch seen = watch(body.model, body.part, body.state);
  if (!seen.is_finite || !(seen.least_J > 0)) return 0;
  const double amplitude = search_amplitude(body.model, body.h);
  return std::max(seen.stable_step, search_step(body, amplitude, Communicator()));
}

bool advance_frame(StudyBody& body, double length, double factor,
                   const std::function<void(double dt)>& after_step) {
  const double dt_most = factor * stable_step(body);
  if (!(dt_most > 0)) return false;
  const auto n = static_cast<std::int64_t>(std::ceil(length / dt_most));
  run_steps(body, n, length / static_cast<double>(n), after_step);
  return true;
}

std::int32_t nearest_node(const Mesh& mesh, const Vec3& X) {
  const auto nearer = [&](const Vec3& a, const Vec3& b) {
    return (a - X).squaredNorm() < (b - X).squaredNorm();
  };
  return static_cast<std::int32_t>(std::min_element(mesh.X.begin(), mesh.X.end(), nearer) -
                                   mesh.X.begin());
}

}  // namespace trocar
