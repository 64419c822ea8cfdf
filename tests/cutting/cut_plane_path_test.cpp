// Ends on the boundary, polylines, cuts in pieces and cuts that cross.
#include "cutting/cut_plane_path.h"

#include "cutting_plane.h"
#include "larger_or_nan.h"

namespace trocar {
namespace {

int n_open_ends(const Mesh& before, const PlaneCut& result) {
  const Mesh after = applied(result.edit, before);
  return after.n_nodes() - before.n_nodes() - (result.figures.n_opened_facets - 1);
}

TEST(CutPlanePath, end_on_the_boundary_opens_it) {
  const Mesh mesh = paper_mesh(2);
  const std::vector<Vec3> inner = {{20 * mm, 20 * mm, 0}, {50 * mm, 22 * mm, 0}};
  const std::vector<Vec3> from_side = {{0, 20 * mm, 0}, {30 * mm, 22 * mm, 0}};
  const std::vector<Vec3> from_beyond = {{-9 * mm, 20 * mm, 0}, {30 * mm, 22 * mm, 0}};
  const std::vector<Vec3> through = {{-9 * mm, 20 * mm, 0}, {90 * mm, 22 * mm, 0}};
  EXPECT_EQ(n_open_ends(mesh, cut(mesh, inner)), 0);
  EXPECT_EQ(n_open_ends(mesh, cut(mesh, from_side)), 1);
  EXPECT_EQ(n_open_ends(mesh, cut(mesh, from_beyond)), 1);
  EXPECT_EQ(n_open_ends(mesh, cut(mesh, through)), 2);
  EXPECT_GE(cut(mesh, from_side).tip, 0);
  EXPECT_EQ(cut(mesh, through).tip, -1);
}

// Straight sides keep the area exactly: boundary nodes slide along them and corners stay.
TEST(CutPlanePath, through_cut_keeps_the_outline) {
  const Mesh mesh = paper_mesh(1);
  const Mesh after = applied(cut(mesh, {{33 * mm, -1 * mm, 0}, {40 * mm, 41 * mm, 0}}).edit, mesh);
  EXPECT_NEAR(total_volume(after) / total_volume(mesh), 1, 1e-14);
  EXPECT_EQ(n_pieces(after), 2);
}

// The path lies outside in the middle, so two chains open, each with one end on the notch.
TEST(CutPlanePath, path_that_leaves_and_enters_again_cuts_both_parts) {
  const Mesh mesh = paper_mesh(2);
  Mesh notched = mesh;
  notched.element_type.clear();
  notched.corner_offset.clear();
  notched.corner_node.clear();
  notched.element_region.clear();
  notched.density_factor.clear();
  notched.cut_facets.clear();
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const int column = e / 2 % 19, row = e / 2 / 19;  // of the element's cell
    const bool is_removed = column >= 8 && column < 11 && row < 8;
    if (!is_removed) add_element(notched, ElementType::tri3, mesh.corners(e));
  }
  ASSERT_TRUE(has_closed_boundary(notched));
  const PlaneCut result = cut(notched, {{8 * mm, 9 * mm, 0}, {62 * mm, 11 * mm, 0}});
  const Mesh after = applied(result.edit, notched);
  // Two chains of n1 and n2 edges with one closed end each give n1 + n2 new nodes.
  EXPECT_EQ(after.n_nodes() - notched.n_nodes(), result.figures.n_opened_facets);
  EXPECT_TRUE(has_closed_boundary(after));
  EXPECT_EQ(n_pieces(after), 1);
}

// A path that goes on outside of the body from where a cut has opened its outline: nothing is left
// joined there. And one that may grow waits where a boundary lies less than 1.5 h ahead of it.
TEST(CutPlanePath, cuts_and_refuses_nothing_beyond_the_outline_nor_near_before_it) {
  const Mesh mesh = paper_mesh(2);
  for (const double start : {39.99, 40.0, 40.01}) {
    const PlaneCut beyond = cut(mesh, {{30 * mm, start * mm, 0}, {31 * mm, 52 * mm, 0}});
    EXPECT_TRUE(beyond.edit.is_empty()) << start;
    EXPECT_EQ(beyond.figures.n_refused, 0) << start;
  }
  const std::vector<std::uint8_t> is_held(mesh.X.size(), 0);
  CutPlaneOptions growing;
  growing.room_ahead = 1.5;
  const auto is_cut = [&](double end) {
    const std::vector<Vec3> path = {{30 * mm, 12 * mm, 0}, {31 * mm, end * mm, 0}};
    return !cut_plane(mesh, path, -1, {is_held}, growing).edit.is_empty();
  };
  EXPECT_TRUE(is_cut(30));   // 3 h before it
  EXPECT_FALSE(is_cut(37));  // 0.9 h
  EXPECT_TRUE(is_cut(41));   // through it
}

// A leg that ends up to a quarter of an edge behind a slit, then the next one.
TEST(CutPlanePath, end_close_behind_an_older_cut_is_cut_with_what_follows) {
  const Vec3 left(-1 * mm, 20 * mm, 0), right(80 * mm, 21 * mm, 0);
  const Mesh mesh = paper_mesh(2);
  const Mesh slit = applied(cut(mesh, {left, right}).edit, mesh);
  ASSERT_EQ(n_pieces(slit), 2);
  const auto above_slit = [&](const Vec3& p) {
    return (right - left).normalized().cross(p - left).z();
  };
  for (const double x : {25.0, 30.0, 31.0, 32.0})
    for (const double behind : {0.05, 0.3, 0.7}) {
      const Vec3 from(x * mm, -1 * mm, 0), to((x + 4) * mm, 41 * mm, 0);
      const double above = above_slit(to), below = above_slit(from);
      const Vec3 end = from + (to - from) * (behind * mm - below) / (above - below);
      const PlaneCut lower = cut(slit, {from, end});
      ASSERT_EQ(lower.rest.size(), 2U) << x << " " << behind;
      EXPECT_NEAR(above_slit(lower.rest.front()), 0, 1e-15);  // rounding of some 50 mm
      EXPECT_LT((lower.rest.back() - end).norm(), 1e-15);
      const Mesh half = applied(lower.edit, slit);
      EXPECT_EQ(n_pieces(half), 3) << x << " " << behind;
      const PlaneCut upper = cut(half, {lower.rest.front(), end, to});
      EXPECT_EQ(upper.figures.n_refused, 0) << x << " " << behind;
      EXPECT_EQ(n_pieces(applied(upper.edit, half)), 4) << x << " " << behind;
    }
}

TEST(CutPlanePath, cut_nodes_follow_a_polyline) {
  const Mesh mesh = paper_mesh(2);
  const std::vector<Vec3> path = {
      {15 * mm, 12 * mm, 0}, {30 * mm, 28 * mm, 0}, {45 * mm, 14 * mm, 0}, {58 * mm, 26 * mm, 0}};
  const PlaneCut result = cut(mesh, path);
  const Mesh after = applied(result.edit, mesh);
  ASSERT_GT(result.figures.n_opened_facets, 10);
  EXPECT_EQ(after.n_nodes() - mesh.n_nodes(), result.figures.n_opened_facets - 1);
  EXPECT_TRUE(validate(after).empty());
  for (const std::int32_t i : result.edit.duplicate_parent) {
    double least = 1;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      const Vec3 d = path[k + 1] - path[k];
      const double t = std::clamp((after.X[i] - path[k]).dot(d) / d.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (after.X[i] - path[k] - t * d).norm());
    }
    EXPECT_LT(least, 1e-15);  // a rounding of coordinates of some 50 mm
  }
}

