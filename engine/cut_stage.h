// The cut of a scalpel or of scissors between two frames: from the motion of the edge to an edited
// simulation.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cutting/cut_plane.h"
#include "cutting/cut_tet.h"
#include "engine/cut_record.h"
#include "engine/frame_span.h"
#include "engine/locate.h"

namespace trocar {

struct Simulation;

// Where a blade's edge came by in the tissue, in the reference configuration (swept_area.h).
struct SweptPlace {
  Vec3 X = Vec3::Zero(), normal = Vec3::UnitZ();  // [m], unit: of the surface that it sweeps
  double area = 0;                                // [m^2]
};

// What a blade keeps from frame to frame beside its stroke.
struct CutProgress {
  std::vector<Vec3> plane_path;  // swept by the tip since the last edit, reference positions [m]
  std::int32_t plane_tip = -1;
  bool is_in_stroke = false;
  int n_idle_frames = 0;
  bool has_told_beside = false;  // of tissue beside open jaws, in this closing
  std::vector<CutRecord> strokes;
  bool is_engaged = false;              // some of the edge is in the tissue at the frame's end
  Vec3 tissue_velocity = Vec3::Zero();  // around the edge, in the stroke so far [m/s]
  bool knows_tissue = false;            // from before it met the blade
  std::vector<SweptPlace> swept;        // in the stroke so far, of a body in space
  BladePush push;                       // since the last stroke
};

struct CutStage : CutProgress {
  std::int32_t tool = 0;
  TetCutter tet;             // its stroke: on the keepers, the ranks that cut last
  std::vector<int> keepers;  // ascending; none: all ranks
  // As tissue_velocity, of a frame that began with tissue at or near the blade. [m/s]
  std::optional<Vec3> beside;
  std::vector<SegmentPiece> resisted;  // where the edge meets resistance in this frame
  // How far around the blade the owners of nodes cut with it, mean longest sides of elements: what
  // a cut looks at beyond that has to be asked of all ranks (a test has others).
  double margin = 2;
  CutPlaneOptions plane;
};

// Cuts along all blades' motion in the frame and applies the edits. Collective.
void cut_along_blades(Simulation& s, const FrameSpan& span);

// All cutters' looks at the whole mesh, one each: from here on they follow its edits.
void prepare_cutters(Simulation& s);

// From here on the stage's cutter has its stroke on these ranks (ascending). Collective.
void bring_stroke(const Simulation& s, std::span<const int> ranks, CutStage& stage);

}  // namespace trocar
