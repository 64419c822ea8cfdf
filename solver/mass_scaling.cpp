#include "solver/mass_scaling.h"

#include <algorithm>
#include <numeric>

#include "base/check.h"
#include "mesh/connected_nodes.h"
#include "mesh/sub_mesh.h"

namespace trocar {

namespace {

// A broken element has no step; building the model will name it.
bool is_scaled(const RestingElement& element, double wanted_step) {
  return element.step > 0 && element.step < wanted_step;
}

std::vector<std::int32_t> numbers_of(std::span<const RestingElement> elements) {
  std::vector<std::int32_t> numbers;
  for (const RestingElement& element : elements) numbers.push_back(element.number);
  return numbers;
}

// (nodes of the scaled elements' mesh) (wanted / own step)^2 - 1 of the elements' own corner masses
// m_e / n.
std::vector<double> corner_masses(const Mesh& scaled, const MassScaling& scaling) {
  std::vector<double> added(scaled.X.size());
  for (std::int32_t k = 0; k < scaled.n_elements(); ++k) {
    const RestingElement& element = scaling.element[k];
    const double ratio = scaling.wanted_step / element.step;
    const std::span<const std::int32_t> corner = scaled.corners(k);
    for (const std::int32_t node : corner)
      added[node] += (ratio * ratio - 1) * element.mass / static_cast<double>(corner.size());
  }
  return added;
}

// All that follows from scaling.element.
void link_clusters(const Mesh& mesh, MassScaling& scaling) {
  const SubMesh scaled = make_sub_mesh(mesh, numbers_of(scaling.element));
  const std::vector<double> added = corner_masses(scaled.mesh, scaling);
  const std::vector<std::int32_t> lowest = connected_nodes(scaled.mesh);
  std::vector<std::size_t> order(added.size());
  std::iota(order.begin(), order.end(), 0);
  std::erase_if(order, [&](std::size_t i) { return !(added[i] > 0); });
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return lowest[a] < lowest[b]; });
  scaling.offset.clear();
  scaling.node.clear();
  scaling.added.clear();
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || lowest[order[k]] != lowest[order[k - 1]])
      scaling.offset.push_back(static_cast<std::int32_t>(k));
    scaling.node.push_back(scaled.node[order[k]]);
    scaling.added.push_back(added[order[k]]);
  }
  scaling.offset.push_back(static_cast<std::int32_t>(order.size()));
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
      clusters.added.push_back(scaling.added[k]);
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
  for (const RestingElement& element : resting_elements(mesh, materials, options))
    if (is_scaled(element, wanted_step)) scaling.element.push_back(element);
  link_clusters(mesh, scaling);
  return scaling;
}

void edit_mass_scaling(const Mesh& mesh, std::span<const Material> materials,
                       const SolverOptions& options, std::span<const std::int32_t> edited,
                       MassScaling& scaling) {
  std::erase_if(scaling.element, [&](const RestingElement& element) {
    return std::binary_search(edited.begin(), edited.end(), element.number);
  });
  for (const std::int32_t e : edited)
    if (const RestingElement element = resting_element(mesh, materials, options, e);
        is_scaled(element, scaling.wanted_step))
      scaling.element.push_back(element);
  std::sort(scaling.element.begin(), scaling.element.end(),
            [](const RestingElement& a, const RestingElement& b) { return a.number < b.number; });
  link_clusters(mesh, scaling);
}

bool are_clusters_whole(const MassScaling& scaling, std::span<const std::int32_t> node_owner) {
  for (std::int32_t c = 0; c < scaling.n_clusters(); ++c)
    for (std::int32_t k = scaling.offset[c]; k < scaling.offset[c + 1]; ++k)
      if (node_owner[scaling.node[k]] != node_owner[scaling.node[scaling.offset[c]]]) return false;
  return true;
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
  for (const RestingElement& element : scaling.element)
    if (const std::int64_t k = part.place_of(element.number); k >= 0)
      model.element_step[k] = scaling.wanted_step;
}

void unscale_mass(Model& model) {
  model.inertia.clear();
  model.clusters = {};
}

}  // namespace trocar
