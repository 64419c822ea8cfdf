#include "engine/cut_front.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/segment.h"
#include "engine/cut_look.h"
#include "engine/cut_parted.h"
#include "engine/edge_place.h"
#include "engine/frame_watch.h"
#include "engine/tissue_way.h"

namespace trocar {

namespace {

// The edge is looked at once for so much of its way, over the mean edge length, and no more often
// a frame than this.
constexpr double spacing = 0.1;
constexpr int most_looks = 256;
// Tissue that is parted so near beside the edge, over the size of the element, is so at the edge:
// nodes of a cut may lie aside of where the blade went, and a slice as thin is not cut off.
constexpr double beside = 0.4;
// A way along the edge, as the sine of the angle between them.
constexpr double least_across = 0.05;

// A blade's motion in a frame.
struct EdgeMotion {
  const Simulation& s;
  const FrameSpan& span;
  const CutStage& stage;
  Vec3 velocity;         // of the edge's middle [m/s]
  Vec3 tissue_velocity;  // [m/s]

  const Tool& tool() const { return s.tools[stage.tool]; }
  // As the tissue sees it, which lies as at the frame's begin.
  std::vector<Vec3> edge_at(double time) const {
    std::vector<Vec3> points = edge_in_body(s, tool(), time);
    for (Vec3& point : points) point -= (time - span.t0) * tissue_velocity;
    return points;
  }
  EngagedEdge engaged(std::span<const SegmentPiece> piece) const {
    return {.tool = stage.tool,
            .piece = piece,
            .velocity = velocity,
            .tissue_velocity = tissue_velocity};
  }
};

EdgeMotion motion_of(const Simulation& s, const FrameSpan& span, const CutStage& stage) {
  EdgeMotion motion{s, span, stage, Vec3::Zero(), Vec3::Zero()};
  const Vec3 way = middle_of(motion.edge_at(span.t1)) - middle_of(motion.edge_at(span.t0));
  motion.velocity = way / (span.t1 - span.t0);
  return motion;
}

Box box_of(const EdgeMotion& motion, double margin) {
  Box box;
  for (const double time : {motion.span.t0, motion.span.t1})
    box.add(bounding_box(motion.edge_at(time)));
  return box.grown(margin);
}

// In the stroke so far, else of what is near. What springs back from a blade that it met is not how
// the tissue comes.
std::optional<Vec3> tissue_velocity_of(const EdgeMotion& motion, BodyPositions& positions,
                                       double reach) {
  const CutStage& stage = motion.stage;
  if (stage.is_in_stroke) return stage.tissue_velocity;
  const FrameSpan& span = motion.span;
  const auto now = velocity_beside(motion.s, positions, motion.edge_at(span.t0), reach);
  if (!now || !stage.knows_tissue) return now;
  return stage.tissue_velocity + share_of_frame(span.t1 - span.t0) * (*now - stage.tissue_velocity);
}

double distance_to(const std::vector<Vec3>& path, const Vec3& p) {
  double least = 1e300;
  for (std::size_t k = 1; k < path.size(); ++k)
    least = std::min(least, (p - nearest_on_segment(path[k - 1], path[k], p)).norm());
  return least;
}

// Whether the blade has been where the edge goes, and the cut waits there or leaves it joined.
bool is_swept(const EdgeMotion& motion, std::int32_t element, const EdgePlace& place) {
  const CutStage& stage = motion.stage;
  const Vec3 ahead = place.ahead - place.along.dot(place.ahead) * place.along;
  if (motion.s.mesh.dimension() == 3)
    return stage.tet.has_crossed_ahead(motion.s.mesh, element, place.X, ahead, place.normal());
  const double reach = beside * place.size;
  return stage.is_in_stroke && distance_to(stage.plane_path, place.X + reach * ahead) < 0.5 * reach;
}

bool is_open(const EdgeMotion& motion, std::span<const std::int32_t> near, const EdgePlace& place) {
  const Vec3 aside = beside * place.size * place.normal();
  return is_parted(motion.s.mesh, near, {place.X - aside, place.X + aside});
}

// Of the edge as it lies at some time in the tissue.
void add_pieces(const EdgeMotion& motion, BodyPositions& positions, const std::vector<Vec3>& edge,
                double share, std::vector<SegmentPiece>& pieces) {
  const Simulation& s = motion.s;
  const Vec3 ahead = direction_of(motion.engaged({}));
  const bool is_plane = s.mesh.dimension() == 2;
  const Vec3 along = is_plane ? Vec3::UnitZ() : Vec3((edge.back() - edge.front()).normalized());
  const double across = along.cross(ahead).norm();
  if (across < least_across) return;
  const std::vector<std::int32_t> near =
      positions.elements_near(box_around(edge).grown(s.edge_length));
  for (SegmentPiece& piece : locate_edge(s, positions, edge)) {
    const EdgePlace place = place_of(s.mesh, positions.x(), piece.middle, along, ahead);
    if (is_open(motion, near, place) || is_swept(motion, piece.middle.element, place)) continue;
    piece.length *= share * across;
    pieces.push_back(piece);
  }
}

// The edge at equal times of the frame, in the middle of each, and its share of the whole way.
struct Look {
  std::vector<Vec3> edge;
  double share = 0;
};
std::vector<Look> looks_of(const EdgeMotion& motion) {
  const auto time = [&](double share) {
    return motion.span.t0 + share * (motion.span.t1 - motion.span.t0);
  };
  const auto way = [&](double from, double to) {
    const std::vector<Vec3> before = motion.edge_at(time(from)), after = motion.edge_at(time(to));
    return std::max((after.front() - before.front()).norm(), (after.back() - before.back()).norm());
  };
  const double most = way(0, 1) / (spacing * motion.s.edge_length);
  const int n = static_cast<int>(std::clamp(std::ceil(most), 1.0, 1.0 * most_looks));
  std::vector<Look> looks;
  double whole = 0;
  for (int k = 0; k < n; ++k) {
    looks.push_back({motion.edge_at(time((k + 0.5) / n)), way(1.0 * k / n, (k + 1.0) / n)});
    whole += looks.back().share;
  }
  for (Look& look : looks) look.share = whole > 0 ? look.share / whole : 0;
  return looks;
}

// reach: how far tissue may be from the blade that comes to it in the frame, and a mean edge more.
// [m]
CutFront find_front(const Simulation& s, const FrameSpan& span, const CutStage& stage,
                    BodyPositions& positions, double reach) {
  EdgeMotion motion = motion_of(s, span, stage);
  positions.elements_near(box_of(motion, reach));  // asks for all nodes at once
  const std::optional<Vec3> tissue = tissue_velocity_of(motion, positions, reach);
  motion.tissue_velocity = tissue.value_or(Vec3::Zero());
  CutFront front{
      .piece = {}, .tissue_velocity = motion.tissue_velocity, .is_near = tissue.has_value()};
  for (const Look& look : looks_of(motion))
    add_pieces(motion, positions, look.edge, look.share, front.piece);
  return front;
}

}  // namespace

void prepare_drag(Simulation& s, const FrameSpan& span, double travel) {
  s.drag.node.clear();
  if (s.scene.cutting.resistance == 0) return;
  const PhaseScope scope(s.timers, phase_cut);
  const double reach = s.edge_length + travel;
  std::optional<double> way;
  std::optional<Box> body;
  for (CutStage& stage : s.cuts) {
    stage.beside.reset();
    stage.resisted.clear();
    EdgeMotion motion = motion_of(s, span, stage);
    if (!is_cutting(motion.tool(), span.t0, span.t1)) continue;
    if (!body) body = box_of(s.view);
    const Box box = box_of(motion, reach);
    if (!box.overlaps(*body)) continue;  // clear of the body
    AroundBlade around(s, box, stage, way);
    bring_stroke(s, around.group.ranks(), stage);
    const auto front = found_by<CutFront>(
        around.group, [&] { return find_front(s, span, stage, around.positions, reach); });
    if (front.is_near) stage.beside = front.tissue_velocity;
    stage.resisted = front.piece;
    motion.tissue_velocity = front.tissue_velocity;
    add_engaged_edge(motion.engaged(front.piece), s.mesh, s.part, s.scene.cutting.resistance,
                     s.drag);
  }
  for (BladeDrag::Node& node : s.drag.node)
    node.arm = present_position(s, node.local) - s.tools[node.tool].path.at(span.t0).translation;
}

}  // namespace trocar
