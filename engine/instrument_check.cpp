#include "engine/instrument_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/log.h"
#include "base/number_text.h"
#include "base/options.h"
#include "collision/closest_point.h"

namespace trocar {

namespace {

// Of a triangle seen from the origin, positive from behind (Van Oosterom and Strackee 1983).
double solid_angle(const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

// How deep a point lies in the body: its distance from the surface, 0 outside of it.
double depth_in_body(const Surface& surface, std::span<const Vec3> x, const Vec3& point) {
  double angle = 0, distance = std::numeric_limits<double>::infinity();
  for (const auto& node : surface.triangle) {
    const Triangle triangle{x[node[0]] - point, x[node[1]] - point, x[node[2]] - point};
    angle += solid_angle(triangle);
    distance = std::min(distance, closest_point_triangle(Vec3::Zero(), triangle).point.norm());
  }
  return angle > 2 * std::numbers::pi ? distance : 0;
}

void warn_if_hasty(const SceneInstrument& instrument, const std::string& place, double wait) {
  const bool has_blades = instrument.kind == InstrumentKind::scissors;
  log_warning(place + ": \"" + instrument.name + "\" turns its jaws round after " +
              short_text(wait) + " s, but they take " + short_text(jaw_time) + " s: " +
              (has_blades ? "they don't close fully, and leave uncut what is left between them"
                          : "it takes hold and lets go at the keys all the same, but pictures show "
                            "jaws that turn round halfway") +
              "; let more time pass between the two actions");
}

// Between two orientations. [rad]
double turn_between(const InstrumentKey& a, const InstrumentKey& b) {
  return tool_rotation(a.direction, a.forward)
      .angularDistance(tool_rotation(b.direction, b.forward));
}

// Of the tip, and of shafts, which may go right through.
double depth_of_axes(const Simulation& s, const Tool& tool) {
  constexpr int n_parts = 64;  // of a shaft
  const Pose pose = tool.path.at(0);
  std::vector<Vec3> points = {pose.translation};
  for (const ConvexPiece& piece : tool.shape.pieces)
    for (int k = 0; k <= n_parts && piece.points.size() == 2; ++k)
      points.push_back(
          pose.apply(piece.points[0] + (piece.points[1] - piece.points[0]) * (1.0 * k / n_parts)));
  const Box body = box_of(s.view);
  double deepest = 0;
  for (const Vec3& point : points)
    if (body.holds(point, 0))
      deepest = std::max(deepest, depth_in_body(s.surface, s.view.x, point));
  return deepest;
}

}  // namespace

void warn_of_short_tools(const Scene& scene) {
  for (std::size_t k = 0; k < scene.instruments.size(); ++k) {
    const SceneInstrument& instrument = scene.instruments[k];
    const double least = least_length(instrument);
    if (instrument.length < least)
      log_warning(item_path("instrument", k) + ".length: \"" + instrument.name + "\" is made " +
                  short_text(least) + " m long, not " + short_text(instrument.length) +
                  " m: its shaft would end short of what it carries");
  }
}

void warn_of_hasty_jaws(const Scene& scene) {
  constexpr double rounding = 1e-9;
  for (std::size_t k = 0; k < scene.instruments.size(); ++k) {
    const InstrumentKey* last = nullptr;  // that turned the jaws round
    const std::vector<InstrumentKey>& path = scene.instruments[k].path;
    for (std::size_t j = 0; j < path.size(); ++j) {
      if (path[j].action == GraspAction::none) continue;
      if (last && last->action == path[j].action) continue;
      if (last && path[j].time - last->time < jaw_time - rounding)
        warn_if_hasty(scene.instruments[k], item_path("instrument", k) + "." + item_path("path", j),
                      path[j].time - last->time);
      last = &path[j];
    }
  }
}

void warn_of_half_turns(const Scene& scene) {
  constexpr double degree = std::numbers::pi / 180, too_far = 170 * degree;
  for (std::size_t k = 0; k < scene.instruments.size(); ++k) {
    const SceneInstrument& instrument = scene.instruments[k];
    for (std::size_t j = 1; j < instrument.path.size(); ++j) {
      const InstrumentKey &from = instrument.path[j - 1], &to = instrument.path[j];
      const double turn = turn_between(from, to);
      if (turn < too_far) continue;
      log_warning(item_path("instrument", k) + "." + item_path("path", j) + ": \"" +
                  instrument.name + "\" turns by " + short_text(turn / degree) +
                  " degrees between its keys at " + short_text(from.time) + " s and " +
                  short_text(to.time) +
                  " s, where the two ways round are about as short: a key in between says which");
    }
  }
}

void tell_of_bulges(const std::vector<Tool>& tools, double edge) {
  constexpr double wide = 0.25;  // edges
  for (const Tool& tool : tools) {
    const ToolPath::Bulge bulge = tool.path.largest_bulge();
    if (bulge.width > wide * edge)
      log_info("\"" + tool.name + "\" goes up to " + short_text(1e3 * bulge.width) +
               " mm beside the straight line between its keys at " + short_text(bulge.begin) +
               " s and " + short_text(bulge.end) + " s (`stop = true` at both: a straight line)");
  }
}

// Contacts are sought at the surface: what is well inside meets none, so it is looked for.
void check_instruments_outside(const LoadedScene& loaded, double allowed, const std::string& what,
                               Simulation& s) {
  OptionErrors errors(loaded.where);
  std::vector<double> depth(s.tools.size(), 0);
  detect_contacts(*s.contact, s.tools, s.holds, s.view, FrameSpan{}, 0);
  for (const Contact& contact : s.contact->contacts) {
    double& deepest = depth[contact.tool];
    deepest = std::max(deepest, -contact.gap);
  }
  for (std::size_t k = 0; k < s.tools.size(); ++k) {
    const Tool& tool = s.tools[k];
    // Blades may begin in the tissue, scissors around it.
    if (s.mesh.dimension() == 3 && tool.edge.empty())
      depth[k] = std::max(depth[k], depth_of_axes(s, tool));
    if (depth[k] <= allowed) continue;
    errors.add(item_path("instrument", k) + ".path[0].position",
               "\"" + tool.name + "\" reaches " + short_text(depth[k]) + " m into " + what +
                   (s.mesh.dimension() == 2 ? " (in a plane scene z does not count: "
                                              "move it aside)"
                                            : ""));
  }
  errors.throw_if_any();
}

}  // namespace trocar
