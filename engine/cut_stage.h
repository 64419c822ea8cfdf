// The cut of a scalpel or of scissors between two frames: from the motion of the edge to an edited
// simulation.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cutting/cut_plane.h"
#include "cutting/cut_tet.h"
#include "engine/contact_stage.h"
#include "engine/locate.h"

namespace trocar {

struct Simulation;

// One stroke of a blade, from entry to exit: the cut ledger of the summary.
struct CutRecord {
  std::string tool;
  double start = 0, end = 0;                              // [s]
  std::int64_t n_edits = 0, n_refused = 0, n_beside = 0;  // n_beside: see CutFigures
  std::vector<CutRefusal> refusals;
  std::int64_t n_moved = 0, n_duplicated = 0, n_opened_facets = 0;
  std::int64_t n_ranks = 0;   // that cut together, at most
  std::int64_t n_askew = 0;   // edits of an edge that did not face its way
  std::int64_t n_pieces = 1;  // of the whole body after the stroke, or so far
  std::int64_t n_elements_added = 0, n_elements_dissolved = 0;
  std::int64_t n_turned = 0, n_chips = 0, n_pulled_back = 0;  // rungs of the ladder: see CutFigures
  std::int64_t n_inserted = 0;                                // the same
  std::int64_t n_converted = 0, n_kept_hexahedra = 0;  // see CutFigures; kept ones once an edit
  double stable_step_ratio =
      1;  // least stable step after / before, of the elements around, worst edit
  double scene_step_ratio = 1;   // of the whole body, after or so far / before the stroke
  double scene_step_before = 0;  // [s]
  double least_quality = 1;
  double mass_change = 0;            // largest |relative| of an edit
  double momentum_change = 0;        // |P after - P before| / sum |m v| around the cut, largest
  double kinetic_energy_change = 0;  // summed [J]
  double largest_deviation = 0, mean_deviation = 0, mean_edge = 0;  // [m]
  double blade_travel = 0,
         deepest = 0;  // of the edge's middle with some of it inside; depth of the edge inside [m]
  double milliseconds = 0, worst_milliseconds = 0;
};

// What a blade keeps from frame to frame beside its stroke.
struct CutProgress {
  std::vector<Vec3> plane_path;  // swept by the tip since the last edit, reference positions [m]
  std::int32_t plane_tip = -1;
  bool is_in_stroke = false;
  int n_idle_frames = 0;
  std::vector<CutRecord> strokes;
  // Of the edge, what is inside the tissue at the frame's end.
  std::vector<SegmentPiece> engaged;
  Vec3 tissue_velocity = Vec3::Zero();  // around the edge, in the stroke so far [m/s]
  bool knows_tissue = false;            // from before it met the blade
};

struct CutStage : CutProgress {
  std::int32_t tool = 0;
  TetCutter tet;             // its stroke: on the keepers, the ranks that cut last
  std::vector<int> keepers;  // ascending; none: all ranks
  // As tissue_velocity, of a frame that began with tissue at or near the blade. [m/s]
  std::optional<Vec3> beside;
  // How far around the blade the owners of nodes cut with it, mean longest sides of elements: what
  // a cut looks at beyond that has to be asked of all ranks.
  double margin = 2;
  CutPlaneOptions plane;
};

// Cuts along all blades' motion in the frame and applies the edits. Collective.
void cut_along_blades(Simulation& s, const FrameSpan& span);

// Applies an edit and puts it into the stroke's ledger. Collective.
void note_edit(Simulation& s, const MeshEdit& edit, const CutFigures& figures, CutRecord& record);

// All cutters' looks at the whole mesh, one each: from here on they follow its edits.
void prepare_cutters(Simulation& s);

// From here on the stage's cutter has its stroke on these ranks (ascending). Collective.
void bring_stroke(const Simulation& s, std::span<const int> ranks, CutStage& stage);

}  // namespace trocar
