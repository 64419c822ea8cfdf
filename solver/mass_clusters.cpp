#include "solver/mass_clusters.h"

namespace trocar {

namespace {

// sum d x / s of the cluster over x(local node).
template <class Field>
Vec3 cluster_mean(const MassClusters& clusters, std::size_t c, const Field& x) {
  Vec3 sum = Vec3::Zero();
  for (std::int32_t k = clusters.offset[c]; k < clusters.offset[c + 1]; ++k)
    sum += clusters.added[k] * x(clusters.node[k]);
  return sum / clusters.total[c];
}

// Both sides of the equation for c, of one cluster or all of them, x y z each.
struct Sides {
  std::span<double> force, mass;
};

// As if no acceleration were given.
void sum_cluster(const Model& model, std::size_t c, std::span<const double> force,
                 const Sides& sides) {
  const MassClusters& clusters = model.clusters;
  for (std::int32_t k = clusters.offset[c]; k < clusters.offset[c + 1]; ++k) {
    const std::int64_t i = clusters.node[k];
    const double d = clusters.added[k], share = d / model.inertia[i];
    for (int j = 0; j < 3; ++j) {
      const std::size_t at = 3 * c + j;
      const bool is_free = !is_fixed(model, i, j);
      sides.mass[at] += is_free ? share * model.mass[i] : d;
      sides.force[at] += is_free ? share * force[3 * i + j] : 0;
    }
  }
}

// In place of what sum_cluster took the node's components for.
void correct_given(const Model& model, const GivenAcceleration& given,
                   std::span<const double> force, const Sides& sides) {
  const std::int64_t i = given.node;
  const std::int32_t c = model.clusters.of_node[i];
  if (c < 0) return;
  const double d = model.inertia[i] - model.mass[i], share = d / model.inertia[i];
  for (int j = 0; j < 3; ++j) {
    if (is_fixed(model, i, j)) continue;
    const auto at = static_cast<std::size_t>(3 * c + j);
    sides.mass[at] += d - share * model.mass[i];
    sides.force[at] += d * given.a[j] - share * force[3 * i + j];
  }
}

}  // namespace

void add_cluster_force(const Model& model, std::span<const GivenAcceleration> given,
                       std::span<double> force, std::vector<double>& sums) {
  const MassClusters& clusters = model.clusters;
  const std::size_t n = clusters.total.size();
  if (n == 0) return;
  sums.assign(6 * n, 0.0);
  const Sides sides{.force = std::span(sums).first(3 * n), .mass = std::span(sums).last(3 * n)};
  for (std::size_t c = 0; c < n; ++c) sum_cluster(model, c, force, sides);
  for (const GivenAcceleration& node : given) correct_given(model, node, force, sides);
  for (std::size_t c = 0; c < n; ++c)
    for (std::int32_t k = clusters.offset[c]; k < clusters.offset[c + 1]; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        force[3 * static_cast<std::size_t>(clusters.node[k]) + j] +=
            clusters.added[k] * (sides.force[3 * c + j] / sides.mass[3 * c + j]);
}

void subtract_cluster_means(const Model& model, std::span<const double> x, std::span<double> Mx) {
  const MassClusters& clusters = model.clusters;
  for (std::size_t c = 0; c < clusters.total.size(); ++c) {
    const Vec3 mean =
        cluster_mean(clusters, c, [&](std::int64_t i) { return Vec3::Map(&x[3 * i]); });
    for (std::int32_t k = clusters.offset[c]; k < clusters.offset[c + 1]; ++k)
      Vec3::Map(&Mx[3 * std::int64_t{clusters.node[k]}]) -= clusters.added[k] * mean;
  }
}

void add_cluster_squares(const Model& model, std::span<const double> v, double scale,
                         std::span<double> sums) {
  const MassClusters& clusters = model.clusters;
  for (std::size_t c = 0; c < clusters.total.size(); ++c) {
    const auto v_of = [&](std::int64_t i) { return Vec3::Map(&v[3 * i]); };
    const Vec3 mean = cluster_mean(clusters, c, v_of);
    for (std::int32_t k = clusters.offset[c]; k < clusters.offset[c + 1]; ++k)
      sums[clusters.node[k]] +=
          scale * clusters.added[k] * (v_of(clusters.node[k]) - mean).squaredNorm();
  }
}

}  // namespace trocar
