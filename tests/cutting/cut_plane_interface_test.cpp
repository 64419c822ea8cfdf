// Plane cuts beside, along and across the line between two regions. TROCAR_CUTS sets another number
// of random ones per mesh.
#include <cstdio>

#include "cutting_count.h"
#include "cutting_plane.h"

namespace trocar {
namespace {

constexpr int interface_row = 7;

double row_height(const Mesh& mesh) {
  double top = 0;
  for (const Vec3& X : mesh.X) top = std::max(top, X.y());
  return top / 15;
}

// Configurations 2 and 4 have 16 rows of nodes.
Mesh layered_plate(int configuration) {
  Mesh mesh = paper_mesh(configuration);
  const double y = interface_row * row_height(mesh);
  mesh.region_name = {"lower", "upper"};
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const auto c = mesh.corners(e);
    const double middle = (mesh.X[c[0]].y() + mesh.X[c[1]].y() + mesh.X[c[2]].y()) / 3;
    mesh.element_region[e] = middle > y ? 1 : 0;
  }
  return mesh;
}

std::array<double, 2> region_areas(const Mesh& mesh) {
  std::array<double, 2> area{};
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    area[std::size_t(mesh.element_region[e])] += element_volume(mesh, e, mesh.X);
  return area;
}

struct RegionCount {
  int n_cut = 0, n_whole = 0, n_places = 0;  // whole: nothing was refused
  double step = 1, deviation = 0;
};

// The areas of both regions change by rounding alone.
Mesh cut_regions_and_check(const Mesh& mesh, const std::vector<Vec3>& path, RegionCount& count) {
  const double floor = plane_step_ratio * least_step_bound(mesh);
  const PlaneCut result = cut_plane(mesh, path, -1, {none_held(mesh)}, {.least_step = floor});
  count.n_places += result.figures.n_refused;
  count.n_whole += result.figures.n_refused == 0 ? 1 : 0;
  EXPECT_TRUE(!result.edit.is_empty() || result.figures.n_refused > 0);
  if (result.edit.is_empty()) return mesh;
  ++count.n_cut;
  const Mesh after = applied(result.edit, mesh);
  EXPECT_TRUE(validate(after).empty());
  EXPECT_TRUE(has_closed_boundary(after));
  for (std::size_t r = 0; r < 2; ++r)
    EXPECT_NEAR(region_areas(after)[r] / region_areas(mesh)[r], 1, 1e-12);
  EXPECT_GE(least_step_bound(after), floor * (1 - 1e-12));
  count.step = std::min(count.step, least_step_bound(after) / least_step_bound(mesh));
  count.deviation =
      std::max(count.deviation, result.figures.largest_deviation / result.figures.mean_edge);
  return after;
}

const int n_cuts_across = n_cuts_or(200);

double uniform(std::mt19937& random, double a, double b) {
  return a + (b - a) * (random() / 4294967296.0);
}

void print(const char* kind, int configuration, const RegionCount& count) {
  std::printf(
      "%s, configuration %d: %d cut, %d without a refused place, %d places; least step %.2f, "
      "largest deviation %.2f\n",
      kind, configuration, count.n_cut, count.n_whole, count.n_places, count.step, count.deviation);
}

TEST(CutPlaneInterface, keeps_both_regions_when_a_cut_passes_beside_it) {
  for (const int c : {2, 4}) {
    const Mesh mesh = layered_plate(c);
    RegionCount count;
    for (int k = -18; k <= 18; ++k) {
      const double y = (interface_row + 0.05 * k) * row_height(mesh);
      cut_regions_and_check(mesh, {{20 * mm, y, 0}, {50 * mm, y, 0}}, count);
    }
    print("beside", c, count);
    EXPECT_EQ(count.n_cut, 37);
    // 0.55 rows beside it there is no room for elements, and it is too far to go to it.
    EXPECT_GE(count.n_whole, 36);
  }
}

TEST(CutPlaneInterface, is_opened_by_a_cut_along_it) {
  for (const int c : {2, 4}) {
    const Mesh mesh = layered_plate(c);
    const double y = interface_row * row_height(mesh);
    const PlaneCut through =
        cut_plane(mesh, std::vector<Vec3>{{-mm, y, 0}, {71 * mm, y, 0}}, -1, {none_held(mesh)}, {});
    EXPECT_EQ(through.figures.n_refused, 0);
    EXPECT_LT(through.figures.largest_deviation, 1e-12);
    const Mesh after = applied(through.edit, mesh);
    EXPECT_EQ(n_pieces(after), 2);
    for (std::size_t r = 0; r < 2; ++r)
      EXPECT_NEAR(region_areas(after)[r] / region_areas(mesh)[r], 1, 1e-12);
  }
}

TEST(CutPlaneInterface, keeps_both_regions_when_through_cuts_cross_it) {
  for (const int c : {2, 4}) {
    const Mesh mesh = layered_plate(c);
    std::mt19937 random(5);
    RegionCount count;
    int n_apart = 0;
    for (int k = 0; k < n_cuts_across; ++k) {
      const std::vector<Vec3> path = {{uniform(random, 12, 58) * mm, -mm, 0},
                                      {uniform(random, 12, 58) * mm, 16 * row_height(mesh), 0}};
      n_apart += n_pieces(cut_regions_and_check(mesh, path, count)) == 2 ? 1 : 0;
    }
    print("through", c, count);
    EXPECT_EQ(n_apart, n_cuts_across);
  }
}

TEST(CutPlaneInterface, keeps_both_regions_when_cuts_inside_cross_it) {
  for (const int c : {2, 4}) {
    const Mesh mesh = layered_plate(c);
    const double top = 15 * row_height(mesh);
    std::mt19937 random(6);
    RegionCount count;
    for (int k = 0; k < n_cuts_across; ++k) {
      std::vector<Vec3> path(2);
      do
        for (Vec3& p : path)
          p = {uniform(random, 10 * mm, 60 * mm), uniform(random, 10 * mm, top - 10 * mm), 0};
      while ((path[1] - path[0]).norm() < 12 * mm);
      cut_regions_and_check(mesh, path, count);
    }
    print("inside", c, count);
    EXPECT_EQ(count.n_cut, n_cuts_across);
  }
}

// Of the outline's lower side as far as x = 35 mm or a node before it.
TEST(CutPlaneBorder, of_a_part_of_the_outline_stays_where_it_is) {
  const Mesh mesh = paper_mesh(2);
  std::int32_t end = -1;
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (mesh.X[i].y() == 0 && mesh.X[i].x() < 35 * mm &&
        (end < 0 || mesh.X[i].x() > mesh.X[end].x()))
      end = i;
  const std::vector<BorderEdge> border{{end, end}};
  const std::vector<std::uint8_t> held = none_held(mesh);
  for (const double beside : {-2.0, -1.2, -0.5, 0.5, 1.2, 2.0}) {
    const double x = mesh.X[end].x() + beside * mm;
    const PlaneCut result =
        cut_plane(mesh, std::vector<Vec3>{{x, -mm, 0}, {x, 20 * mm, 0}}, -1, {held, border}, {});
    EXPECT_FALSE(result.edit.is_empty());
    for (const NodeMove& move : result.edit.moves) EXPECT_NE(move.node, end) << beside;
  }
}

}  // namespace
}  // namespace trocar
