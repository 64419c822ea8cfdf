// Splitting the nodes among ranks. <metis.h> is seen by this file alone.
#include "mesh/partition.h"

#include <metis.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/grouped.h"
#include "base/on_root.h"
#include "mesh/facets.h"
#include "mesh/partition_work.h"

namespace trocar {

using Edges = std::vector<std::array<std::int32_t, 2>>;

static std::vector<idx_t> node_work(const Mesh& mesh) {
  std::vector<idx_t> work(mesh.X.size(), 0);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (const std::int32_t i : mesh.corners(e)) work[i] += corner_work(mesh.element_type[e]);
  return work;
}

// Groups of nodes that stay together: numbered as their nodes are.
struct Groups {
  std::vector<std::int32_t> of_node;  // ascending
  std::vector<idx_t> work;
};

static Groups make_groups(std::vector<std::int32_t> of_node, const Mesh& mesh) {
  Groups groups{std::move(of_node), {}};
  groups.work.assign(static_cast<std::size_t>(groups.of_node.back()) + 1, 0);
  const std::vector<idx_t> work = node_work(mesh);
  for (std::size_t i = 0; i < work.size(); ++i) groups.work[groups.of_node[i]] += work[i];
  return groups;
}

// Each node on its own.
static Groups single_nodes(const Mesh& mesh) {
  std::vector<std::int32_t> number(mesh.X.size());
  std::iota(number.begin(), number.end(), 0);
  return make_groups(std::move(number), mesh);
}

// Nodes that follow each other and are joined by an edge: rows of a regular numbering.
static Groups rows_of_nodes(const Mesh& mesh, const Edges& edges) {
  std::vector<std::int32_t> row(mesh.X.size(), 1);
  row[0] = 0;
  for (const auto& [i, j] : edges)
    if (j == i + 1) row[j] = 0;
  std::partial_sum(row.begin(), row.end(), row.begin());
  return make_groups(std::move(row), mesh);
}

// Groups joined by their nodes' edges, as METIS wants them.
struct Graph {
  std::vector<idx_t> offset;  // (groups + 1)
  std::vector<idx_t> neighbour, n_edges;
};

// The groups that each edge joins, from either side.
static Grouped<idx_t, idx_t> with_each_edge(const Groups& groups, const Edges& edges) {
  return group_items<idx_t, idx_t>(groups.work.size(), [&](const auto& put) {
    for (const auto& [i, j] : edges)
      if (const std::int32_t a = groups.of_node[i], b = groups.of_node[j]; a != b)
        put(a, b), put(b, a);
  });
}

static Graph graph_of(const Groups& groups, const Edges& edges) {
  Grouped<idx_t, idx_t> joined = with_each_edge(groups, edges);
  Graph graph{
      .offset = std::move(joined.offset), .neighbour = std::move(joined.item), .n_edges = {}};
  idx_t n = 0, begin = 0;
  for (std::size_t group = 0; group < groups.work.size(); ++group) {
    const idx_t end = graph.offset[group + 1], first = n;
    std::sort(graph.neighbour.begin() + begin, graph.neighbour.begin() + end);
    for (idx_t k = begin; k < end; ++k) {
      if (n == first || graph.neighbour[k] != graph.neighbour[n - 1]) {
        graph.neighbour[n++] = graph.neighbour[k];
        graph.n_edges.push_back(0);
      }
      ++graph.n_edges.back();
    }
    graph.offset[group + 1] = n;
    begin = end;
  }
  return graph;
}

static std::vector<std::int32_t> owners_of_nodes(const Groups& groups,
                                                 std::span<const idx_t> owner_of_group) {
  std::vector<std::int32_t> owner(groups.of_node.size());
  for (std::size_t i = 0; i < owner.size(); ++i)
    owner[i] = static_cast<std::int32_t>(owner_of_group[groups.of_node[i]]);
  return owner;
}

static std::vector<std::int32_t> metis_owners(Groups groups, const Edges& edges, int n_parts) {
  Graph graph = graph_of(groups, edges);
  auto n_groups = static_cast<idx_t>(groups.work.size());
  idx_t n_constraints = 1, n_owners = n_parts, cut = 0;
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  std::vector<idx_t> owner(groups.work.size());
  const int status =
      METIS_PartGraphKway(&n_groups, &n_constraints, graph.offset.data(), graph.neighbour.data(),
                          groups.work.data(), nullptr, graph.n_edges.data(), &n_owners, nullptr,
                          nullptr, options.data(), &cut, owner.data());
  if (status == METIS_ERROR_MEMORY)
    throw MachineError("not enough memory to partition the mesh with METIS");
  if (status != METIS_OK)
    throw MachineError("METIS failed to partition the mesh, status " + std::to_string(status));
  return owners_of_nodes(groups, owner);
}

// Equal work in the order of the numbers.
static std::vector<std::int32_t> owners_in_order(const Groups& groups, int n_parts) {
  const double sum = std::accumulate(groups.work.begin(), groups.work.end(), 0.0);
  std::vector<idx_t> owner;
  double before = 0;
  for (const idx_t work : groups.work) {
    const double middle = before + static_cast<double>(work) / 2;
    owner.push_back(std::min(static_cast<idx_t>(middle / sum * n_parts), idx_t{n_parts} - 1));
    before += static_cast<double>(work);
  }
  return owners_of_nodes(groups, owner);
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

static std::vector<std::int32_t> least_work(const Mesh& mesh,
                                            std::span<const std::vector<std::int32_t>> owners,
                                            int n_parts) {
  std::vector<double> work;
  for (const std::vector<std::int32_t>& owner : owners)
    work.push_back(most_work(mesh, owner, n_parts));
  return owners[std::min_element(work.begin(), work.end()) - work.begin()];
}

std::vector<std::int32_t> partition_nodes(const Mesh& mesh, int n_parts) {
  if (mesh.n_nodes() < n_parts)
    throw InputError("the mesh has " + std::to_string(mesh.n_nodes()) + " nodes, too few for " +
                     std::to_string(n_parts) + " ranks: use at most " +
                     std::to_string(mesh.n_nodes()));
  if (n_parts == 1) return std::vector<std::int32_t>(mesh.X.size(), 0);
  const Edges edges = mesh_edges(mesh);
  const Groups rows = rows_of_nodes(mesh, edges);
  std::vector<std::vector<std::int32_t>> owners = {
      metis_owners(single_nodes(mesh), edges, n_parts)};
  if (n_parts <= std::ssize(rows.work)) {
    owners.push_back(metis_owners(rows, edges, n_parts));
    owners.push_back(owners_in_order(rows, n_parts));
  }
  for (std::vector<std::int32_t>& owner : owners) fill_empty_parts(owner, n_parts);
  return least_work(mesh, owners, n_parts);
}

std::vector<std::int32_t> partition_nodes(const Mesh& mesh, Communicator& communicator) {
  // The user's mistake is seen by every rank alike.
  if (communicator.size() == 1 || mesh.n_nodes() < communicator.size())
    return partition_nodes(mesh, communicator.size());
  const std::vector<std::byte> bytes = read_on_root(communicator, [&] {
    const std::vector<std::int32_t> owner = partition_nodes(mesh, communicator.size());
    const std::span<const std::byte> all = std::as_bytes(std::span(owner));
    return std::vector<std::byte>(all.begin(), all.end());
  });
  std::vector<std::int32_t> owner(mesh.X.size());
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

void apply_edit_to_owners(const MeshEdit& edit, std::vector<std::int32_t>& node_owner) {
  const auto add = [&](std::int32_t like) {
    const std::int32_t owner = node_owner[like];
    node_owner.push_back(owner);
  };
  for (const EdgeNode& node : edit.inserted) add(node.end[0]);
  for (const std::int32_t parent : edit.duplicate_parent) add(parent);
}

}  // namespace trocar
