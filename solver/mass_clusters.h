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

// To kinetic energies m |v|^2 / 2 of owned nodes: d |v - mean v|^2 / 2.
void add_cluster_kinetic(const Model& model, std::span<const double> v, std::span<double> kinetic);

// sum d x / s of the cluster over x(local node).
template <class Field>
Vec3 cluster_mean(const MassClusters& clusters, std::size_t c, const Field& x) {
  Vec3 sum = Vec3::Zero();
  for (std::int32_t k = clusters.offset[c]; k < clusters.offset[c + 1]; ++k)
    sum += clusters.added[k] * x(clusters.node[k]);
  return sum / clusters.total[c];
}

}  // namespace trocar
