// Linear algebra of the tests whose templates take seconds to compile, compiled once.
#pragma once

#include <Eigen/Core>

#include "solver_body.h"

namespace trocar {

// Of the symmetric A, ascending.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& A);
// Of K x = lambda M x, ascending; M positive definite.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);
// Of A x = b.
Eigen::VectorXd solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Mat3 random_orthogonal(Noise& noise);
// By turns of k two or three are equal or nearly so.
Vec3 random_eigenvalues(int k, Noise& noise);

}  // namespace trocar
