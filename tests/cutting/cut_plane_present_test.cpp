#include "cutting/cut_plane_present.h"

#include "cutting_plane.h"
#include "mesh/node_corners.h"

namespace trocar {
namespace {

constexpr double collapsed = 0.013;  // least present area over reference area

double ratio(const Mesh& mesh, const std::vector<Vec3>& x, std::int32_t e) {
  return element_volume(mesh, e, x) / element_volume(mesh, e, mesh.X);
}

// Nodes displaced at random by up to an edge as long as no element is left less than that.
std::vector<Vec3> crumpled(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double a) { return a * (2 * (random() / 4294967296.0) - 1); };
  const NodeCorners corners = node_corners(mesh);
  std::vector<Vec3> x = mesh.X;
  for (int sweep = 0; sweep < 20; ++sweep)
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3 before = x[i];
      x[i] += Vec3(uniform(2 * mm), uniform(2 * mm), 0);
      for (std::int32_t k = corners.first[i]; k >= 0; k = corners.next[k])
        if (ratio(mesh, x, corners.element[k]) < collapsed) x[i] = before;
    }
  return x;
}

std::vector<Vec3> positions_after(const Mesh& mesh, const Mesh& after, const MeshEdit& edit,
                                  const std::vector<Vec3>& x) {
  std::vector<double> u;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int k = 0; k < 3; ++k) u.push_back(x[i][k] - mesh.X[i][k]);
  apply_edit(edit, mesh, 3, u);
  std::vector<Vec3> result = after.X;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += Vec3::Map(&u[3 * i]);
  return result;
}

// Where tissue stays joined for that it is told.
TEST(CutPlanePresent, cuts_of_a_nearly_collapsed_plate_invert_nothing) {
  int n_opened = 0, n_crushed = 0, n_inverted = 0;
  for (const int configuration : {2, 4})
    for (unsigned seed = 0; seed < 60; ++seed) {
      const Mesh mesh = paper_mesh(configuration);
      const std::vector<Vec3> x = crumpled(mesh, seed);
      std::mt19937 random(seed);
      const auto within = [&](double a, double b) {
        return a + (b - a) * (random() / 4294967296.0);
      };
      const std::vector<Vec3> path{{within(10, 30) * mm, within(-2, 30) * mm, 0},
                                   {within(40, 60) * mm, within(10, 50) * mm, 0}};
      const PlaneCut cut = cut_plane(mesh, path, -1, {none_held(mesh), {}, x}, {});
      n_opened += cut.figures.n_opened_facets;
      for (const CutRefusal& refusal : cut.figures.refusals)
        n_crushed += refusal.reason == CutRefusal::crushed ? 1 : 0;
      if (cut.edit.is_empty()) continue;
      const Mesh after = applied(cut.edit, mesh);
      const std::vector<Vec3> y = positions_after(mesh, after, cut.edit, x);
      for (std::int32_t e = 0; e < after.n_elements(); ++e)
        n_inverted += ratio(after, y, e) <= 0 ? 1 : 0;
    }
  EXPECT_EQ(n_inverted, 0);
  EXPECT_GT(n_opened, 700);  // 1,288 where nothing is looked at, and 422 elements inverted
  EXPECT_GT(n_crushed, 0);
}

}  // namespace
}  // namespace trocar
