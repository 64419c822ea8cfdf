// The tangent stiffness of a body from differences of its forces, and the exact limit of its step.
#pragma once

#include <Eigen/Eigenvalues>

#include "solver_body.h"

namespace trocar {

// -df/du by central differences with `h` [m].
inline Eigen::MatrixXd tangent_stiffness(Body& body, double h) {
  const auto n = static_cast<Eigen::Index>(body.scratch.force.size());
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    double& u = body.state.u[static_cast<std::size_t>(k)];
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

// 2 / omega_max of the free body in its present deformation.
inline double true_limit(Body& body, double h) {
  Eigen::MatrixXd K = tangent_stiffness(body, h);
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    for (Eigen::Index j = 0; j < K.cols(); ++j)
      K(i, j) /= std::sqrt(body.model.mass[static_cast<std::size_t>(i / 3)] *
                           body.model.mass[static_cast<std::size_t>(j / 3)]);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, Eigen::EigenvaluesOnly);
  return 2 / std::sqrt(solver.eigenvalues().maxCoeff());
}

}  // namespace trocar
