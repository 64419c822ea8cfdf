#include "collision/detector.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/check.h"
#include "base/error.h"
#include "base/sort_unique.h"
#include "collision/narrow_phase.h"
#include "collision/plane_contact.h"
#include "collision/surface_tree.h"

namespace trocar {

namespace {

constexpr double squarely = 0.3;  // cosine at which tissue faces a blade's flank

bool is_of_flank(const PieceCore& core, const Vec3& local_normal) {
  return std::abs(local_normal.y()) >= core.least_flatness;
}

// Whether a piece may touch with this normal: a blade with its flat sides, not with its edge.
bool is_flat_enough(const PieceCore& core, const Vec3& local_normal, double gap) {
  return is_of_flank(core, local_normal) && gap >= -core.deepest;
}

// Of a point inside a blade, from the flank that `facing` looks against, in the tool's frame. None
// is zero: at the front of a wound tissue faces neither.
SignedDistance distance_from_flank(const PieceCore& core, const Vec3& x, const Vec3& facing) {
  for (std::size_t k = 0; k < core.faces.normal.size(); ++k) {
    const Vec3& n = core.faces.normal[k];
    if (is_of_flank(core, n) && n.dot(facing) < -squarely * facing.norm())
      return SignedDistance{.normal = n, .gap = n.dot(x) - core.faces.offset[k] - core.radius};
  }
  return {};
}

// Not of a blade: that touches with its flanks, which edges find.
std::optional<NodeTouch> touch_in_plane(const PieceCore& core, const Vec3& x, const Pose& pose,
                                        double margin) {
  if (core.least_flatness > 0) return std::nullopt;
  const SignedDistance found = signed_distance(plane_section(core, pose), x);
  if (!(found.gap < margin)) return std::nullopt;
  return NodeTouch{.normal = found.normal, .gap = found.gap};
}

// Of a point in the tool's frame: between the sides of a blade that don't touch.
bool is_in_outline(const PieceCore& core, const Vec3& x) {
  for (std::size_t k = 0; k < core.faces.normal.size(); ++k) {
    const Vec3& n = core.faces.normal[k];
    if (!is_of_flank(core, n) && n.dot(x) - core.faces.offset[k] >= core.radius) return false;
  }
  return true;
}

// Whether the blade passes through a facet, or is about to where it has an edge: that is cut, and
// no flank presses on it. Pushed aside, a face at a flat angle to the blade took the cut with it.
bool is_pierced(const PieceCore& core, const Triangle& local) {
  const auto [low, high] = std::minmax({local[0].y(), local[1].y(), local[2].y()});
  if (low >= -core.thickness / 2 || high <= core.thickness / 2) return false;
  Segment in_plane = {local[0], local[0]};
  std::size_t n = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3 &from = local[a], &to = local[(a + 1) % 3];
    if ((from.y() > 0) != (to.y() > 0) && n < 2)
      in_plane[n++] = point_at({from, to}, from.y() / (from.y() - to.y()));
  }
  SegmentPart part;
  for (std::size_t k = 0; k < core.faces.normal.size(); ++k) {
    const Vec3& normal = core.faces.normal[k];
    const bool is_edge = core.has_edge && normal.x() > 0.5;
    if (!is_of_flank(core, normal) && !is_edge &&
        !clip_segment(in_plane, core.faces.offset[k] * normal, -normal, part))
      return false;
  }
  return true;
}

// A piece in its pose, and everything that is the same for all its candidates.
struct PosedPiece {
  const PieceCore& core;
  const Pose& pose;
  Mat3 rotation;
  Vec3 translation;
  double margin;
  Contact label;  // tool and piece

  Vec3 to_world(const Vec3& local) const { return rotation * local + translation; }
  Vec3 to_tool(const Vec3& world) const { return rotation.transpose() * (world - translation); }
};

// Is this triangle the way out of the tissue for a point behind it? Asked for many triangles with
// the same point in turn (a sphere's centre), so the last answer is kept.
class WayOut {
 public:
  explicit WayOut(const SurfaceTree& tree) : tree_(tree) {}

