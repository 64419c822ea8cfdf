// A rank's part of the mesh, its halo, and the exchange of nodal fields with its neighbours.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/check.h"
#include "base/sort_unique.h"
#include "mesh/partition.h"

namespace trocar {

// Marks of all corners of the elements that touch an owned node; fills part.element_global.
static std::vector<std::uint8_t> touched_nodes(const Mesh& mesh,
                                               std::span<const std::int32_t> node_owner, int rank,
                                               Part& part) {
  std::vector<std::uint8_t> is_touched(mesh.X.size(), 0);
  const auto is_owned = [&](std::int32_t i) { return node_owner[i] == rank; };
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::span<const std::int32_t> node = mesh.corners(e);
    if (std::none_of(node.begin(), node.end(), is_owned)) continue;
    part.element_global.push_back(e);
    for (const std::int32_t i : node) is_touched[i] = 1;
  }
  return is_touched;
}

std::int64_t Part::place_of(std::int32_t element) const {
  return find_in(element_global, element);
}

Part make_part(const Mesh& mesh, std::span<const std::int32_t> node_owner, int rank) {
  CHECK_OP(node_owner.size(), ==, mesh.X.size());
  Part part{.rank = rank};
  const std::vector<std::uint8_t> is_touched = touched_nodes(mesh, node_owner, rank, part);
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (node_owner[i] == rank) part.node_global.push_back(i);
  part.n_owned = part.n_local();
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (node_owner[i] != rank && is_touched[i] != 0) part.node_global.push_back(i);
  part.node_global.shrink_to_fit();
  part.element_global.shrink_to_fit();
  part.node_local.assign(mesh.X.size(), -1);
  for (std::int32_t k = 0; k < part.n_local(); ++k) part.node_local[part.node_global[k]] = k;
  return part;
}

Part whole_part(const Mesh& mesh) {
  return make_part(mesh, std::vector<std::int32_t>(mesh.X.size(), 0), 0);
}

std::vector<std::int32_t> split_elements(const Mesh& mesh, std::span<const std::int32_t> node_owner,
                                         std::span<const ElementSplit> splits, Part& part) {
  if (splits.empty()) return {};
  const bool has_one = std::any_of(splits.begin(), splits.end(), [&](const ElementSplit& split) {
    return part.place_of(split.element) >= 0;
  });
  if (!has_one) return {};
  const auto is_here = [&](std::int32_t e) {
    return std::ranges::any_of(mesh.corners(e),
                               [&](std::int32_t i) { return node_owner[i] == part.rank; });
  };
  std::vector<std::int32_t> place(part.element_global.size());
  std::iota(place.begin(), place.end(), 0);
  std::size_t n_gone = 0;  // of the elements seen so far
  auto split = splits.begin();
  for (std::size_t k = 0; k < part.element_global.size(); ++k) {
    const std::int32_t e = part.element_global[k];
    while (split != splits.end() && split->element < e) ++split;
    const bool is_split = split != splits.end() && split->element == e;
    if (is_split && !is_here(e)) {
      ++n_gone;
      continue;
    }
    part.element_global[k - n_gone] = e;
    place[k - n_gone] = is_split ? -1 : static_cast<std::int32_t>(k);
  }
  part.element_global.resize(part.element_global.size() - n_gone);
  place.resize(part.element_global.size());
  for (std::int32_t e = mesh.n_elements() - n_added(splits); e < mesh.n_elements(); ++e)
    if (is_here(e)) {
      part.element_global.push_back(e);
      place.push_back(-1);
    }
  return place;
}

// Whether an element at the node has a corner that the rank owns.
static bool is_near(const Mesh& mesh, const NodeCorners& corners,
                    std::span<const std::int32_t> node_owner, int rank, std::int32_t node) {
  for (std::int32_t at = corners.first[node]; at >= 0; at = corners.next[at])
    for (const std::int32_t i : mesh.corners(corners.element[at]))
      if (node_owner[i] == rank) return true;
  return false;
}

