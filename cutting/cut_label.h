// The side of each cut element, so that the facets between the two sides lie near the swept surface
// and their nodes can get there: a minimum cut with the squared distance as cost. (Labelling by the
// side of the centroid leaves elements with all four corners on the surface: 17 of 50 random cuts
// failed.)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cutting/cut_sides.h"
#include "cutting/cut_stroke.h"
#include "cutting/cut_surroundings.h"

namespace trocar {

struct CutLabels {
  std::vector<CutKind> kind;      // (n_elements)
  std::vector<std::int8_t> side;  // (n_elements) +1, -1; 0: takes no part
  // (n_nodes) of an element of the front: the blade is still in there, and a node that moves could
  // take an edge past it uncrossed
  std::vector<std::uint8_t> is_front_node;
  // (n_nodes) facets at these stay joined for now: of slices (cut_thin.h) and flakes to be decided
  // on later
  std::vector<std::uint8_t> is_left;
  // (n_elements) the blade has left, and went through all around: what it crossed there is parted
  std::vector<std::uint8_t> is_passed;
};

// Facets at these elements stay joined for now.
void leave_elements(const CutPatch& patch, std::span<const std::int32_t> element,
                    CutLabels& labels);

CutLabels label_elements(const CutSurroundings& around, const CutStroke& stroke, bool is_last);

// Behind a blade that has passed, no edge may hold both sides together: elements around it that the
// blade left beside it get the side they lie on. Those that lie on both were not cut. Whether there
// were any.
bool part_bridges(const CutSurroundings& around, const CutStroke& stroke, CutLabels& labels);

// Cost of opening a facet: squared distances of its nodes plus a little for its area.
double facet_cost(const CutSurroundings& around, std::int32_t e, int f);

}  // namespace trocar
