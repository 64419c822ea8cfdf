#include "verification_statics.h"

#include "solver/element_setup.h"

namespace trocar {

SolverOptions solver_options(const Variant& variant) {
  SolverOptions options{.hourglass = variant.hourglass,
                        .precision = variant.precision,
                        .own_volume_stiffness = variant.own_volume_stiffness};
  if (shape_of(variant.formulation) == ElementType::hex8)
    options.hex8 = variant.formulation;
  else
    options.tet4 = variant.formulation;
  return options;
}

std::string mesh_name(const Variant& variant, const std::array<int, 3>& n) {
  return std::string(variant.name) + " " + std::to_string(n[0]) + " x " + std::to_string(n[1]) +
         " x " + std::to_string(n[2]);
}

Body make_box_body(const Variant& variant, const BoxProblem& problem) {
  Mesh mesh = make_box(Vec3::Zero(), problem.size, problem.n, variant.elements);
  BodyOptions options{.materials = {problem.material}, .solver = solver_options(variant)};
  options.solver.gravity = problem.gravity;
  for (Vec3& X : mesh.X) {
    options.fixed.push_back(problem.fixed ? problem.fixed(X) : FixedMask{0});
    if (problem.map) X = problem.map(X);
  }
  return make_body(std::move(mesh), options);
}

double face_share(const Vec3& X, const Vec3& size, const std::array<int, 3>& n, int axis) {
  double share = 1;
  for (int j = 0; j < 3; ++j) {
    if (j == axis) continue;
    const bool is_edge = X[j] < 1e-9 * size[j] || X[j] > (1 - 1e-9) * size[j];
    share *= (is_edge ? 0.5 : 1.0) / n[j];
  }
  return share;
}

bool is_inside(const Vec3& X, double side) {
  return (X.array() > 1e-9).all() && (X.array() < side - 1e-9).all();
}

std::vector<double> load_by(const Body& body, const std::function<Vec3(const Vec3& X)>& force) {
  std::vector<double> load;
  for (const Vec3& X : body.mesh.X)
    for (const double f : Vec3(force(X))) load.push_back(f);
  return load;
}

Relaxation settle(Body& body, const RelaxTask& task) {
  const Relaxation result = relax(body.model, task, body.state, body.scratch);
  std::printf("relaxed in %lld iterations to %.1e\n", static_cast<long long>(result.iterations),
              result.residual);
  EXPECT_TRUE(result.is_converged);
  return result;
}

Vec3 displacement_at(const Body& body, const Vec3& X) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < body.mesh.X.size(); ++i)
    if ((body.mesh.X[i] - X).squaredNorm() < (body.mesh.X[nearest] - X).squaredNorm()) nearest = i;
  EXPECT_LT((body.mesh.X[nearest] - X).norm(), 1e-9 * (1 + X.norm()));
  return Vec3::Map(&body.state.u[3 * nearest]);
}

}  // namespace trocar
