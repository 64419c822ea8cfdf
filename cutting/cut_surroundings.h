// The patch around a stroke's front together with what is known of its nodes.
#pragma once

#include <vector>

#include "cutting/cut_boundary.h"
#include "cutting/cut_patch.h"
#include "cutting/cut_surface_fit.h"

namespace trocar {

// What is known of the patch before anything is decided.
struct CutSurroundings {
  CutPatch patch;
  SurfacePoints points;
  std::vector<NodeBoundary> boundary;  // (n_nodes)
  std::vector<double> surface_cost;  // (n_nodes) squared distance to the surface over h, as far as
                                     // the node can go there
  std::vector<double> distance;      // (n_nodes) from the surface, > 0 on the + side; 0 where no
                                     // crossing is near [m]
  double h = 0;                      // mean edge length [m]
};

}  // namespace trocar
