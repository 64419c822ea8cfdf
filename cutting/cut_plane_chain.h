// Cut points and the nodes that are displaced onto them (Serby et al. 2001, Fig. 1), and the edges
// between these nodes that the cut opens.
#pragma once

#include <vector>

#include "cutting/cut_plane_interface.h"
#include "cutting/cut_plane_path.h"

namespace trocar {

// The nodes of one sub-path, in order, and where on it they go.
struct CutChain {
  SubPath path;
  std::vector<int> node;
  std::vector<double> s;  // [m]
  SubPath asked;          // the path before it was bent into corners of the body and to interfaces
  std::vector<InterfaceStop> stop;  // on interfaces, on the path
  int n_segments() const { return static_cast<int>(node.size()) - 1; }
};

struct AdaptOptions {
  int most = 1;            // segments to begin with
  double at_corner = 0.1;  // an end so near to a sharp corner is moved into it, and the path to an
                           // interface that it runs along so near, in h
};
// Lowers the number of segments from `most` until no two cut points have the same nearest node.
// Interior points take interior nodes, ends on the boundary take boundary nodes; held nodes and
// nodes in `is_taken` are never chosen. Where the path meets an interface
// it takes nodes of that, nowhere else. False if there are not enough nodes.
bool adapt_cut_points(const PlanePatch& patch, const AdaptOptions& options,
                      std::vector<std::uint8_t>& is_taken, CutChain& chain);
// 4 L / least edge: the number that is "deliberately chosen too high".
int most_segments(const PlanePatch& patch, const SubPath& path);

// Flips edges until consecutive nodes share an edge, in the mesh that is not yet displaced, and
// marks these edges in patch.chain. False if the boundary or another cut is in the way.
bool recover_edges(PlanePatch& patch, const CutChain& chain);

}  // namespace trocar
