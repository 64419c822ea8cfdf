#include "engine/tool.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <ranges>

namespace trocar {

namespace {

constexpr int round_faces = 24;
constexpr double jaw_angle = 0.30;  // of each open jaw [rad]
constexpr double jaw_slope = jaw_angle + jaw_angle * jaw_angle * jaw_angle / 3;  // its tangent
constexpr double first_crossing = 0.15;  // of scissors' blades from the pivot, over their length

// Of the depth at which the middle of closed jaws lies.
constexpr double caught_share = 0.5;

constexpr double grasper_jaw = 0.022;  // [m]

ConvexPiece shaft_piece(double from, double to, double radius, double x = 0) {
  return {.points = {Vec3(x, 0, from), Vec3(x, 0, to)}, .radius = radius};
}

void add_part(Tool& tool, TriangleMesh surface, int jaw = 0) {
  tool.parts.push_back({.surface = std::move(surface), .jaw = jaw});
}

void make_probe(Tool& tool, const SceneInstrument& s) {
  const double shaft = 0.6 * s.radius;
  tool.shape.pieces = {shaft_piece(2 * s.radius, s.length, shaft),
                       {.points = {Vec3(0, 0, s.radius)}, .radius = s.radius}};
  add_part(tool, make_sphere_surface(Vec3(0, 0, s.radius), s.radius, round_faces));
  add_part(tool, make_cone_surface(Vec3(0, 0, 1.6 * s.radius), Vec3(0, 0, s.length), shaft, shaft,
                                   round_faces));
}

void make_scalpel(Tool& tool, const SceneInstrument& s, double edge_spacing) {
  const double length = s.blade_length, width = 0.28 * length, half = 0.05e-3,
               shown = 0.3e-3;  // thin, so that a fresh wound is not thrown open
  const double neck = 0.45 * s.radius;
  // The edge looks along +x; the blade's back rises from the tip.
  const std::vector<Vec3> outline = {Vec3(0, 0, 0), Vec3(0, 0, length),
                                     Vec3(-width, 0, 1.15 * length),
                                     Vec3(-width, 0, 0.35 * length)};
  ConvexPiece blade{.least_flatness = 0.9, .deepest = 0.3e-3, .has_edge = true};
  for (const Vec3& corner : outline)
    for (const double y : {-half, half}) blade.points.push_back(corner + Vec3(0, y, 0));
  const double x = -0.5 * width;
  tool.shape.pieces = {shaft_piece(1.3 * length, s.length, s.radius, x), blade};
  add_part(tool, make_plate_surface({outline[0], outline[3], outline[2], outline[1]}, Vec3::UnitY(),
                                    shown));
  add_part(tool, make_cone_surface(Vec3(x, 0, 0.95 * length), Vec3(x, 0, 1.5 * length), neck,
                                   s.radius, round_faces));
  add_part(tool, make_cone_surface(Vec3(x, 0, 1.5 * length), Vec3(x, 0, s.length), s.radius,
                                   s.radius, round_faces));
  const int n = std::max(2, static_cast<int>(std::ceil(length / edge_spacing)));
  for (int k = 0; k <= n; ++k) tool.edge.emplace_back(0, 0, length * k / n);
}

// A capsule from the hinge to the tip, in place of the open jaws.
void add_closed_jaws(Tool& tool, double radius) {
  tool.open_end = tool.closed_begin = tool.shape.pieces.size();
  tool.caught = caught_share * radius;
  tool.shape.pieces.push_back(shaft_piece(0, tool.hinge_height, radius));
}

void add_hinge_and_shaft(Tool& tool, const SceneInstrument& s) {
  const double jaw = tool.hinge_height;
  add_part(tool, make_capsule_surface(Vec3(0, -0.9 * s.radius, jaw), Vec3(0, 0.9 * s.radius, jaw),
                                      0.7 * s.radius, round_faces));
  add_part(tool, make_cone_surface(Vec3(0, 0, jaw), Vec3(0, 0, jaw + 2 * s.radius), 0.6 * s.radius,
                                   s.radius, round_faces));
  add_part(tool, make_cone_surface(Vec3(0, 0, jaw + 2 * s.radius), Vec3(0, 0, s.length), s.radius,
                                   s.radius, round_faces));
}

void make_grasper(Tool& tool, const SceneInstrument& s) {
  const double jaw = grasper_jaw, thick = 0.55 * s.radius;
  tool.hinge_height = jaw;
  tool.grip_radius = s.grip_radius;
  tool.grip_force = s.grip_force;
  tool.closed_share = 0.15;
  // Open jaws for contact: capsules from the hinge to the two tips.
  ConvexPiece upper{.points = {Vec3(0, 0, jaw), Vec3(jaw_slope * jaw, 0, 0)},
                    .radius = 0.4 * s.radius};
  ConvexPiece lower = upper;
  lower.points[1].x() *= -1;
  tool.shape.pieces = {shaft_piece(jaw + s.radius, s.length, s.radius), upper, lower};
  add_closed_jaws(tool, thick);
  for (const int side : {1, -1}) {
    const double in = 0.02 * thick * side, out = thick * side, w = 0.7 * s.radius;
    TriangleMesh plate =
        make_box_surface(Vec3(std::min(in, out), -w, -0.002), Vec3(std::max(in, out), w, jaw));
    for (int tooth = 0; tooth < 6; ++tooth) {
      const double z = 0.001 + 0.0028 * tooth;
      append(plate, make_box_surface(Vec3(std::min(-in, 0.5 * out), -w, z),
                                     Vec3(std::max(-in, 0.5 * out), w, z + 0.0012)));
    }
    add_part(tool, plate, side);
  }
  add_hinge_and_shaft(tool, s);
}

// Where the blades of open scissors cross: tissue goes between them as far as this, and is cut from
// here on when they close.
ConvexPiece crotch_piece(double length, double radius) {
  const Vec3 hinge(0, 0, length), down(0, 0, first_crossing * length);
  const Vec3 aside(jaw_slope * down.z(), 0, 0);
  return {.points = {hinge, hinge - down + aside, hinge - down - aside}, .radius = radius};
}

// Open for contact, which its flat sides and the crotch have; closed for the picture, side by side.
void make_scissors(Tool& tool, const SceneInstrument& s, double edge_spacing) {
  const double length = s.blade_length, width = 0.14 * length, half = 0.05e-3, shown = 0.8e-3;
  tool.hinge_height = length;
  tool.closed_share = 0;
  tool.shape.pieces = {shaft_piece(length + s.radius, s.length, s.radius)};
  for (const int side : {1, -1}) {
    const Vec3 hinge(0, 0, length), back(side * width, 0, 0);
    const Vec3 tip(side * jaw_slope * length, 0, 0);
    ConvexPiece blade{.least_flatness = 0.9, .deepest = 0.3e-3};
    for (const Vec3& corner :
         {hinge, tip, Vec3(hinge + back), Vec3(tip + 0.3 * (hinge - tip) + back)})
      for (const double y : {-half, half}) blade.points.push_back(corner + Vec3(0, y, 0));
    tool.shape.pieces.push_back(blade);
    const Vec3 beside(0, side * shown / 2, 0);
    std::vector<Vec3> outline = {beside, beside + back + 0.3 * hinge, beside + back + hinge,
                                 beside + hinge};
    if (side < 0) std::reverse(outline.begin(), outline.end());
    add_part(tool, make_plate_surface(outline, -Vec3::UnitY(), shown), side);
  }
  tool.shape.pieces.push_back(crotch_piece(length, shown / 2));
  add_closed_jaws(tool, shown);
  add_hinge_and_shaft(tool, s);
  const double reach = jaw_slope * length;
  const int n = std::max(2, static_cast<int>(std::ceil(2 * reach / edge_spacing)));
  for (int k = 0; k <= n; ++k) tool.edge.emplace_back(reach * (2.0 * k / n - 1), 0, 0);
}

// A hull without volume would hold nothing back: points to both sides of a flat one.
std::vector<Vec3> with_thickness(std::vector<Vec3> points) {
  constexpr double least = 0.05e-3;  // [m]
  Vec3 middle = Vec3::Zero();
  for (const Vec3& point : points) middle += point / static_cast<double>(points.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& point : points) spread += (point - middle) * (point - middle).transpose();
  const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = axes.col(k);
    const auto [low, high] = std::ranges::minmax(
        points | std::views::transform([&](const Vec3& point) { return axis.dot(point); }));
    if (high - low >= least) continue;
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
      points.push_back(points[i] + least / 2 * axis);
      points[i] -= least / 2 * axis;
    }
  }
  return points;
}

