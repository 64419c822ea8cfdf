// How much of what a blade's edge went through its cuts have parted: elements that it leaves whole
// show nowhere else.
#pragma once

#include <span>
#include <vector>

#include "engine/body_positions.h"
#include "engine/cut_stage.h"

namespace trocar {

template <class Archive>
void visit(Archive& a, SweptPlace& place) {
  a(place.X, place.normal, place.area);
}

// Of a blade's way through the tissue in a frame, its own at most, with the edge in the middle of
// equal parts of it.
std::vector<SweptPlace> swept_places(const Simulation& s, BodyPositions& positions,
                                     const BladeSweep& sweep);

// The area of the places, and of those at which a facet was opened within 3/4 of an edge from the
// blade. [m^2]
struct SweptArea {
  double whole = 0, parted = 0;
};
SweptArea measure_swept(const Mesh& mesh, double edge_length, std::span<const SweptPlace> places);

}  // namespace trocar
