#include "solver_stiffness.h"

#include "solver_algebra.h"

namespace trocar {

Eigen::MatrixXd tangent_stiffness(Body& body, double h) {
  const auto n = static_cast<Eigen::Index>(body.scratch.force.size());
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    double& u = body.state.u[k];
    const double kept = u;
    u = kept + h;
    K.col(k) = -Eigen::Map<const Eigen::VectorXd>(force(body).data(), n);
    u = kept - h;
    K.col(k) += Eigen::Map<const Eigen::VectorXd>(force(body).data(), n);
    K.col(k) /= 2 * h;
    u = kept;
  }
  return 0.5 * (K + K.transpose());
}

double true_limit(Body& body, double h) {
  Eigen::MatrixXd K = tangent_stiffness(body, h);
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    for (Eigen::Index j = 0; j < K.cols(); ++j)
      K(i, j) /= std::sqrt(body.model.mass[i / 3] * body.model.mass[j / 3]);
  return 2 / std::sqrt(eigenvalues(K).maxCoeff());
}

}  // namespace trocar
