// What one edit of a stroke looks at and what it decides, step by step.
#pragma once

#include <span>
#include <vector>

#include "cutting/cut_chips.h"
#include "cutting/cut_hex.h"
#include "cutting/cut_label.h"
#include "cutting/cut_move.h"
#include "cutting/cut_open.h"
#include "cutting/cut_transfer.h"

namespace trocar {

// How often each rung of the ladder was needed, see CutFigures.
struct CutRungs {
  std::int32_t n_turned = 0, n_pulled_back = 0, n_inverted = 0;
};

struct TetCut {
  CutSurroundings around;
  CutLabels labels;
  CutOpening opening;
  std::vector<NodeRole> role;        // (n_nodes of the patch)
  std::vector<std::uint8_t> is_cut;  // (n_nodes) on a facet that this stroke opened, now or before
  std::vector<Vec3> X;               // (n_nodes) reference positions afterwards
  std::vector<NodeTransfer> transfer;  // of the moved nodes
  std::vector<CutChip> chips;          // that stay with the other side
  std::vector<std::int32_t> neck;      // local elements that go with a flake
  CutRungs rungs;
};

// The surroundings of the elements that were crossed since the last edit; without elements if
// nothing was. is_last takes in all that the stroke has not finished. hexahedra: null, or those
// that `mesh` was made of.
CutSurroundings survey(const Mesh& mesh, const HexTets* hexahedra, CutIndex& index,
                       PresentPositions& positions, const CutConstraints& constraints,
                       const CutStroke& stroke, bool is_last);

// Which nodes lie on opened facets, and what each node may do. Nodes of front elements stay unless
// is_last: the blade is still in there.
void set_roles(TetCut& cut, const CutStroke& stroke, bool is_last);

// The floor under step bounds: `part` of the least one that the elements around had before this
// stroke.
MoveLimits move_limits(const CutSurroundings& around, const CutStroke& stroke, double part);

}  // namespace trocar
