// Points of the tissue whose way the metrics tell: [[marker]].
#pragma once

#include <span>
#include <vector>

#include "base/communicator.h"
#include "engine/locate.h"
#include "engine/scene.h"
#include "mesh/partition.h"

namespace trocar {

// Where each marker lies in the undeformed mesh; element -1: outside.
std::vector<Location> locate_markers(std::span<const SceneMarker> markers, const Mesh& mesh);
// The same after a cut, which gives a marker other weights as it moves nodes, for it is a point of
// the material. One on a curved surface, whose nodes slide, goes on with the nearest element.
std::vector<Location> follow_markers(std::span<const SceneMarker> markers, const Mesh& mesh);
// Where they are now [m], the same bits on any ranks. u (n_local * 3). Collective.
std::vector<Vec3> marker_positions(std::span<const Location> markers, const Mesh& mesh,
                                   const Part& part, std::span<const double> u,
                                   const Communicator& communicator);

}  // namespace trocar
