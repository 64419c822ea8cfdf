#include "verification_modes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

namespace trocar {

// Supported components are left out; `dof` numbers the others.
struct FreeComponents {
  std::vector<int> dof;  // (3 n) or -1
  int n = 0;
};

static FreeComponents free_components(const Body& body) {
  FreeComponents free;
  for (std::size_t k = 0; k < body.scratch.force.size(); ++k)
    free.dof.push_back((body.model.fixed[k / 3] >> k % 3 & 1) == 0 ? free.n++ : -1);
  return free;
}

// M^-1/2 K M^-1/2, by central differences of 1e-6 m, in which the linear material has no error but
// rounding.
static Eigen::SparseMatrix<double> scaled_tangent(Body& body, const FreeComponents& free) {
  const double h = 1e-6;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < free.dof.size(); ++k) {
    if (free.dof[k] < 0) continue;
    body.state.u[k] = h;
    const std::vector<double> ahead = force(body);
    body.state.u[k] = -h;
    const std::vector<double>& behind = force(body);
    body.state.u[k] = 0;
    for (std::size_t l = 0; l < ahead.size(); ++l) {
      const double K = (behind[l] - ahead[l]) / (2 * h);
      if (free.dof[l] >= 0 && K != 0)
        entries.emplace_back(free.dof[l], free.dof[k],
                             K / std::sqrt(body.model.mass[l / 3] * body.model.mass[k / 3]));
    }
  }
  Eigen::SparseMatrix<double> A(free.n, free.n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

std::vector<double> lowest_frequencies(Body& body, int n) {
  const FreeComponents free = free_components(body);
  Eigen::SparseMatrix<double> A = scaled_tangent(body, free);
  Eigen::SparseMatrix<double> identity(free.n, free.n);
  identity.setIdentity();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(A + identity);
  Noise noise(1);
  Eigen::MatrixXd V =
      Eigen::MatrixXd::NullaryExpr(free.n, 2 * n, [&](auto, auto) { return noise(); });
  Eigen::VectorXd omega2;
  for (int k = 0; k < 12; ++k) {
    V = factor.solve(V);
    V = Eigen::HouseholderQR<Eigen::MatrixXd>(V).householderQ() *
        Eigen::MatrixXd::Identity(free.n, 2 * n);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(V.transpose() * (A * V));
    V = V * ritz.eigenvectors();
    omega2 = ritz.eigenvalues();
  }
  std::vector<double> frequency;
  for (int k = 0; k < n; ++k)
    frequency.push_back(std::sqrt(std::max(omega2[k], 0.0)) / (2 * std::acos(-1.0)));
  return frequency;
}

double highest_omega2(Body& body) {
  const auto n = static_cast<Eigen::Index>(body.scratch.force.size());
  const int n_steps = static_cast<int>(std::min<Eigen::Index>(80, n));
  Eigen::VectorXd scale(n);
  for (Eigen::Index k = 0; k < n; ++k) scale[k] = 1 / std::sqrt(body.model.mass[k / 3]);
  Noise noise(2);
  Eigen::MatrixXd Q(n, n_steps);
  Eigen::VectorXd q = Eigen::VectorXd::NullaryExpr(n, [&](auto) { return noise(); });
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n_steps, n_steps);
  for (int k = 0; k < n_steps; ++k) {
    Q.col(k) = q.normalized();
    for (Eigen::Index i = 0; i < n; ++i) body.state.u[i] = 1e-6 * scale[i] * Q(i, k);
    q = -1e6 * scale.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(force(body).data(), n));
    T.col(k).head(k + 1) = Q.leftCols(k + 1).transpose() * q;
    for (int twice = 0; twice < 2; ++twice)
      q -= Q.leftCols(k + 1) * (Q.leftCols(k + 1).transpose() * q);
    if (q.norm() < 1e-9 * std::abs(T(0, 0))) break;
  }
  const Eigen::MatrixXd S = T.selfadjointView<Eigen::Upper>();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S).eigenvalues().maxCoeff();
}

}  // namespace trocar
