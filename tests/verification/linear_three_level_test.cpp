// Equation (3) of Serby, Harders and Szekely 2001, stepped with assembled matrices, against the
// program's leapfrog of element forces: the same trajectory to rounding. The matrices step in long
// double, because the three-level form loses digits that the leapfrog keeps.
#include <gtest/gtest.h>

#include <Eigen/SparseCore>

#include "larger_or_nan.h"
#include "solver_body.h"

using namespace trocar;

using Real = long double;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Sparse = Eigen::SparseMatrix<Real>;

// Textbook stiffness: V B^T D B with Voigt strains; plane strain is the same D with z left out.
static Matrix element_stiffness(const Body& body, std::int32_t e) {
  const std::span<const std::int32_t> node = body.mesh.corners(e);
  const auto n = static_cast<Eigen::Index>(node.size());
  const bool is_plane = n == 3;
  // Barycentric gradients: columns of the inverse of the matrix of (1, X, Y[, Z]).
  Matrix M(n, n);
  for (Eigen::Index a = 0; a < n; ++a) {
    M(a, 0) = 1;
    for (Eigen::Index j = 1; j < n; ++j) M(a, j) = body.mesh.X[node[a]][j - 1];
  }
  const Matrix inverse = M.inverse();
  const Real V = std::abs(M.determinant()) / (is_plane ? 2 : 6) *
                 (is_plane ? body.model.options.thickness : 1);
  Matrix B = Matrix::Zero(6, 3 * n);
  for (Eigen::Index a = 0; a < n; ++a) {
    Eigen::Matrix<Real, 3, 1> d = Eigen::Matrix<Real, 3, 1>::Zero();
    for (Eigen::Index j = 1; j < n; ++j) d[j - 1] = inverse(j, a);
    B(0, 3 * a) = B(3, 3 * a + 1) = B(5, 3 * a + 2) = d[0];
    B(1, 3 * a + 1) = B(3, 3 * a) = B(4, 3 * a + 2) = d[1];
    B(2, 3 * a + 2) = B(4, 3 * a + 1) = B(5, 3 * a) = d[2];
  }
  const Material& material = body.materials[0];
  const Real E = material.young_modulus, nu = material.poisson_ratio;
  Matrix D = Matrix::Zero(6, 6);
  D.topLeftCorner(3, 3).setConstant(nu);
  D.topLeftCorner(3, 3).diagonal().setConstant(1 - nu);
  D.bottomRightCorner(3, 3).diagonal().setConstant((1 - 2 * nu) / 2);
  D *= E / ((1 + nu) * (1 - 2 * nu));
  return V * B.transpose() * D * B;
}

static Sparse assemble(const Body& body) {
  std::vector<Eigen::Triplet<Real>> entries;
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
    const Matrix K = element_stiffness(body, e);
    const std::span<const std::int32_t> node = body.mesh.corners(e);
    for (Eigen::Index i = 0; i < K.rows(); ++i)
      for (Eigen::Index j = 0; j < K.cols(); ++j)
        entries.emplace_back(3 * node[i / 3] + i % 3, 3 * node[j / 3] + j % 3, K(i, j));
  }
  const auto n = static_cast<Eigen::Index>(3 * body.mesh.X.size());
  Sparse K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

// U(t+dt) from U(t) and U(t-dt):
// (M/dt^2 + C/2dt) U+ = R - (K - 2M/dt^2) U - (M/dt^2 - C/2dt) U-
struct ThreeLevel {
  Sparse K;
  Vector M, R, U, U_before;
  Real alpha, dt;

  void step(const std::vector<FixedMask>& fixed) {
    const Vector C = alpha * M;
    const Vector left = M / (dt * dt) + C / (2 * dt);
    const Vector right =
        R - K * U + (2 / (dt * dt)) * M.cwiseProduct(U) -
        ((M.array() / (dt * dt) - C.array() / (2 * dt)) * U_before.array()).matrix();
    Vector next = right.cwiseQuotient(left);
    for (Eigen::Index k = 0; k < next.size(); ++k)
      if ((fixed[k / 3] >> (k % 3) & 1) != 0) next[k] = U[k];
    U_before = U;
    U = next;
  }
};

static void expect_same_trajectory(const Mesh& mesh) {
  BodyOptions options{.materials = {{MaterialModel::linear, 3000, .45, 1060}},
                      .solver = {.mass_damping = 5, .gravity = Vec3(.5, -9.81, 0)}};
  for (const Vec3& X : mesh.X) options.fixed.push_back(X.x() < 1e-9 ? 7 : 0);
  Body body = make_body(mesh, options);
  const double dt = .9 * least_element_step(body);
  const auto n = static_cast<Eigen::Index>(body.state.u.size());

  ThreeLevel reference{.K = assemble(body),
                       .M = Vector(n),
                       .R = Vector(n),
                       .U = Vector::Zero(n),
                       .U_before = Vector::Zero(n),
                       .alpha = 5,
                       .dt = dt};
  for (Eigen::Index k = 0; k < n; ++k) {
    reference.M[k] = body.mass[k / 3];
    reference.R[k] = body.mass[k / 3] * options.solver.gravity[k % 3];
  }
  if (mesh.dimension() == 2)
    for (FixedMask& mask : options.fixed) mask |= 4;
  // A three-level scheme needs two states: at rest, and the program's first step.
  step(body, dt);
  reference.U = Eigen::Map<const Eigen::VectorXd>(body.state.u.data(), n).cast<Real>();
  Real largest_u = 0, largest_difference = 0;
  for (int k = 0; k < 500; ++k) {
    step(body, dt);
    reference.step(options.fixed);
    const Vector u = Eigen::Map<const Eigen::VectorXd>(body.state.u.data(), n).cast<Real>();
    largest_u = larger_or_nan(largest_u, u.lpNorm<Eigen::Infinity>());
    largest_difference =
        larger_or_nan(largest_difference, (u - reference.U).lpNorm<Eigen::Infinity>());
  }
  std::printf("largest displacement %Lg m, relative difference %.2Lg\n", largest_u,
              largest_difference / largest_u);
  EXPECT_GT(largest_u, 1e-3);
  // 500 steps, each of some roundings of 1e-16 of the displacement.
  EXPECT_LT(largest_difference, 1e-12 * largest_u);
}

TEST(LinearTriangles, follow_equation_3_of_the_paper_with_assembled_matrices) {
  expect_same_trajectory(make_rectangle(.070, .040, 10, 8));
}

TEST(LinearTetrahedra, follow_equation_3_of_the_paper_with_assembled_matrices) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.06, .02, .02), {6, 3, 3}, BoxElements::tet4_kuhn);
  jitter(mesh, .15, 2);
  expect_same_trajectory(mesh);
}
