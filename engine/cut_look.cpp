#include "engine/cut_look.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "engine/plane_tip.h"

namespace trocar {

namespace {

// A blade that touches nothing for so long has left the tissue.
constexpr int idle_frames_to_leave = 3;
constexpr double tip_spacing = 0.25;  // of places on the way of an end, mean edge lengths

// Of points within a frame's reach of a blade.
std::vector<Location> locate_beside(const Simulation& s, BodyPositions& positions,
                                    std::span<const Vec3> points) {
  const std::vector<std::int32_t> near = positions.elements_near(box_around(points));
  return locate_points(s.mesh, positions.x(), points, near);
}

bool is_one_inside(const Simulation& s, BodyPositions& positions, std::span<const Vec3> points) {
  return std::ranges::any_of(locate_beside(s, positions, points),
                             [](const Location& location) { return location.element >= 0; });
}

// Whether the blade has met tissue beside where its edge is looked for, and between the frame's
// begin and its end.
bool has_passed(const Simulation& s, BodyPositions& positions, const BladeSweep& sweep,
                CutStage& stage) {
  if (s.mesh.dimension() == 3) return stage.tet.meets(s.mesh, positions, sweep);
  return is_one_inside(s, positions, way_of_tip(sweep, tip_spacing * s.edge_length));
}

// Where the edge's ends come by in the frame, but for its begin.
std::vector<Vec3> ways_of_ends(const BladeSweep& sweep, double spacing) {
  constexpr double most = 100;
  const std::array<Vec3, 2> from{sweep.before.front(), sweep.before.back()},
      to{sweep.after.front(), sweep.after.back()};
  const double way = std::max((to[0] - from[0]).norm(), (to[1] - from[1]).norm());
  const int n = static_cast<int>(std::ceil(std::clamp(way / spacing, 1.0, most)));
  std::vector<Vec3> points;
  for (int k = 1; k <= n; ++k)
    for (std::size_t end = 0; end < 2; ++end)
      points.push_back(from[end] + (to[end] - from[end]) * (1.0 * k / n));
  return points;
}

// Whether tissue begins to lie beside the open jaws of scissors, where it goes on beyond an end of
// the edge: once a closing, as a rule.
bool begins_beside(const Simulation& s, const CutStage& stage, const BladeSweep& sweep,
                   BodyPositions& positions) {
  const Tool& tool = s.tools[stage.tool];
  if (tool.kind != InstrumentKind::scissors) return false;
  const std::array<Vec3, 2> begin{sweep.before.front(), sweep.before.back()};
  if (is_one_inside(s, positions, begin)) return !stage.is_in_stroke;
  return is_one_inside(s, positions, ways_of_ends(sweep, tip_spacing * s.edge_length));
}

double length_of(std::span<const SegmentPiece> pieces) {
  double length = 0;
  for (const SegmentPiece& piece : pieces) length += piece.length;
  return length;
}

// By some places of the edge where it enters or leaves the tissue within the frame.
void measure_inside(const Simulation& s, BodyPositions& positions, const BladeSweep& sweep,
                    bool was_engaged, BladeLook& look) {
  look.share_inside = 1;
  look.most_inside = length_of(look.engaged);
  if (was_engaged && !look.engaged.empty()) return;
  constexpr int n_places = 16;
  int n_inside = 0;
  for (int k = 0; k < n_places; ++k) {
    const std::vector<Vec3> edge = edge_between(sweep.before, sweep.after, (k + 0.5) / n_places);
    const double inside = length_of(locate_edge(s, positions, edge));
    n_inside += inside > 0 ? 1 : 0;
    look.most_inside = std::max(look.most_inside, inside);
  }
  look.share_inside = static_cast<double>(n_inside) / n_places;
}

// True if this is the edge's last frame in the tissue.
bool leaves_tissue(const Simulation& s, const CutStage& stage, const BladeWay& way, bool has_met) {
  const Tool& tool = s.tools[stage.tool];
  const FrameSpan& span = way.span;
  return !way.is_near || (!has_met && stage.n_idle_frames + 1 >= idle_frames_to_leave) ||
         !is_cutting(tool, span.t1, span.t1 + (span.t1 - span.t0));
}

}  // namespace

std::vector<Vec3> edge_in_body(const Simulation& s, const Tool& tool, double time) {
  std::vector<Vec3> edge = cutting_edge(tool, time);
  if (s.mesh.dimension() == 2) edge = {tip_in_plane(edge, s.scene.tissue.thickness)};
  return edge;
}

std::vector<SegmentPiece> locate_edge(const Simulation& s, BodyPositions& positions,
                                      std::span<const Vec3> edge) {
  if (s.mesh.dimension() == 2) {
    const Location at = locate_beside(s, positions, edge.first(1))[0];
    if (at.element < 0) return {};
    return {{.middle = at, .length = s.scene.tissue.thickness}};
  }
  const std::array<Vec3, 2> ends = {edge.front(), edge.back()};
  const std::vector<std::int32_t> near = positions.elements_near(box_around(ends));
  return locate_segment(s.mesh, positions.x(), ends, near);
}

BladeLook look_and_cut(const Simulation& s, const BladeWay& way, bool was_engaged, CutStage& stage,
                       BodyPositions& positions) {
  const BladeSweep& sweep = way.sweep;
  BladeLook look{.engaged = locate_edge(s, positions, sweep.after)};
  look.has_met = !look.engaged.empty() || has_passed(s, positions, sweep, stage);
  if (!stage.is_in_stroke && !look.has_met) return look;
  look.is_beside = begins_beside(s, stage, sweep, positions);
  look.is_last = leaves_tissue(s, stage, way, look.has_met);
  measure_inside(s, positions, sweep, was_engaged, look);
  if (s.mesh.dimension() == 2) return look;
  if (!stage.is_in_stroke) stage.tet.start_stroke();
  advance_stroke(s, sweep, stage, positions, look);
  look.swept = swept_places(s, positions, sweep);
  return look;
}

void advance_stroke(const Simulation& s, const BladeSweep& sweep, CutStage& stage,
                    BodyPositions& positions, BladeLook& look) {
  const std::vector<std::uint8_t> is_held = held_nodes(s.holds, s.fixed);
  look.edit = stage.tet.advance(s.mesh, positions, {is_held, s.loads.border}, sweep, look.is_last,
                                look.figures);
  look.goes_on = goes_on(stage.tet.stroke());
  if (look.is_last) look.left = stage.tet.left();
}

static std::vector<int> ranks_around(const Simulation& s, const Box& blade, double way,
                                     const CutStage& stage) {
  const bool are_all = s.mesh.dimension() == 2 || s.communicator->size() == 1;
  std::vector<std::uint8_t> is_around(static_cast<std::size_t>(s.communicator->size()),
                                      are_all ? 1 : 0);
  const auto mark = [&](int rank) { is_around[rank] = 1; };
  if (!are_all)
    for (const std::int32_t e : elements_near(blade, way + stage.margin * s.boxes.size, s.boxes))
      for (const std::int32_t i : s.mesh.corners(e)) mark(s.node_owner[i]);
  if (std::ranges::count(is_around, 0) == std::ssize(is_around))
    mark(stage.keepers.empty() ? 0 : stage.keepers.front());
  std::vector<int> ranks(is_around.size());
  std::iota(ranks.begin(), ranks.end(), 0);
  std::erase_if(ranks, [&](int r) { return is_around[r] == 0; });
  return ranks;
}

// Anew where an edit has outrun the boxes.
static double begun(Simulation& s, std::optional<double>& way) {
  if (!way || s.boxes.is_empty()) way = begin_positions(s);
  return *way;
}

AroundBlade::AroundBlade(Simulation& s, const Box& blade, const CutStage& stage,
                         std::optional<double>& way)
    : group(s, ranks_around(s, blade, begun(s, way), stage)), positions(s, group, *way) {}

}  // namespace trocar
