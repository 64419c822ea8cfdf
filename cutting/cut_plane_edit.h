// From a patch that was flipped and moved to the edit of the mesh.
#pragma once

#include <span>

#include "cutting/cut_plane.h"
#include "cutting/cut_plane_chain.h"

namespace trocar {

// `before` is the patch as it was cut out of the mesh, `after` has the chains' edges marked.
// Partner nodes are made here; state goes over by weights in the elements of `before`, found by
// walking from each node's own star so that no cut is looked across; density factors change where
// the mass of a region would.
PlaneCut make_plane_cut(const Mesh& mesh, const PlanePatch& before, const PlanePatch& after,
                        std::span<const CutChain> chains);

// Element of `patch` that contains p or, if none near `node` does, comes nearest to it; with the
// barycentric weights of p in it, in positions before the cut.
struct Host {
  int element = -1;
  std::array<double, 3> weight{};
};
Host find_host(const PlanePatch& patch, int node, const Vec2& p);

}  // namespace trocar
