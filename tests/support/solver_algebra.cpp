#include "solver_algebra.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace trocar {

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& A) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

Eigen::VectorXd solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.partialPivLu().solve(b);
}

Mat3 random_orthogonal(Noise& noise) {
  Mat3 A;
  for (double& a : A.reshaped()) a = noise();
  return A.householderQr().householderQ();
}

Vec3 random_eigenvalues(int k, Noise& noise) {
  Vec3 d(noise(), noise(), noise());
  if (k % 4 == 1) d[1] = d[0];
  if (k % 4 == 2) d[1] = d[0] + 1e-9 * noise();
  if (k % 16 == 3) d = Vec3::Constant(d[0]);
  return d;
}

}  // namespace trocar
