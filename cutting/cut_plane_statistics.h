// The statistical values of Table 1 of Serby, Harders and Szekely 2001.
#pragma once

#include "mesh/mesh.h"

namespace trocar {

struct Spread {
  double min = 0, max = 0, mean = 0, sigma = 0;
};

struct PlaneStatistics {
  int n_nodes = 0, n_elements = 0;
  Spread area;  // [mm^2]
  // [mm] Over the three edges of each element, inner edges twice: of the usual definitions the only
  // one whose mean prints as all of the paper's.
  Spread edge;
  // [mm] Over the first two edges of each element alone: the paper's sigma of rows I is this one.
  double edge_sigma_of_two = 0;
};

// Of a mesh of triangles in metres.
PlaneStatistics plane_statistics(const Mesh& mesh);

}  // namespace trocar
