// The tangent stiffness of a body from differences of its forces, and the exact limit of its step.
#pragma once

#include "solver_body.h"

namespace trocar {

// -df/du by central differences with `h` [m].
Eigen::MatrixXd tangent_stiffness(Body& body, double h);

// 2 / omega_max of the free body in its present deformation.
double true_limit(Body& body, double h);

}  // namespace trocar
