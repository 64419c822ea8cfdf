// The path of a plane cut: arc length, and the pieces of it that lie inside the body.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "cutting/cut_plane_patch.h"

namespace trocar {

// A piece of the path inside the body. Ends on the boundary know the facet they lie on.
struct SubPath {
  std::vector<Vec2> point;      // (>= 2)
  std::vector<double> s;        // (n_points) arc length from the start [m]
  PatchFacet start_on, end_on;  // element -1: inside the body
  int tip = -1;                 // node that the sub-path continues from

  double length() const { return s.back(); }
};
SubPath make_sub_path(std::vector<Vec2> point);
Vec2 position(const SubPath& path, double s);
// Unit tangent; at a bend that of the segment after it.
Vec2 tangent(const SubPath& path, double s);
SubPath trimmed(const SubPath& path, double from, double to);

// Arc length of the point nearest to p.
double nearest_on(const SubPath& path, const Vec2& p);
double distance_to(const SubPath& path, const Vec2& p);
// The path with other ends: where an end moves, the last `reach` of the path bends towards it.
SubPath with_ends(const SubPath& path, const Vec2& start, const Vec2& end, double reach);

// Pieces between crossings of the boundary, in order. Faces of older cuts are boundary too,
// although they have no width. Ends within 0.1 h of the boundary lie on it; pieces shorter than
// 0.3 h are left out. `tip` (local node or -1): where the path continues an older cut.
struct ClippedPath {
  std::vector<SubPath> pieces;
  double rest = -1;              // arc length where a last piece begins that was left out; -1: none
  std::vector<double> left_out;  // middles of other ones that the cut would have to part
};
ClippedPath clip_to_body(const PlanePatch& patch, const SubPath& path, int tip);
// Whether no boundary lies ahead of its end, if that is inside, nearer than `room` (in h).
bool has_room_ahead(const PlanePatch& patch, const SubPath& path, double room);

// Leaves out where the paths run through elements with n_corners or more that are held, and half a
// mean edge around: with three, none could be displaced onto the cut. Returns the middles of the
// stretches that are left out.
std::vector<Vec2> leave_out_held(const PlanePatch& patch, int n_corners,
                                 std::vector<SubPath>& paths);

// Leaves out half a mean edge on both sides of where the path that comes nearest passes a point;
// what would be shorter than an edge then, too.
void leave_out_near(const PlanePatch& patch, const Vec2& point, std::vector<SubPath>& paths);

// Draws ends inside the body back along the path until they are 0.4 h away from the boundary: a tip
// nearer than that leaves no room for the elements between. Never below half the length.
void draw_back_ends(const PlanePatch& patch, SubPath& path);

}  // namespace trocar
