// Splitting the nodes among ranks. <metis.h> is seen by this file alone.
#include "mesh/partition.h"

#include <metis.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>

#include "base/error.h"
#include "mesh/facets.h"

namespace trocar {

// Nodes joined by an element's edge, as METIS wants them.
struct NodalGraph {
  std::vector<idx_t> offset;  // (n_nodes + 1)
  std::vector<idx_t> neighbour;
  std::vector<idx_t> work;  // (n_nodes)
};

// A corner's share of its element's step, in the ratio of docs/performance.md: a one-point
// hexahedron takes some 2.7 times as long as a tetrahedron, a triangle 1.25 times.
static int corner_work(ElementType type) {
  switch (type) {
    case ElementType::hex8:
      return 4;
    case ElementType::tet4:
      return 3;
    case ElementType::tri3:
      return 5;
  }
  return 1;
}

static std::vector<idx_t> node_work(const Mesh& mesh) {
  std::vector<idx_t> work(mesh.X.size(), 0);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (const std::int32_t i : mesh.corners(e))
      work[static_cast<std::size_t>(i)] += corner_work(mesh.element_type[e]);
  return work;
}

static NodalGraph nodal_graph(const Mesh& mesh) {
  const std::vector<std::array<std::int32_t, 2>> edges = mesh_edges(mesh);
  NodalGraph graph;
  graph.offset.assign(mesh.X.size() + 1, 0);
  graph.neighbour.resize(2 * edges.size());
  for (const auto& [i, j] : edges) {
    ++graph.offset[i + 1];
    ++graph.offset[j + 1];
  }
  for (std::size_t i = 1; i < graph.offset.size(); ++i) graph.offset[i] += graph.offset[i - 1];
  std::vector<idx_t> next(graph.offset.begin(), graph.offset.end() - 1);
  for (const auto& [i, j] : edges) {
    graph.neighbour[next[i]++] = j;
    graph.neighbour[next[j]++] = i;
  }
  graph.work = node_work(mesh);
  return graph;
}

static std::vector<std::int32_t> metis_owners(NodalGraph graph, int n_parts) {
  idx_t n_nodes = static_cast<idx_t>(graph.offset.size()) - 1, n_constraints = 1;
  idx_t n_owners = n_parts, cut = 0;
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  std::vector<idx_t> owner(static_cast<std::size_t>(n_nodes));
  const int status = METIS_PartGraphKway(
      &n_nodes, &n_constraints, graph.offset.data(), graph.neighbour.data(), graph.work.data(),
      nullptr, nullptr, &n_owners, nullptr, nullptr, options.data(), &cut, owner.data());
  if (status == METIS_ERROR_MEMORY)
    throw MachineError("not enough memory to partition the mesh with METIS");
  if (status != METIS_OK)
    throw MachineError("METIS failed to partition the mesh, status " + std::to_string(status));
  return {owner.begin(), owner.end()};
}

// On tiny meshes METIS may leave a part empty: it gets the last node of the largest part.
static void fill_empty_parts(std::vector<std::int32_t>& owner, int n_parts) {
  std::vector<std::int32_t> size(static_cast<std::size_t>(n_parts), 0);
  for (const std::int32_t part : owner) ++size[part];
  for (std::int32_t empty = 0; empty < n_parts; ++empty) {
    if (size[empty] > 0) continue;
    const auto largest =
        static_cast<std::int32_t>(std::max_element(size.begin(), size.end()) - size.begin());
    *std::find(owner.rbegin(), owner.rend(), largest) = empty;
    --size[largest];
    ++size[empty];
  }
}

std::vector<std::int32_t> partition_nodes(const Mesh& mesh, int n_parts) {
  if (mesh.n_nodes() < n_parts)
    throw InputError("the mesh has " + std::to_string(mesh.n_nodes()) + " nodes, too few for " +
                     std::to_string(n_parts) + " ranks: use at most " +
                     std::to_string(mesh.n_nodes()));
  if (n_parts == 1) return std::vector<std::int32_t>(mesh.X.size(), 0);
  std::vector<std::int32_t> owner = metis_owners(nodal_graph(mesh), n_parts);
  fill_empty_parts(owner, n_parts);
  return owner;
}

// What rank 0 found wrong, so that the others don't wait for its broadcast.
static std::string try_partition(const Mesh& mesh, int n_parts, std::vector<std::int32_t>& owner) {
  try {
    owner = partition_nodes(mesh, n_parts);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

std::vector<std::int32_t> partition_nodes(const Mesh& mesh, Communicator& communicator) {
  // The user's mistake is seen by every rank alike.
  if (communicator.size() == 1 || mesh.n_nodes() < communicator.size())
    return partition_nodes(mesh, communicator.size());
  std::vector<std::int32_t> owner;
  std::string trouble;
  if (communicator.is_root()) trouble = try_partition(mesh, communicator.size(), owner);
  trouble = communicator.first_text(trouble);
  if (!trouble.empty()) throw MachineError(trouble);

  std::vector<std::byte> bytes(owner.size() * sizeof(std::int32_t));
  if (!owner.empty()) std::memcpy(bytes.data(), owner.data(), bytes.size());
  communicator.broadcast(bytes);
  owner.resize(mesh.X.size());
  std::memcpy(owner.data(), bytes.data(), bytes.size());
  return owner;
}

double imbalance(const Mesh& mesh, std::span<const std::int32_t> node_owner, int n_parts) {
  const std::vector<idx_t> work = node_work(mesh);
  std::vector<double> of_part(static_cast<std::size_t>(n_parts), 0);
  for (std::size_t i = 0; i < work.size(); ++i) of_part[node_owner[i]] += work[i];
  const double sum = std::accumulate(of_part.begin(), of_part.end(), 0.0);
  return *std::max_element(of_part.begin(), of_part.end()) * n_parts / sum;
}

void apply_edit_to_owners(std::span<const std::int32_t> duplicate_parent,
                          std::vector<std::int32_t>& node_owner) {
  for (const std::int32_t parent : duplicate_parent) {
    const std::int32_t owner = node_owner[parent];
    node_owner.push_back(owner);
  }
}

}  // namespace trocar
