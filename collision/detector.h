// Where instruments touch tissue. A flat bounding-volume tree over the surface triangles finds the
// candidates; points and segments are tested in closed form, hulls by Bullet (hull_bullet.h). No
// answer depends on an earlier one.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "collision/hull_manifold.h"
#include "collision/tissue_pairs.h"
#include "collision/tool_shape.h"
#include "mesh/facets.h"

namespace trocar {

// A triangle of tissue near a convex piece of a tool. Point and normal move with the tool between
// two detections: gap(t) = normal·(sum weight x - point).
// On a plane mesh a boundary edge of the triangle: node[2] == node[1] and weight[2] == 0.
struct Contact {
  std::int32_t tool = 0;
  std::int32_t piece = 0;
  std::int32_t triangle = 0;           // index into Surface::triangle
  std::array<std::int32_t, 3> node{};  // global numbers
  std::array<double, 3> weight{};      // of the nearest point on the triangle, sum 1
  Vec3 point = Vec3::Zero();           // nearest point on the tool, in the tool's frame [m]
  Vec3 normal = Vec3::Zero();          // from tool to tissue, unit, in the tool's frame
  double gap = 0;                      // at detection; negative: penetration [m]
};

// A node inside a piece, or beside it within the margin. normal: out of the piece, in the world's
// frame; gap: negative inside [m].
struct NodeTouch {
  Vec3 normal = Vec3::Zero();
  double gap = 0;
};

class ContactDetector {
 public:
  // Throws InputError for a piece without points, with a negative radius or a value not finite.
  explicit ContactDetector(std::vector<ToolShape> tools);
  ~ContactDetector();
  ContactDetector(ContactDetector&&) noexcept;
  ContactDetector& operator=(ContactDetector&&) noexcept;

  // New topology. Call after each cut, then detect, which builds the tree. A surface with boundary
  // edges is that of a plane mesh (tri3 in z = 0): then tools touch its boundary edges with the
  // section that z = 0 cuts out of them (plane_contact.h).
  void set_surface(const Surface& surface);
  // The same of a body's surface, which has no such edges to look for.
  void set_closed_surface(const Surface& surface);

  // New positions (n_nodes), valid at surface nodes. Not of plane meshes.
  void refit(std::span<const Vec3> x);

  // All (tool piece, triangle) pairs nearer than margin[tool], in ascending (tool, piece,
  // triangle): the same on every rank. x (n_nodes) global positions, valid at surface nodes; pose
  // and margin (n_tools).
  //
  // Direction: from tool to tissue where the core of the piece sees the triangle's outer side. A
  // core that has passed the triangle pushes it back along its inward normal (narrow_phase.h says
  // how), but only from inside the tissue and towards its nearest way out: the far side of a thin
  // lobe does not touch. A core deeper than depth_limit has lost the surface and touches nothing.
  void detect(std::span<const Vec3> x, std::span<const Pose> pose, std::span<const double> margin,
              std::vector<Contact>& contacts);

  // The pairs of tissue and tissue at the positions of the last detect or refit
  // (find_tissue_pairs). Not of plane meshes, which have none.
  void detect_tissue(std::span<const Vec3> ahead, double reach,
                     std::vector<TissuePair>& pairs) const;

  // Of a surface node at these positions: of overlapping tissue the surface winds twice round it.
  bool lies_in_other_tissue(std::int32_t node) const;

  // A contact found by detect, a little later: weights, point, normal and gap anew, for its corners
  // and the pose of its tool. False where the gap is `margin` or more, or only the edge of a blade
  // touches. A core that was in front of the triangle may have passed it since.
  struct Corners {
    std::array<Vec3, 3> x, local;  // in the world and in the tool's frame [m]
  };
  bool update(const Corners& corners, const Pose& pose, double margin, Contact& contact) const;
  // Of a contact as updated: where else it touches. Nothing of blades, and on plane meshes.
  Manifold manifold(const Corners& corners, double margin, const Contact& contact) const;
  // Where a node lies in the contact's piece, nothing where its gap is `margin` or more. Of a hull:
  // the nearest of its faces, of a blade the flank that the tissue faces: nodes of both lips of a
  // fresh wound lie in the middle of it. On plane meshes of what z = 0 cuts out of the
  // piece, and nothing of blades.
  struct SurfaceNode {
    Vec3 x, facing;  // facing: out of the tissue, of any length
  };
  std::optional<NodeTouch> touch_node(const Contact& contact, const SurfaceNode& node,
                                      const Pose& pose, double margin) const;
  // Of a point in the tool's frame: inside the contact's piece. A blade, which held tissue may lie
  // across, counts as if it filled all that is behind the flank that touches.
  bool is_inside(const Contact& contact, const Vec3& local) const;
  bool is_hull(const Contact& contact) const;
  // Of the contact's piece: a sphere's, a capsule's, or by which a hull is thickened [m]
  double radius(const Contact& contact) const;
  bool is_blade(const Contact& contact) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace trocar
