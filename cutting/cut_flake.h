// Flakes: small pieces that an opening would free although the blade left them joined to more
// tissue of their side, through a neck thinner than an element that stays with the other side.
#pragma once

#include <cstdint>
#include <vector>

#include "cutting/cut_index.h"
#include "cutting/cut_stroke.h"
#include "mesh/mesh.h"

namespace trocar {

// The tetrahedron of `mesh` that has the nodes of facet f of element e, too; -1: none.
std::int32_t element_across(const Mesh& mesh, const CutIndex& index, std::int32_t e, int f);

struct Flake {
  bool is_one = false;
  std::vector<std::int32_t> neck;  // nodes of its shortest way to more of its side; empty: unknown
};
// Whether the blade left the elements of `piece` (ascending) joined to others that have their
// `side` (+1 or -1) by now: through edges that it did not cross, in the tissue as it was before
// this stroke. `given`: sides of this advance.
Flake find_flake(const Mesh& mesh, const CutIndex& index, const CutStroke& stroke,
                 const std::vector<std::int32_t>& piece, int side,
                 const std::vector<OfElement<std::int8_t>>& given);

}  // namespace trocar