  bool is_through(const Vec3& p, double reach, const Vec3& normal) {
    if (!is_known_ || p != p_) find(p, reach);
    return way_out_.dot(normal) > 0;
  }

 private:
  void find(const Vec3& p, double reach) {
    is_known_ = true;
    p_ = p;
    way_out_.setZero();
    if (tree_.winding_number(p) <= 0) return;
    // The triangle asked for lies within reach, so there is a nearest one.
    const std::int32_t t = tree_.nearest_exit(p, reach * (1 + 1e-6));
    if (t >= 0) way_out_ = unit_normal(tree_.corners(t)).value_or(Vec3::Zero());
  }

  const SurfaceTree& tree_;
  bool is_known_ = false;
  Vec3 p_ = Vec3::Zero(), way_out_ = Vec3::Zero();
};

void check_piece(const ConvexPiece& piece, std::size_t tool, std::size_t number) {
  const std::string name =
      "piece " + std::to_string(number) + " of instrument " + std::to_string(tool);
  if (piece.points.empty())
    throw InputError(name + " has no points: a sphere needs one, a capsule two, a hull more");
  if (!(piece.radius >= 0) || !std::isfinite(piece.radius))
    throw InputError(name + " has radius " + std::to_string(piece.radius) +
                     " m: it must be zero or more, and finite");
  for (const Vec3& p : piece.points)
    if (!p.allFinite()) throw InputError(name + " has a point that is not finite");
}

// Boxes round the candidates of a piece. A long segment gets several, since one box round a
// slanted shaft would hold half of the surface.
std::vector<Box> search_boxes(const PosedPiece& piece) {
  const double reach = depth_limit(piece.core, piece.margin);
  const std::vector<Vec3>& points = piece.core.points;
  std::size_t n = 1;
  if (points.size() == 2 && reach > 0)
    n = static_cast<std::size_t>(
        std::clamp(std::ceil((points[1] - points[0]).norm() / (2 * reach)), 1.0, 32.0));
  std::vector<Box> boxes(n);
  for (std::size_t k = 0; k < n; ++k) {
    if (n == 1) {
      for (const Vec3& p : points) boxes[k].add(piece.to_world(p));
    } else {
      for (const std::size_t end : {k, k + 1})
        boxes[k].add(piece.to_world(
            point_at({points[0], points[1]}, static_cast<double>(end) / static_cast<double>(n))));
    }
    boxes[k] = boxes[k].grown(reach);
  }
  return boxes;
}

void take(const Touch& found, Contact& contact) {
  contact.weight = found.tissue.weight;
  contact.point = found.tissue.point - found.gap * found.normal;
  contact.normal = found.normal;
  contact.gap = found.gap;
}

// From a touch in the plane of the mesh to the tool's frame.
void take_plane(const Touch& found, const Pose& pose, Contact& contact) {
  take(found, contact);
  contact.point = pose.apply_inverse(contact.point);
  contact.normal = pose.rotation.conjugate() * contact.normal;
}

Contact make_contact(const PosedPiece& piece, const std::array<std::int32_t, 3>& node,
                     const Touch& touch) {
  Contact contact = piece.label;
  contact.node = node;
  take(touch, contact);
  return contact;
}

}  // namespace

struct ContactDetector::State {
  std::vector<std::vector<PieceCore>> tools;
  std::vector<std::array<std::int32_t, 3>> triangle;
  PlaneEdges plane;
  std::optional<SurfaceTree> tree;  // of the present topology, once detect has seen positions
  std::vector<std::int32_t> candidates, box_candidates;

  void find_candidates(const PosedPiece& piece);
  void touch_surface(const PosedPiece& piece, std::vector<Contact>& contacts);
  void touch_plane(const PosedPiece& piece, std::span<const Vec3> x,
                   std::vector<Contact>& contacts) const;
  const PieceCore& core_of(const Contact& contact) const {
    return tools[contact.tool][contact.piece];
  }
};

