// A rung of the ladder (docs/cutting.md): chips. Where cuts meet, an opening may split off a piece
// of a few elements that the blade did not; it goes with the other side instead.
#pragma once

#include "cutting/cut_open.h"

namespace trocar {

struct TetCut;

// Pieces and slices with less volume (over h^3) stay with the other side: some two elements.
inline constexpr double chip_volume = 0.25;

struct CutChip {
  Vec3 centre = Vec3::Zero();         // of its part in the patch, reference configuration [m]
  std::vector<std::int32_t> element;  // local
  std::vector<OfElement<std::int8_t>> beyond;  // the rest outside the patch, with its new side
};

// Joins the smallest piece that the opening should not free: a chip or a flake (cut_flake.h). It
// gets the other side and is added to cut.chips; a flake, while the blade is on its way, stays
// joined for now, and a large one gets the elements of its neck in the end, which are added to
// cut.neck, if the stroke has not parted them yet. False if there is none. The facets are to be
// opened again then: what it joins may be one, too. is_held (n_nodes): what a node belongs to that
// is held, and does not slide, is none.
bool join_chip(const Mesh& mesh, const CutIndex& index, std::span<const std::uint8_t> is_held,
               const CutStroke& stroke, bool is_last, TetCut& cut);

}  // namespace trocar
