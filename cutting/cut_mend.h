// A rung of the ladder (docs/cutting.md) where an opening would pinch the body: other sides for
// elements there, so that more or less is opened than the minimum cut wanted but the outer surface
// stays a 2-manifold. What this can't mend, open_facets closes.
#pragma once

#include "cutting/cut_open.h"

namespace trocar {

// Changes sides of elements that have no opened facet yet; returns how many.
std::int32_t mend_labels(const CutSurroundings& around, const PatchMesh& mesh,
                         const CutStroke& stroke, CutLabels& labels);

}  // namespace trocar