void ContactDetector::State::find_candidates(const PosedPiece& piece) {
  candidates.clear();
  for (const Box& box : search_boxes(piece)) {
    tree->overlapping(box, box_candidates);
    candidates.insert(candidates.end(), box_candidates.begin(), box_candidates.end());
  }
  sort_unique(candidates);
}

void ContactDetector::State::touch_surface(const PosedPiece& piece,
                                           std::vector<Contact>& contacts) {
  find_candidates(piece);
  WayOut way_out(*tree);
  for (const std::int32_t t : candidates) {
    const Triangle world = tree->corners(t);
    const Triangle local = {piece.to_tool(world[0]), piece.to_tool(world[1]),
                            piece.to_tool(world[2])};
    const std::optional<Touch> found = touch(piece.core, local, piece.margin);
    if (!found) continue;
    if (found->depth > 0) {
      const double reach = (found->tissue.point - found->core).norm();
      const Vec3 normal = unit_normal(world).value_or(Vec3::Zero());
      if (!way_out.is_through(piece.to_world(found->core), reach, normal)) continue;
    }
    contacts.push_back(make_contact(piece, tree->nodes(t), *found));
    contacts.back().triangle = t;
  }
}

void ContactDetector::State::touch_plane(const PosedPiece& piece, std::span<const Vec3> x,
                                         std::vector<Contact>& contacts) const {
  const PlaneSection section = plane_section(piece.core, piece.pose);
  if (section.points.empty()) return;
  for (std::size_t k = 0; k < plane.node.size(); ++k) {
    const auto [a, b] = plane.node[k];
    const Segment edge = {x[a], x[b]};
    const std::optional<Touch> found = touch_edge(section, edge, piece.margin);
    if (!found) continue;
    if (found->depth > 0) {
      const Vec3 d = edge[1] - edge[0];
      if (plane_way_out(plane, x, found->core).dot(Vec3(d.y(), -d.x(), 0)) <= 0) continue;
    }
    contacts.push_back(piece.label);
    Contact& contact = contacts.back();
    contact.node = {a, b, b};
    contact.triangle = plane.triangle[k];
    take_plane(*found, piece.pose, contact);
  }
}

ContactDetector::ContactDetector(std::vector<ToolShape> tools) : state_(std::make_unique<State>()) {
  for (std::size_t k = 0; k < tools.size(); ++k) {
    std::vector<PieceCore>& cores = state_->tools.emplace_back();
    for (std::size_t j = 0; j < tools[k].pieces.size(); ++j) {
      check_piece(tools[k].pieces[j], k, j);
      cores.push_back(make_core(tools[k].pieces[j]));
    }
  }
}

ContactDetector::~ContactDetector() = default;
ContactDetector::ContactDetector(ContactDetector&&) noexcept = default;
ContactDetector& ContactDetector::operator=(ContactDetector&&) noexcept = default;

void ContactDetector::set_surface(const Surface& surface) {
  set_closed_surface(surface);
  state_->plane = boundary_edges(surface);
}

void ContactDetector::set_closed_surface(const Surface& surface) {
  state_->triangle = surface.triangle;
  state_->plane = {};
  state_->tree.reset();
}

void ContactDetector::refit(std::span<const Vec3> x) {
  if (state_->tree) {
    state_->tree->refit(x);
  } else {
    state_->tree.emplace(state_->triangle, x);
  }
}