void update_part(const Mesh& mesh, const NodeCorners& corners,
                 std::span<const std::int32_t> node_owner, std::span<const std::int32_t> nodes,
                 Part& part) {
  const auto first_new = static_cast<std::int32_t>(part.node_local.size());
  const std::int32_t n_owned_before = part.n_owned;
  const auto end_of_owned = part.node_global.begin() + part.n_owned;
  std::vector<std::int32_t> halo;
  std::set_difference(end_of_owned, part.node_global.end(), nodes.begin(), nodes.end(),
                      std::back_inserter(halo));
  for (auto i = end_of_owned; i != part.node_global.end(); ++i) part.node_local[*i] = -1;
  part.node_global.erase(end_of_owned, part.node_global.end());
  for (std::int32_t i = first_new; i < mesh.n_nodes(); ++i)
    if (node_owner[i] == part.rank) part.node_global.push_back(i);
  part.n_owned = part.n_local();
  const auto end_of_kept = std::ssize(halo);
  for (const std::int32_t i : nodes)
    if (node_owner[i] != part.rank && is_near(mesh, corners, node_owner, part.rank, i))
      halo.push_back(i);
  std::inplace_merge(halo.begin(), halo.begin() + end_of_kept, halo.end());
  part.node_global.insert(part.node_global.end(), halo.begin(), halo.end());
  part.node_local.resize(mesh.X.size(), -1);
  for (std::int32_t k = n_owned_before; k < part.n_local(); ++k)
    part.node_local[part.node_global[k]] = k;
}

// Ascending by rank, then by local number, which within owned and within halo nodes is the order of
// global numbers: so both sides of an exchange list the same nodes in the same order.
using RankNode = std::pair<std::int32_t, std::int32_t>;

// elements: at least those of the part that have a halo node.
static std::vector<RankNode> nodes_to_send(const Mesh& mesh, std::span<const std::int32_t> elements,
                                           std::span<const std::int32_t> node_owner,
                                           const Part& part) {
  std::vector<RankNode> pairs;
  for (const std::int32_t e : elements)
    for (const std::int32_t other : mesh.corners(e)) {
      if (node_owner[other] == part.rank) continue;
      for (const std::int32_t own : mesh.corners(e))
        if (node_owner[own] == part.rank)
          pairs.emplace_back(node_owner[other], part.node_local[own]);
    }
  sort_unique(pairs);
  return pairs;
}

