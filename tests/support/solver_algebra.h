// Linear algebra of the tests whose templates take seconds to compile, compiled once.
#pragma once

#include <Eigen/Core>

#include "base/vec.h"

namespace trocar {

// Of the symmetric A, ascending.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& A);
// Of K x = lambda M x, ascending; M positive definite.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);
// Of A x = b.
Eigen::VectorXd solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
// Q of A = Q R, orthogonal.
Mat3 orthogonal_factor(const Mat3& A);

}  // namespace trocar
