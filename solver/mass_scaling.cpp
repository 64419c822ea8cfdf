#include "solver/mass_scaling.h"

#include <algorithm>

#include "base/check.h"
#include "mesh/connected_nodes.h"

namespace trocar {

namespace {

// Of the element's own corner mass m_e / n.
void add_corner_masses(const Mesh& mesh, const RestingElement& element, double wanted_step,
                       MassScaling& scaling) {
  const double ratio = wanted_step / element.step;
  const std::span<const std::int32_t> corner = mesh.corners(element.number);
  for (const std::int32_t node : corner)
    scaling.added[node] += (ratio * ratio - 1) * element.mass / static_cast<double>(corner.size());
}

void link_clusters(const Mesh& mesh, MassScaling& scaling) {
  const std::vector<std::int32_t> lowest = connected_nodes(mesh, scaling.element);
  for (std::int32_t node = 0; node < mesh.n_nodes(); ++node)
    if (scaling.added[node] > 0) scaling.node.push_back(node);
  std::stable_sort(scaling.node.begin(), scaling.node.end(),
                   [&](std::int32_t a, std::int32_t b) { return lowest[a] < lowest[b]; });
  for (std::size_t k = 0; k < scaling.node.size(); ++k)
    if (k == 0 || lowest[scaling.node[k]] != lowest[scaling.node[k - 1]])
      scaling.offset.push_back(static_cast<std::int32_t>(k));
  scaling.offset.push_back(static_cast<std::int32_t>(scaling.node.size()));
}

// The clusters of this rank, in local numbers.
void take_clusters(const MassScaling& scaling, const Part& part, Model& model) {
  MassClusters& clusters = model.clusters;
  clusters.of_node.assign(static_cast<std::size_t>(model.n_owned), -1);
  for (std::int32_t c = 0; c < scaling.n_clusters(); ++c) {
    const std::int32_t first = part.node_local[scaling.node[scaling.offset[c]]];
    if (first < 0 || first >= model.n_owned) continue;
    double total = 0;
    for (std::int32_t k = scaling.offset[c]; k < scaling.offset[c + 1]; ++k) {
      const std::int32_t local = part.node_local[scaling.node[k]];
      CHECK_OP(local, >=, 0);
      CHECK_OP(local, <, model.n_owned);
      clusters.of_node[local] = static_cast<std::int32_t>(clusters.total.size());
      clusters.node.push_back(local);
      clusters.added.push_back(scaling.added[scaling.node[k]]);
      total += clusters.added.back();
    }
    clusters.total.push_back(total);
    clusters.offset.push_back(static_cast<std::int32_t>(clusters.node.size()));
  }
}

}  // namespace

MassScaling find_mass_scaling(const Mesh& mesh, std::span<const Material> materials,
                              const SolverOptions& options, double wanted_step) {
  MassScaling scaling{.wanted_step = wanted_step};
  scaling.added.assign(mesh.X.size(), 0.0);
  // A broken element has no step; building the model will name it.
  for (const RestingElement& element : resting_elements(mesh, materials, options)) {
    if (!(element.step > 0 && element.step < wanted_step)) continue;
    scaling.element.push_back(element.number);
    add_corner_masses(mesh, element, wanted_step, scaling);
  }
  link_clusters(mesh, scaling);
  return scaling;
}

void keep_clusters_whole(const MassScaling& scaling, std::span<std::int32_t> node_owner) {
  for (std::int32_t c = 0; c < scaling.n_clusters(); ++c)
    for (std::int32_t k = scaling.offset[c]; k < scaling.offset[c + 1]; ++k)
      node_owner[scaling.node[k]] = node_owner[scaling.node[scaling.offset[c]]];
}

void scale_mass(const MassScaling& scaling, const Part& part, Model& model) {
  CHECK(model.clusters.node.empty());
  take_clusters(scaling, part, model);
  if (!model.clusters.node.empty()) model.inertia = model.mass;
  for (std::size_t k = 0; k < model.clusters.node.size(); ++k)
    model.inertia[model.clusters.node[k]] += model.clusters.added[k];
  for (std::size_t k = 0; k < model.element_step.size(); ++k)
    if (std::binary_search(scaling.element.begin(), scaling.element.end(), part.element_global[k]))
      model.element_step[k] = scaling.wanted_step;
}

}  // namespace trocar
