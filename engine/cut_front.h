// The front of a cut: where a blade's edge stands at tissue that it parts. There the tissue resists
// (blade_drag.h), so that the work of a cut is [cutting] resistance times the area that is cut, at
// any frame rate, and a blade in its own slit feels nothing.
#pragma once

#include <vector>

#include "engine/archive_cut.h"
#include "engine/body_positions.h"
#include "engine/cut_stage.h"
#include "engine/frame_span.h"

namespace trocar {

// Of a blade in the frame to come, as the tissue lies and moves at the frame's begin.
struct CutFront {
  // Of the edge on its way through the frame, what is in tissue that hangs together across that
  // way. Lengths are means over the way, of the edge as it lies across it: one that moves along
  // itself parts nothing.
  std::vector<SegmentPiece> piece;
  // In the stroke so far, else of what is near. [m/s]
  Vec3 tissue_velocity = Vec3::Zero();
  bool is_near = false;  // any tissue
};
template <class Archive>
void visit(Archive& a, CutFront& front) {
  a(front.piece, front.tissue_velocity, front.is_near);
}

// Takes down which nodes blades drag along in the frame, in which no node makes a longer way than
// `travel` [m]. Collective.
void prepare_drag(Simulation& s, const FrameSpan& span, double travel);

}  // namespace trocar