// Cuts along the points one after another, each from the tip of the one before.
Mesh cut_in_pieces(Mesh mesh, const std::vector<Vec3>& points, int& n_opened) {
  std::int32_t tip = -1;
  n_opened = 0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const Vec3 start = tip >= 0 ? mesh.X[tip] : points[k];
    const PlaneCut result = cut(mesh, {start, points[k + 1]}, tip);
    EXPECT_EQ(result.figures.n_refused, 0) << "piece " << k;
    for (const NodeMove& move : result.edit.moves) EXPECT_NE(move.node, tip);
    mesh = applied(result.edit, mesh);
    n_opened += result.figures.n_opened_facets;
    EXPECT_TRUE(validate(mesh).empty()) << "piece " << k;
    tip = result.tip;
  }
  return mesh;
}

std::vector<Vec3> points_between(const Vec3& a, const Vec3& b, int n) {
  std::vector<Vec3> points;
  for (int k = 0; k <= n; ++k) points.push_back(a + (b - a) * (static_cast<double>(k) / n));
  return points;
}

TEST(CutPlanePath, cut_in_pieces_is_one_chain_through_the_body) {
  for (int c = 1; c <= 4; ++c)
    for (const int n : {3, 5}) {
      SCOPED_TRACE(c * 10 + n);
      const Mesh mesh = paper_mesh(c);
      int n_opened = 0;
      const Mesh after = cut_in_pieces(
          mesh, points_between({-1 * mm, 17 * mm, 0}, {71 * mm, 24 * mm, 0}, n), n_opened);
      EXPECT_EQ(n_pieces(after), 2);
      EXPECT_EQ(after.n_nodes() - mesh.n_nodes(), n_opened + 1);
      bool are_on_boundary = false;
      EXPECT_EQ(n_marked_sides(after, are_on_boundary), 2 * n_opened);
      EXPECT_TRUE(are_on_boundary);
      EXPECT_TRUE(has_closed_boundary(after));
      EXPECT_GT(least_altitude(after) / least_altitude(mesh), 0.4);
    }
}