void ContactDetector::detect(std::span<const Vec3> x, std::span<const Pose> pose,
                             std::span<const double> margin, std::vector<Contact>& contacts) {
  CHECK_OP(pose.size(), ==, state_->tools.size());
  CHECK_OP(margin.size(), ==, state_->tools.size());
  contacts.clear();
  const bool is_plane = !state_->plane.node.empty();
  if (!is_plane) refit(x);
  for (std::size_t k = 0; k < pose.size(); ++k) {
    for (std::size_t j = 0; j < state_->tools[k].size(); ++j) {
      const PosedPiece piece{
          .core = state_->tools[k][j],
          .pose = pose[k],
          .rotation = pose[k].rotation.toRotationMatrix(),
          .translation = pose[k].translation,
          .margin = margin[k],
          .label = {.tool = static_cast<std::int32_t>(k), .piece = static_cast<std::int32_t>(j)}};
      if (is_plane) {
        state_->touch_plane(piece, x, contacts);
      } else {
        state_->touch_surface(piece, contacts);
      }
    }
  }
}

void ContactDetector::detect_tissue(std::span<const Vec3> ahead, double reach,
                                    std::vector<TissuePair>& pairs) const {
  pairs.clear();
  if (state_->tree) find_tissue_pairs(*state_->tree, ahead, reach, pairs);
}

bool ContactDetector::lies_in_other_tissue(std::int32_t node) const {
  constexpr double inward = 1e-3;  // of the size of the node's triangles
  Vec3 outward = Vec3::Zero();
  for (std::size_t t = 0; t < state_->triangle.size(); ++t) {
    if (!std::ranges::count(state_->triangle[t], node)) continue;
    outward += area_normal(state_->tree->corners(static_cast<std::int32_t>(t)));
  }
  if (outward.isZero(0)) return false;
  const Vec3 below = inward / std::sqrt(outward.norm()) * outward;
  return state_->tree->winding_number(state_->tree->position(node) - below) > 1;
}

bool ContactDetector::update(const Corners& corners, const Pose& pose, double margin,
                             Contact& contact) const {
  const PieceCore& core = state_->core_of(contact);
  if (state_->plane.node.empty()) {
    if (is_blade(contact) && is_pierced(core, corners.local)) return false;
    const std::optional<Touch> found = touch(core, corners.local, margin);
    if (!found) return false;
    take(*found, contact);
  } else {
    const std::optional<Touch> found =
        touch_edge(plane_section(core, pose), {corners.x[0], corners.x[1]}, margin);
    if (!found) return false;
    take_plane(*found, pose, contact);
  }
  return is_flat_enough(core, contact.normal, contact.gap);
}

Manifold ContactDetector::manifold(const Corners& corners, double margin,
                                   const Contact& contact) const {
  if (is_blade(contact) || !state_->plane.node.empty()) return {};
  return find_manifold(state_->core_of(contact), corners.local, contact.gap, margin);
}

std::optional<NodeTouch> ContactDetector::touch_node(const Contact& contact,
                                                     const SurfaceNode& node, const Pose& pose,
                                                     double margin) const {
  const PieceCore& core = state_->core_of(contact);
  if (!state_->plane.node.empty()) return touch_in_plane(core, node.x, pose, margin);
  const Vec3 x = pose.apply_inverse(node.x);
  SignedDistance found = signed_distance(core, x);
  if (core.least_flatness > 0 && found.gap < 0)
    found = distance_from_flank(core, x, pose.rotation.conjugate() * node.facing);
  if (!(found.gap < margin) || !is_flat_enough(core, found.normal, found.gap)) return std::nullopt;
  return NodeTouch{.normal = pose.rotation * found.normal, .gap = found.gap};
}

bool ContactDetector::is_inside(const Contact& contact, const Vec3& local) const {
  const PieceCore& core = state_->core_of(contact);
  if (!is_blade(contact)) return signed_distance(core, local).gap < 0;
  return contact.normal.dot(local - contact.point) < 0 && is_in_outline(core, local);
}

bool ContactDetector::is_blade(const Contact& contact) const {
  return state_->core_of(contact).least_flatness > 0;
}

bool ContactDetector::is_hull(const Contact& contact) const {
  return state_->core_of(contact).hull.has_value();
}

double ContactDetector::radius(const Contact& contact) const {
  return state_->core_of(contact).radius;
}

}  // namespace trocar
