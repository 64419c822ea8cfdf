// What a blade meets within a frame and, of a body in space, the edit that it makes: what the ranks
// around it find for all others.
#pragma once

#include "engine/archive_cut.h"
#include "engine/body_positions.h"
#include "engine/swept_area.h"

namespace trocar {

// A blade's way within a frame.
struct BladeWay {
  FrameSpan span;
  BladeSweep sweep;
  Box box;               // around the sweep
  bool is_near = false;  // to the tissue, and cutting
};

struct BladeLook {
  std::vector<SegmentPiece> engaged;
  bool has_met = false;     // the tissue, or some of it since the frame's begin
  bool is_beside = false;   // tissue begins to lie beside open jaws
  bool is_last = false;     // frame of the stroke
  bool goes_on = true;      // not back in its slit
  double share_inside = 0;  // of the frame's way, with some of the edge in the tissue
  double most_inside = 0;   // of the edge, at most [m]
  CutterEdit edit;
  CutFigures figures;
  CutLeft left;  // by the stroke, if it ends
  std::vector<SweptPlace> swept;
};
template <class Archive>
void visit(Archive& a, BladeLook& l) {
  a(l.engaged, l.has_met, l.is_beside, l.is_last, l.goes_on, l.share_inside, l.most_inside, l.edit,
    l.figures, l.left, l.swept);
}

inline Vec3 middle_of(const std::vector<Vec3>& edge) {
  return 0.5 * (edge.front() + edge.back());
}

// The edge at a share of its way from one place to another.
inline std::vector<Vec3> edge_between(std::span<const Vec3> before, std::span<const Vec3> after,
                                      double share) {
  std::vector<Vec3> edge;
  for (std::size_t i = 0; i < before.size(); ++i)
    edge.push_back((1 - share) * before[i] + share * after[i]);
  return edge;
}

// The cutting edge, of a plane body's blade the tip alone.
std::vector<Vec3> edge_in_body(const Simulation& s, const Tool& tool, double time);

// Where the blade's edge is inside the tissue; for a plane body its tip alone, which is as long as
// the body is thick.
std::vector<SegmentPiece> locate_edge(const Simulation& s, BodyPositions& positions,
                                      std::span<const Vec3> edge);

// Begins a stroke of stage.tet where there is none and the blade has met the tissue, and takes it
// on by the blade's way. was_engaged: whether some of the edge was in the tissue at the frame's
// begin.
BladeLook look_and_cut(const Simulation& s, const BladeWay& way, bool was_engaged, CutStage& stage,
                       BodyPositions& positions);

// The edit and the figures of what the sweep does in the stroke that is under way.
void advance_stroke(const Simulation& s, const BladeSweep& sweep, CutStage& stage,
                    BodyPositions& positions, BladeLook& look);

// The ranks that own nodes around a blade, or one of those that cut before; in the plane all. With
// where nodes are there.
struct AroundBlade {
  // way: see begin_positions; none until a blade needs it. Collective.
  AroundBlade(Simulation& s, const Box& blade, const CutStage& stage, std::optional<double>& way);
  AroundBlade(const AroundBlade&) = delete;
  AroundBlade& operator=(const AroundBlade&) = delete;

  const CutGroup group;
  BodyPositions positions;
};

}  // namespace trocar
