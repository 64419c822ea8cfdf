// Who owns which node, what a rank computes, and how owners tell their neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/communicator.h"
#include "mesh/edit.h"
#include "mesh/mesh.h"
#include "mesh/node_corners.h"

namespace trocar {

// Owner of each node, by METIS with a fixed seed on rank 0; parts of equal work, that of an element
// shared by its corners; the same on every rank. Collective.
// Throws InputError if there are fewer nodes than ranks.
std::vector<std::int32_t> partition_nodes(const Mesh& mesh, Communicator& communicator);
// The same for any number of parts, by this process alone; each part gets at least one node.
std::vector<std::int32_t> partition_nodes(const Mesh& mesh, int n_parts);
// Work of the elements at its nodes, of the part that has most over the mean of all. Elements of
// several parts are shared by their corners, though each part computes them.
double imbalance(const Mesh& mesh, std::span<const std::int32_t> node_owner, int n_parts);
// A node on an edge gets the owner of the edge's lower end, a duplicate stays with its parent's.
void apply_edit_to_owners(const MeshEdit& edit, std::vector<std::int32_t>& node_owner);

// This rank's part: all elements that touch a node it owns. Local numbers: owned nodes ascending,
// then halo nodes ascending.
struct Part {
  int rank = 0;
  std::vector<std::int32_t> node_global;  // (n_local)
  std::int32_t n_owned = 0;
  std::vector<std::int32_t> element_global;  // ascending
  std::vector<std::int32_t> node_local;      // (n_nodes) local number or -1

  // Place of an element in element_global, -1 if the part lacks it.
  std::int64_t place_of(std::int32_t element) const;
  // Local number of a node that this rank owns, -1 of any other.
  std::int32_t owned(std::int32_t node) const {
    return node_local[node] < n_owned ? node_local[node] : -1;
  }
  std::int32_t n_local() const { return static_cast<std::int32_t>(node_global.size()); }
};
Part make_part(const Mesh& mesh, std::span<const std::int32_t> node_owner, int rank);
// All of the mesh, as on one rank.
Part whole_part(const Mesh& mesh);
// The part's elements after the splits of an edit, by the mesh and owners after it. Returns which
// place in element_global each had before, -1 if it is new; empty if the part had no element that
// was split, so that each kept its place.
std::vector<std::int32_t> split_elements(const Mesh& mesh, std::span<const std::int32_t> node_owner,
                                         std::span<const ElementSplit> splits, Part& part);
// The part after an edit that kept the owners of all corners, from the part before it with the
// elements after it. `nodes`: all corners of edited elements, before and after it, ascending. In
// time of theirs and of the halo's.
void update_part(const Mesh& mesh, const NodeCorners& corners,
                 std::span<const std::int32_t> node_owner, std::span<const std::int32_t> nodes,
                 Part& part);

// Which local nodes go to and come from which rank, ascending global number on both sides. Made
// without communication.
struct Halo {
  struct Neighbour {
    int rank = 0;
    std::vector<std::int32_t> send;     // local numbers of owned nodes that the neighbour needs
    std::vector<std::int32_t> receive;  // local numbers of halo nodes that it owns
  };
  std::vector<Neighbour> neighbours;  // ascending rank
};
Halo make_halo(const Mesh& mesh, std::span<const std::int32_t> node_owner, const Part& part);
// The same after an edit that left all corners their owners, and after update_part: in time of the
// halo's if one of the elements around the edit has a halo node, else in that of a copy.
void update_halo(const Mesh& mesh, const NodeCorners& corners,
                 std::span<const std::int32_t> node_owner, std::span<const std::int32_t> elements,
                 const Part& part, Halo& halo);

// Nodes that follow each other.
struct NodeRange {
  std::int32_t begin = 0, end = 0;  // local
  bool operator==(const NodeRange&) const = default;
};

// Keeps the buffers of the exchange of a nodal field (n_local * width).
class HaloExchange {
 public:
  HaloExchange(const Halo& halo, int width);
  // Packs the field's owned nodes and sends them in one message a neighbour; they may change
  // meanwhile. Collective among neighbours.
  void start(std::span<const double> field, Communicator& communicator);
  // Waits and unpacks into the halo nodes of the field.
  void finish(std::span<double> field, Communicator& communicator);
  // Both.
  void exchange(std::span<double> field, Communicator& communicator);

 private:
  struct Ranges {
    int rank = 0;
    std::size_t n_send = 0, n_receive = 0;
    std::vector<NodeRange> send, receive;
  };
  int width_;
  std::vector<Ranges> neighbours_;
  std::vector<double> receive_;
  std::vector<ExchangeMessage> messages_;
};

// The whole nodal field (n_nodes * width), from the owners' parts: on every rank ...
std::vector<double> all_gather_field(const Part& part, int width, std::span<const double> local,
                                     const Communicator& communicator);
// ... and on the root, empty elsewhere. Both collective.
std::vector<double> gather_field(const Part& part, int width, std::span<const double> local,
                                 const Communicator& communicator);
// Back again, of the first n local nodes: (n * width).
std::vector<double> scatter_field(const Part& part, int width, std::span<const double> field,
                                  std::int32_t n);

}  // namespace trocar