// The user's surface replaces the working piece: its hull touches, a scalpel's as its blade does,
// and its triangles show. It has no jaws that open: between those of scissors there is room for
// tissue, so that the hull touches in place of the closed ones alone.
void use_mesh(Tool& tool, const TriangleMesh& mesh) {
  std::vector<ConvexPiece>& pieces = tool.shape.pieces;
  ConvexPiece hull;
  if (tool.kind == InstrumentKind::scalpel) hull = pieces[first_working_piece];
  hull.points = with_thickness(mesh.X);
  if (tool.kind == InstrumentKind::scissors) {
    pieces.resize(tool.closed_begin);
  } else {
    pieces.resize(first_working_piece);
    tool.open_end = no_piece;
    tool.closed_begin = first_working_piece;
  }
  pieces.push_back(std::move(hull));
  tool.caught = std::numeric_limits<double>::infinity();
  const ConvexPiece& shaft = pieces[0];
  tool.parts.clear();
  add_part(tool, mesh);
  add_part(tool, make_capsule_surface(shaft.points[0], shaft.points[1], shaft.radius, round_faces));
  tool.own_mesh = mesh;
}

Box box_round(const ToolShape& shape) {
  Box box;
  for (const ConvexPiece& piece : shape.pieces)
    for (const Vec3& point : piece.points)
      for (const double side : {-piece.radius, piece.radius}) box.add(point + Vec3::Constant(side));
  return box;
}

}  // namespace