// Pieces so short that each opens one edge: the first opens an edge between two tips, which must
// separate when the second one goes on.
TEST(CutPlanePath, pieces_of_one_edge_join_up) {
  const Mesh mesh = paper_mesh(2);
  int n_opened = 0;
  const Mesh after = cut_in_pieces(
      mesh, points_between({20 * mm, 17 * mm, 0}, {44 * mm, 21 * mm, 0}, 8), n_opened);
  EXPECT_GE(n_opened, 8);
  EXPECT_EQ(after.n_nodes() - mesh.n_nodes(), n_opened - 1);
  bool are_on_boundary = false;
  EXPECT_EQ(n_marked_sides(after, are_on_boundary), 2 * n_opened);
  EXPECT_TRUE(are_on_boundary);
}

TEST(CutPlanePath, crossing_through_cuts_give_four_pieces) {
  for (int c = 1; c <= 4; ++c) {
    SCOPED_TRACE(c);
    const Mesh mesh = paper_mesh(c);
    const Mesh once = applied(cut(mesh, {{31 * mm, -1 * mm, 0}, {38 * mm, 50 * mm, 0}}).edit, mesh);
    const PlaneCut second = cut(once, {{-1 * mm, 17 * mm, 0}, {71 * mm, 23 * mm, 0}});
    EXPECT_EQ(second.figures.n_refused, 0);
    const Mesh twice = applied(second.edit, once);
    EXPECT_EQ(n_pieces(twice), 4);
    EXPECT_TRUE(validate(twice).empty());
    EXPECT_NEAR(total_mass(twice) / total_mass(mesh), 1, 1e-12);
  }
}

SubPath bent_path() {
  return make_sub_path({Vec2(0, 0), Vec2(3, 0), Vec2(3, 4)});
}

TEST(CutPlanePath, position_is_by_arc_length) {
  EXPECT_EQ(bent_path().length(), 7);
  EXPECT_EQ(position(bent_path(), 2), Vec2(2, 0));
  EXPECT_EQ(position(bent_path(), 5), Vec2(3, 2));
  EXPECT_EQ(tangent(bent_path(), 5), Vec2(0, 1));
}

TEST(CutPlanePath, moved_end_bends_only_the_last_reach) {
  const SubPath path = with_ends(bent_path(), Vec2(0, 0), Vec2(4, 4), 1);
  ASSERT_EQ(path.point.size(), 4u);
  EXPECT_EQ(path.point[2], Vec2(3, 3));
  EXPECT_EQ(path.point[3], Vec2(4, 4));
  EXPECT_EQ(distance_to(bent_path(), path.point[3]), 1);
}

// The side of configuration 3 is a zigzag of sharp corners, into which both ends bend.
TEST(CutPlanePath, deviation_of_ends_bent_into_corners_is_reported) {
  const Mesh mesh = paper_mesh(3);
  const PlaneCut result = cut(mesh, {{-1 * mm, 17 * mm, 0}, {71 * mm, 17 * mm, 0}});
  const Mesh after = applied(result.edit, mesh);
  double largest = 0;
  for (const std::int32_t i : result.edit.duplicate_parent)
    largest = larger_or_nan(largest, std::abs(after.X[i].y() - 17 * mm));
  EXPECT_GT(largest, 1 * mm);
  EXPECT_NEAR(result.figures.largest_deviation, largest, 1e-15);
}

TEST(CutPlanePath, trimmed_path_keeps_its_bends) {
  const SubPath path = trimmed(bent_path(), 1, 6);
  ASSERT_EQ(path.point.size(), 3u);
  EXPECT_EQ(path.point[0], Vec2(1, 0));
  EXPECT_EQ(path.point[1], Vec2(3, 0));
  EXPECT_EQ(path.point[2], Vec2(3, 3));
}

}  // namespace
}  // namespace trocar