static std::vector<RankNode> nodes_to_receive(std::span<const std::int32_t> node_owner,
                                              const Part& part) {
  std::vector<RankNode> pairs;
  for (std::int32_t k = part.n_owned; k < part.n_local(); ++k)
    pairs.emplace_back(node_owner[part.node_global[k]], k);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

static Halo make_halo(const Mesh& mesh, std::span<const std::int32_t> elements,
                      std::span<const std::int32_t> node_owner, const Part& part) {
  // Whoever sends to this rank also receives from it: an element on the border is on both sides.
  Halo halo;
  for (const auto& [other, local] : nodes_to_receive(node_owner, part)) {
    if (halo.neighbours.empty() || halo.neighbours.back().rank != other)
      halo.neighbours.push_back({other, {}, {}});
    halo.neighbours.back().receive.push_back(local);
  }
  auto neighbour = halo.neighbours.begin();
  for (const auto& [other, local] : nodes_to_send(mesh, elements, node_owner, part)) {
    while (neighbour->rank != other) ++neighbour;
    neighbour->send.push_back(local);
  }
  return halo;
}

Halo make_halo(const Mesh& mesh, std::span<const std::int32_t> node_owner, const Part& part) {
  return make_halo(mesh, part.element_global, node_owner, part);
}

void update_halo(const Mesh& mesh, const NodeCorners& corners,
                 std::span<const std::int32_t> node_owner, std::span<const std::int32_t> elements,
                 const Part& part, Halo& halo) {
  const auto is_inside = [&](std::int32_t e) {
    return std::ranges::all_of(mesh.corners(e),
                               [&](std::int32_t i) { return node_owner[i] == part.rank; });
  };
  if (!std::ranges::all_of(elements, is_inside)) {
    const auto halo_nodes =
        std::span(part.node_global).subspan(static_cast<std::size_t>(part.n_owned));
    halo = make_halo(mesh, elements_around(corners, halo_nodes), node_owner, part);
    return;
  }
  std::int32_t first = part.n_local();  // halo node, as far as they have not moved up
  for (const Halo::Neighbour& neighbour : halo.neighbours)
    first = std::min(first, neighbour.receive.front());
  for (Halo::Neighbour& neighbour : halo.neighbours)
    for (std::int32_t& i : neighbour.receive) i += part.n_owned - first;
}

static std::vector<NodeRange> ranges_of(std::span<const std::int32_t> nodes) {
  std::vector<NodeRange> ranges;
  for (const std::int32_t i : nodes)
    if (ranges.empty() || ranges.back().end != i)
      ranges.push_back({i, i + 1});
    else
      ++ranges.back().end;
  return ranges;
}

HaloExchange::HaloExchange(const Halo& halo, int width) : width_(width) {
  const auto n_values = [&](const std::vector<std::int32_t>& nodes) {
    return nodes.size() * static_cast<std::size_t>(width);
  };
  std::size_t n_receive = 0;
  for (const Halo::Neighbour& neighbour : halo.neighbours) {
    neighbours_.push_back({neighbour.rank, n_values(neighbour.send), n_values(neighbour.receive),
                           ranges_of(neighbour.send), ranges_of(neighbour.receive)});
    n_receive += n_values(neighbour.receive);
  }
  receive_.resize(n_receive);
  messages_.resize(neighbours_.size());
}

// Where the values of the nodes are in a field of `width` doubles a node.
static std::size_t first_value(const NodeRange& nodes, int width) {
  return static_cast<std::size_t>(nodes.begin) * static_cast<std::size_t>(width);
}
static std::size_t count_values(const NodeRange& nodes, int width) {
  return static_cast<std::size_t>(nodes.end - nodes.begin) * static_cast<std::size_t>(width);
}

void HaloExchange::start(std::span<const double> field, Communicator& communicator) {
  std::size_t n_send = 0;
  for (const Ranges& neighbour : neighbours_) n_send += neighbour.n_send;
  const std::span<double> room = communicator.room_to_send(n_send);
  double *send = room.data(), *receive = receive_.data();
  for (std::size_t k = 0; k < messages_.size(); ++k) {
    const Ranges& neighbour = neighbours_[k];
    messages_[k] = {neighbour.rank, {send, neighbour.n_send}, {receive, neighbour.n_receive}};
    for (const NodeRange& nodes : neighbour.send)
      send = std::copy_n(&field[first_value(nodes, width_)], count_values(nodes, width_), send);
    receive += neighbour.n_receive;
  }
  communicator.start_exchange(messages_);
}

void HaloExchange::finish(std::span<double> field, Communicator& communicator) {
  communicator.finish_exchange();
  const double* received = receive_.data();
  for (const Ranges& neighbour : neighbours_)
    for (const NodeRange& nodes : neighbour.receive) {
      std::copy_n(received, count_values(nodes, width_), &field[first_value(nodes, width_)]);
      received += count_values(nodes, width_);
    }
}

void HaloExchange::exchange(std::span<double> field, Communicator& communicator) {
  start(field, communicator);
  finish(field, communicator);
}

namespace {

// Each owned node as its global number (exact in a double) and its values.
std::vector<double> records_of_owned(const Part& part, int width, std::span<const double> local) {
  const auto n = static_cast<std::size_t>(width), n_owned = static_cast<std::size_t>(part.n_owned);
  CHECK_OP(local.size(), >=, n_owned * n);
  std::vector<double> records;
  records.reserve(n_owned * (n + 1));
  for (std::size_t k = 0; k < n_owned; ++k) {
    records.push_back(part.node_global[k]);
    const auto values = local.subspan(n * k, n);
    records.insert(records.end(), values.begin(), values.end());
  }
  return records;
}

// Of all nodes.
std::vector<double> field_of(std::span<const double> records, const Part& part, int width) {
  const auto n = static_cast<std::size_t>(width);
  CHECK_OP(records.size(), ==, part.node_local.size() * (n + 1));
  std::vector<double> field(part.node_local.size() * n);
  for (std::size_t k = 0; k < records.size(); k += n + 1)
    std::copy_n(&records[k + 1], n, &field[static_cast<std::size_t>(records[k]) * n]);
  return field;
}

// Owns all nodes, ascending.
std::vector<double> field_of_one(const Part& part, int width, std::span<const double> local) {
  const auto own =
      local.first(static_cast<std::size_t>(part.n_owned) * static_cast<std::size_t>(width));
  CHECK_OP(own.size(), ==, part.node_local.size() * static_cast<std::size_t>(width));
  return {own.begin(), own.end()};
}

}  // namespace

std::vector<double> all_gather_field(const Part& part, int width, std::span<const double> local,
                                     const Communicator& communicator) {
  if (communicator.size() == 1) return field_of_one(part, width, local);
  return field_of(communicator.all_gather(records_of_owned(part, width, local)), part, width);
}

std::vector<double> gather_field(const Part& part, int width, std::span<const double> local,
                                 const Communicator& communicator) {
  if (communicator.size() == 1) return field_of_one(part, width, local);
  const std::vector<double> records = communicator.gather(records_of_owned(part, width, local));
  return communicator.is_root() ? field_of(records, part, width) : std::vector<double>();
}

std::vector<double> scatter_field(const Part& part, int width, std::span<const double> field,
                                  std::int32_t n) {
  const auto n_values = static_cast<std::size_t>(width);
  std::vector<double> local(static_cast<std::size_t>(n) * n_values);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
    std::copy_n(&field[static_cast<std::size_t>(part.node_global[i]) * n_values], n_values,
                &local[i * n_values]);
  return local;
}

}  // namespace trocar