double least_length(const SceneInstrument& s) {
  switch (s.kind) {
    case InstrumentKind::scalpel:
      return 2 * s.blade_length;
    case InstrumentKind::scissors:
      return s.blade_length + 4 * s.radius;
    case InstrumentKind::grasper:
      return grasper_jaw + 4 * s.radius;
    default:
      return 4 * s.radius;
  }
}

Tool make_tool(const SceneInstrument& instrument, const TriangleMesh& mesh, double edge_spacing) {
  SceneInstrument s = instrument;
  s.length = std::max(s.length, least_length(s));
  Tool tool{.kind = s.kind, .name = s.name, .path = ToolPath(s.path), .keys = s.path};
  if (s.kind == InstrumentKind::probe) make_probe(tool, s);
  if (s.kind == InstrumentKind::scalpel) make_scalpel(tool, s, edge_spacing);
  if (s.kind == InstrumentKind::grasper) make_grasper(tool, s);
  if (s.kind == InstrumentKind::scissors) make_scissors(tool, s, edge_spacing);
  if (!mesh.X.empty()) use_mesh(tool, mesh);
  tool.box = box_round(tool.shape);
  return tool;
}

double jaw_opening(const Tool& tool, double time) {
  double opening = 1;
  for (const InstrumentKey& key : tool.keys) {
    if (key.action == GraspAction::none || key.time - jaw_time > time) continue;
    // The jaws meet at the key.
    const double done = std::min(1.0, (time - key.time + jaw_time) / jaw_time);
    opening =
        key.action == GraspAction::close ? std::min(opening, 1 - done) : std::max(opening, done);
  }
  return opening;
}

Pose part_pose(const Tool& tool, const ToolPart& part, double time) {
  Pose pose = tool.path.at(time);
  if (part.jaw == 0) return pose;
  const double angle = -part.jaw * jaw_angle *
                       (tool.closed_share + (1 - tool.closed_share) * jaw_opening(tool, time));
  const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  const Vec3 hinge(0, 0, tool.hinge_height);
  pose.translation = pose.apply(hinge - turn * hinge);
  pose.rotation = pose.rotation * turn;
  return pose;
}

bool is_cutting(const Tool& tool, double t0, double t1) {
  return tool.kind == InstrumentKind::scalpel ||
         (tool.kind == InstrumentKind::scissors && jaw_opening(tool, t1) < jaw_opening(tool, t0));
}

std::vector<Vec3> cutting_edge(const Tool& tool, double time) {
  const Pose pose = tool.path.at(time);
  std::vector<Vec3> edge;
  if (tool.kind == InstrumentKind::scissors) {
    const double way = first_crossing + (1 - first_crossing) * (1 - jaw_opening(tool, time));
    const Vec3 hinge(0, 0, tool.hinge_height);
    for (const Vec3& point : tool.edge) edge.push_back(pose.apply(hinge + way * (point - hinge)));
  } else {
    for (const Vec3& point : tool.edge) edge.push_back(pose.apply(point));
  }
  return edge;
}

}  // namespace trocar
