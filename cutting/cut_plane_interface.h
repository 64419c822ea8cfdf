// Where a plane cut crosses an interface between two regions, or runs along it: the nodes of the
// interface that it takes there. These stay on the interface, so that every region keeps its area.
#pragma once

#include <vector>

#include "cutting/cut_plane_path.h"

namespace trocar {

struct InterfaceStop {
  int node = 0;
  double s = 0;            // where it goes, on the path [m]
  bool is_joined = false;  // to the next stop, by an edge of the interface
};

// The path bends to what stays where it is: nodes of an interface that it runs along within `near`
// mean edges, and where an interface bends itself.
struct InterfaceRoute {
  SubPath path;
  std::vector<InterfaceStop> stop;  // ascending s
};
InterfaceRoute route_over_interfaces(const PlanePatch& patch, const SubPath& path, double near);

// Of the element that holds the point; -1 if none does.
int region_at(const PlanePatch& patch, const Vec2& p);

}  // namespace trocar
