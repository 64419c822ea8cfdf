// Products with M = diag(m + d) - sum_c d d^T / s_c of selective mass scaling (mass_scaling.h) and
// with its inverse. Without clusters M = diag(m).
#pragma once

#include <span>
#include <vector>

#include "solver/model.h"

namespace trocar {

// Adds d c to the force, c the mean acceleration sum d a / s of the node's cluster: the
// acceleration of M a = f is then force / inertia. Fixed components have none, `given` nodes the
// one given. `sums` is room to compute in.
//   c (s - sum_free d^2 / (m + d)) = sum_free d f / (m + d) + sum_given d a
void add_cluster_force(const Model& model, std::span<const GivenAcceleration> given,
                       std::span<double> force, std::vector<double>& sums);

// From Mx = diag(m + d) x to M x, (n_owned * 3); x may be longer.
void subtract_cluster_means(const Model& model, std::span<const double> x, std::span<double> Mx);

// scale d |v - mean v|^2 to sums of owned nodes, what they have more than scale m |v|^2.
void add_cluster_squares(const Model& model, std::span<const double> v, double scale,
                         std::span<double> sums);

}  // namespace trocar
