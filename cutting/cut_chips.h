// A rung of the ladder (docs/cutting.md): chips. Where cuts meet, an opening may split off a piece
// of a few elements that the blade did not; it goes with the other side instead.
#pragma once

#include "cutting/cut_open.h"

namespace trocar {

struct TetCut;

struct CutChip {
  Vec3 centre = Vec3::Zero();         // of its part in the patch, reference configuration [m]
  std::vector<std::int32_t> element;  // local
  std::vector<OfElement<std::int8_t>> beyond;  // the rest outside the patch, with its new side
};

// Gives the smallest piece that the opening should not free the other side: a chip, below half a
// mean edge cubed, of a slice that got nodes on edges a quarter, or a flake (cut_flake.h). Adds it
// to cut.chips; false if there is none. The facets are to be opened again then: what it joins may
// be one, too.
bool attach_chip(const Mesh& mesh, const CutIndex& index, const CutStroke& stroke, TetCut& cut);

}  // namespace trocar
