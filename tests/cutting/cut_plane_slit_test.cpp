#include "cutting/cut_plane_slit.h"

#include "cutting_plane.h"

namespace trocar {
namespace {

// Configuration 2, 70 x 40 mm, edges of 3.2 mm in the mean, with a slit from below to its middle.
struct SlitPlate {
  Mesh mesh = paper_mesh(2);
  double h = 3.2 * mm;
  std::int32_t tip = -1;

  SlitPlate() {
    const PlaneCut slit = cut(mesh, {{33 * mm, -1 * mm, 0}, {33 * mm, 20 * mm, 0}});
    tip = slit.tip;
    mesh = applied(slit.edit, mesh);
  }
  PathFromSlit past(const std::vector<Vec3>& path, std::int32_t from = -1) const {
    return past_slit(mesh, path, from, h);
  }
};

TEST(CutPlaneSlit, path_along_it_begins_at_its_tip) {
  const SlitPlate plate;
  const Vec3 end(33.4 * mm, 30 * mm, 0);
  for (const Vec3& from : {Vec3(33 * mm, 5 * mm, 0), Vec3(33.7 * mm, -8 * mm, 0)}) {
    const PathFromSlit rest = plate.past({from, end});
    EXPECT_EQ(rest.tip, plate.tip);
    ASSERT_EQ(rest.point.size(), 2u);
    EXPECT_EQ(rest.point[0], plate.mesh.X[plate.tip]);
    EXPECT_EQ(rest.point[1], end);
  }
}

TEST(CutPlaneSlit, path_that_stays_in_it_leaves_nothing_to_cut) {
  const SlitPlate plate;
  const Vec3 tip = plate.mesh.X[plate.tip];
  const PathFromSlit rest = plate.past({tip, {33 * mm, 6 * mm, 0}}, plate.tip);  // back in it
  EXPECT_EQ(rest.tip, -1);
  ASSERT_EQ(rest.point.size(), 1u);
  EXPECT_LT((rest.point[0] - Vec3(33 * mm, 6 * mm, 0)).norm(), 0.01 * plate.h);
}

TEST(CutPlaneSlit, path_that_leaves_it_through_a_lip_begins_there) {
  const SlitPlate plate;
  const PathFromSlit rest =
      plate.past({{33 * mm, 4 * mm, 0}, {33 * mm, 12 * mm, 0}, {50 * mm, 14 * mm, 0}});
  EXPECT_EQ(rest.tip, -1);
  ASSERT_EQ(rest.point.size(), 3u);
  EXPECT_NEAR(rest.point[0].x(), 33 * mm, 0.01 * plate.h);
  EXPECT_NEAR(rest.point[0].y(), 12 * mm, 0.11 * plate.h);
}

// From a lip, to which the part before it was taken, or from the tip that another blade has left.
TEST(CutPlaneSlit, path_that_turns_into_it_leaves_nothing_to_cut) {
  SlitPlate plate;
  const Vec3 beside(33.8 * mm, 6 * mm, 0), on(33.8 * mm, 12 * mm, 0);
  EXPECT_EQ(plate.past({{33 * mm, 5 * mm, 0}, beside, on}).point.size(), 1u);
  const Vec3 passed = plate.mesh.X[plate.tip];
  const Vec3 end(33 * mm, 32 * mm, 0);
  const PlaneCut further = cut(plate.mesh, {passed, end}, plate.tip);
  plate.mesh = applied(further.edit, plate.mesh);
  const PathFromSlit rest = plate.past(
      {passed, {33.7 * mm, passed.y() + 0.8 * mm, 0}, {33.7 * mm, 36 * mm, 0}}, plate.tip);
  EXPECT_EQ(rest.tip, further.tip);
  EXPECT_EQ(rest.point.size(), 2u);
}

// As where the blade pushes the tissue to and fro.
TEST(CutPlaneSlit, path_that_wavers_in_it_leaves_nothing_to_cut) {
  const SlitPlate plate;
  std::vector<Vec3> path;
  for (int k = 0; k < 20; ++k)
    path.emplace_back((33.3 + (k % 2 == 0 ? 0.2 : -0.2)) * mm, (3 + 0.8 * k) * mm, 0);
  EXPECT_EQ(plate.past(path).point.size(), 1u);
}

TEST(CutPlaneSlit, other_paths_stay_what_they_are) {
  const SlitPlate plate;
  const Vec3 tip = plate.mesh.X[plate.tip];
  const auto stays = [&](const std::vector<Vec3>& path, std::int32_t from) {
    const PathFromSlit rest = plate.past(path, from);
    EXPECT_EQ(rest.point, path);
    EXPECT_EQ(rest.tip, from);
  };
  stays({tip, {33 * mm, 30 * mm, 0}}, plate.tip);             // goes on
  stays({tip, {50 * mm, 25 * mm, 0}}, plate.tip);             // turns aside
  stays({{-5 * mm, 9 * mm, 0}, {80 * mm, 11 * mm, 0}}, -1);   // crosses
  stays({{35 * mm, -5 * mm, 0}, {35 * mm, 45 * mm, 0}}, -1);  // 0.6 h beside
  stays({{33 * mm, 24 * mm, 0}, {33 * mm, 45 * mm, 0}}, -1);  // begins beyond
  const Mesh whole = paper_mesh(2);
  const std::vector<Vec3> path = {{0, 0, 0}, {9 * mm, 9 * mm, 0}};
  EXPECT_EQ(past_slit(whole, path, -1, plate.h).point, path);
}

}  // namespace
}  // namespace trocar
