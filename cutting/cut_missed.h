// Where a blade went from surface to surface and tissue stays joined. Nothing repairs it; a stroke
// must not end without saying so.
#pragma once

#include <vector>

#include "cutting/cut_figures.h"
#include "cutting/cut_survey.h"

namespace trocar {

// At the end of a stroke, which remembers `cut`, its last edit of `mesh` (not applied yet). Unless
// the blade has drawn back, clear of the stroke's rim and of where it has stopped: hexahedra that
// it can't cut, elements that the blade crossed and that got no side, facets between two sides that
// are not open, edges where both lips of an opened facet hang together, and, if the blade has left,
// slices too thin to show. And in any case necks by which hangs what it has gone all around, as in
// a closed ring that comes to a point.
std::vector<CutRefusal> missed_places(const Mesh& mesh, const TetCut& cut, const CutStroke& stroke);

}  // namespace trocar
