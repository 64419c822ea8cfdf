#include "engine/suspect.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "collision/narrow_phase.h"
#include "engine/point_text.h"

namespace trocar {

namespace {

constexpr double near_edges = 2;  // beyond the way within the frame

// Nodes of the element, or the node, that is to blame.
std::vector<std::int32_t> failed_nodes(const Mesh& mesh, const Watch& failed) {
  if (failed.bad_node >= 0) return {failed.bad_node};
  const std::int32_t e = failed.least_J > 0 ? failed.stable_element : failed.least_J_element;
  if (e < 0) return {};
  const auto corners = mesh.corners(e);
  return {corners.begin(), corners.end()};
}

// What may be to blame.
struct Mover {
  // From where the tissue was at the frame's beginning: of tools the least within the frame. [m]
  double gap = std::numeric_limits<double>::infinity();
  double way = 0;  // within the frame [m]
  std::string name, how;
  bool is_scalpel = false;
};

// The one so far: of those that come near the one that moves most, else the nearest.
struct Choice {
  double reach = 0;  // [m]
  Mover best;

  bool comes_near(const Mover& mover) const { return mover.gap < reach + mover.way; }
  bool is_better(const Mover& mover) const {
    constexpr double rounding = 1e-9;
    const bool was_near = comes_near(best), is_near = comes_near(mover);
    if (was_near != is_near) return is_near;
    const bool is_as_fast = std::abs(mover.way - best.way) <= rounding * best.way;
    return is_near && !is_as_fast ? mover.way > best.way : mover.gap < best.gap;
  }
  void offer(Mover&& mover) {
    if (is_better(mover)) best = std::move(mover);
  }
};

// Where a piece comes nearest to x within the frame.
struct Approach {
  double gap = std::numeric_limits<double>::infinity();  // [m]
  Vec3 point = Vec3::Zero();                             // of the piece, in the tool's frame
};

Approach approach_of(const Tool& tool, const PieceCore& core, const Vec3& x,
                     const FrameSpan& span) {
  constexpr int n_parts = 32;  // of the frame
  Approach nearest;
  for (int k = 0; k <= n_parts; ++k) {
    const double time = span.t0 + (span.t1 - span.t0) * k / n_parts;
    const Vec3 local = tool.path.at(time).apply_inverse(x);
    const SignedDistance at = signed_distance(core, local);
    if (at.gap < nearest.gap) nearest = {.gap = at.gap, .point = local - at.gap * at.normal};
  }
  return nearest;
}

void look_at_tools(std::span<const Tool> tools, const Vec3& x, const FrameSpan& span,
                   Choice& choice) {
  for (const Tool& tool : tools) {
    for (const ConvexPiece& piece : tool.shape.pieces) {
      const Approach approach = approach_of(tool, make_core(piece), x, span);
      choice.offer({.gap = std::max(0.0, approach.gap),
                    .way = tool.path.travel(span.t0, span.t1, {approach.point, approach.point}),
                    .name = "\"" + tool.name + "\"",
                    .how = "from ",
                    .is_scalpel = tool.kind == InstrumentKind::scalpel});
    }
  }
}

void look_at_holds(const Simulation& s, std::span<const Vec3> all, const Vec3& x,
                   const FrameSpan& span, Choice& choice) {
  for (const Hold& hold : s.holds.holds) {
    Mover found{.gap = (all[hold.node] - x).norm(), .how = "from a node held by "};
    if (hold.tool >= 0) {
      const Tool& tool = s.tools[hold.tool];
      found.name = "\"" + tool.name + "\"";
      found.way = grip_travel(tool, span.t0, span.t1);
    } else {
      const auto support = static_cast<std::size_t>(hold.support);
      const DisplacementPath& path = s.holds.paths[support];
      found.name = "the support of \"" + s.scene.supports[support].region + "\"";
      found.way = (path.at(span.t1) - path.at(span.t0)).norm();
    }
    choice.offer(std::move(found));
  }
}

// "" where no material is to blame.
std::string material_cure(std::span<const Material> materials) {
  const auto is_any = [&](MaterialModel model) {
    return std::ranges::any_of(materials, [&](const Material& m) { return m.model == model; });
  };
  const std::string large = "a material for large strains such as neo-hookean";
  if (is_any(MaterialModel::st_venant_kirchhoff))
    return large + " (st-venant-kirchhoff softens as it is pressed together, and collapses), ";
  return is_any(MaterialModel::linear) ? large + ", " : "";
}

// The grasper that has opened a moment before t: what it had stretched springs back. "": none has.
std::string just_opened(std::span<const Tool> tools, double t) {
  constexpr double moment = 0.1;  // [s]
  for (const Tool& tool : tools)
    for (const InstrumentKey& key : tool.keys)
      if (tool.kind == InstrumentKind::grasper && key.action == GraspAction::open &&
          key.time <= t && key.time > t - moment)
        return "\"" + tool.name + "\"";
  return "";
}

// Tissue that is damped so much does not get out of the way. "" with less.
std::string damping_cure(const SceneSolver& solver) {
  constexpr double large = 1000;  // a millisecond to come to rest [1/s]
  if (solver.mass_damping <= large) return "";
  return "a lower solver.mass_damping (" + short_text(solver.mass_damping) +
         " 1/s holds the tissue where it is), ";
}

// `mover` comes near in the frame; without a name: none does.
std::string cure(const Simulation& s, const Mover& mover, double t) {
  const std::string rest = ", a finer mesh, a higher frame_rate or a lower poisson_ratio";
  if (const std::string opened = just_opened(s.tools, t); !opened.empty())
    return damping_cure(s.scene.solver) + material_cure(s.materials) + "a shorter pull of " +
           opened + ", which has just let go, or a way back before it opens" + rest;
  const bool has_loads = !s.scene.loads.empty() || s.scene.solver.gravity != Vec3::Zero();
  const std::string less =
      has_loads || s.tools.empty() ? "smaller loads" : "to press less deep or more slowly";
  const std::string narrower = mover.is_scalpel ? ", a shorter and so narrower blade_length" : "";
  return damping_cure(s.scene.solver) + material_cure(s.materials) +
         (mover.name.empty() ? less : "a slower or shorter path of " + mover.name + narrower) +
         rest;
}

}  // namespace

Suspect find_suspect(Simulation& s, const Watch& failed, const FrameSpan& span) {
  const std::vector<std::int32_t> nodes = failed_nodes(s.mesh, failed);
  if (nodes.empty()) return {.place = "", .cure = cure(s, {}, span.t0)};
  const GlobalState global = gather_state(s);
  Vec3 x = Vec3::Zero();
  for (const std::int32_t node : nodes) x += global.x[node] / static_cast<double>(nodes.size());
  Choice choice{.reach = near_edges * s.edge_length, .best = {}};
  look_at_tools(s.tools, x, span, choice);
  look_at_holds(s, global.x, x, span, choice);
  const Mover& best = choice.best;
  std::string place = " at " + point_text(x) + " m";
  if (best.name.empty()) return {.place = place, .cure = cure(s, {}, span.t0)};
  place += ", " + short_text(best.gap) + " m " + best.how + best.name;
  place += best.way > 0 ? ", which moves at " + short_text(best.way / (span.t1 - span.t0)) + " m/s"
                        : ", which rests";
  const bool may_be = best.way > 0 && choice.comes_near(best);
  return {.place = place, .cure = cure(s, may_be ? best : Mover{}, span.t0)};
}

}  // namespace trocar
