// Points of the tissue: where they go with it, on either side of a cut.
#include "engine/markers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "engine/equilibrium.h"
#include "engine_scene.h"
#include "engine_split.h"
#include "engine_started.h"
#include "largest.h"
#include "mesh/connected_nodes.h"

namespace trocar {
namespace {

std::string stretched_bar(const std::string& elements, const std::string& markers) {
  return "[time]\nduration = 1\nframe_rate = 100\n[start]\nstate = \"equilibrium\"\n"
         "tolerance = 1e-9\n[tissue.shape]\nkind = \"box\"\nlow = [-0.01, -0.01, 0]\n"
         "high = [0.01, 0.01, 0.05]\ncells = [3, 2, 5]\nelements = \"" +
         elements +
         "\"\n[tissue.material]\nmodel = \"linear\"\nyoung_modulus = 6000\npoisson_ratio = 0\n"
         "[[support]]\nregion = \"z-\"\n[[support]]\nregion = \"z+\"\n"
         "path = [{ time = 0, displacement = [0, 0, 0.002] }]\n"
         "[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\n" +
         markers;
}

std::string marker(const std::string& name, const Vec3& at) {
  return "[[marker]]\nname = \"" + name + "\"\nposition = [" + std::to_string(at.x()) + ", " +
         std::to_string(at.y()) + ", " + std::to_string(at.z()) + "]\n";
}

TEST(Markers, go_with_the_tissue_of_a_stretched_bar) {
  const std::vector<Vec3> X = {
      {0.0031, -0.0022, 0.0137}, {-0.01, 0.01, 0.05}, {0, 0, 0.02}, {0.009, 0.001, 0.0415}};
  std::string markers;
  for (std::size_t k = 0; k < X.size(); ++k) markers += marker(std::to_string(k), X[k]);
  for (const std::string elements : {"hex8", "tet4-kuhn"}) {
    const auto bar = built(stretched_bar(elements, markers));
    start_in_equilibrium(bar->loaded, *bar->s);
    run_frame(*bar->s, bar->outputs);
    const std::vector<Vec3>& x = bar->s->log.rows.back().markers;
    ASSERT_EQ(x.size(), X.size());
    for (std::size_t k = 0; k < X.size(); ++k)
      EXPECT_LT((x[k] - Vec3(X[k].x(), X[k].y(), 1.04 * X[k].z())).norm(), 1e-9) << elements << k;
  }
}

// The blade goes through z = 15 mm, 18 degrees off the level; the body is stretched as it cuts.
TEST(Markers, stay_where_they_are_beside_a_cut_that_moves_nodes_and_follow_their_side) {
  std::string markers;
  int n = 0;
  for (const double z : {0.012, 0.0144, 0.0156, 0.018})
    for (const double y : {-0.007, 0., 0.004}) {
      markers += marker(std::to_string(n), Vec3(0.001 * n - 0.006, y, z));
      ++n;
    }
  for (const std::string elements : {"hex8", "tet4-five"}) {
    const auto bar = built(stretched_bar(elements, markers));
    start_in_equilibrium(bar->loaded, *bar->s);
    Simulation& s = *bar->s;
    const auto positions = [&] {
      return marker_positions(s.markers, s.mesh, s.part, s.state.u, *s.communicator);
    };
    const std::vector<Vec3> before = positions();
    GlobalState global = gather_state(s);
    CutFigures figures;
    CutRecord record;
    apply_cut(s, cut_across(s, global, figures), global, record);
    EXPECT_GT(figures.n_moved, 0);
    const std::vector<Vec3> after = positions();
    EXPECT_LT(largest_difference(after, before), 1e-9) << elements;
    // The lower part is moved away: those below the blade go with it, the others stay.
    const Vec3 away(0, 0, -0.1);
    std::vector<std::int32_t> all(s.mesh.element_type.size());
    std::iota(all.begin(), all.end(), 0);
    const std::vector<std::int32_t> piece = connected_nodes(s.mesh, all);
    const NodeSet& lower = *find_node_set(s.mesh, "z-");
    for (std::size_t i = 0; i < s.mesh.X.size(); ++i)
      if (piece[i] == piece[lower.node[0]])
        for (int j = 0; j < 3; ++j) s.state.u[3 * i + static_cast<std::size_t>(j)] += away[j];
    const std::vector<Vec3> moved = positions();
    for (std::size_t k = 0; k < before.size(); ++k) {
      const Vec3 way = moved[k] - after[k];
      EXPECT_TRUE(way.norm() < 1e-12 || (way - away).norm() < 1e-12) << elements << " " << k;
    }
    EXPECT_LT((moved.front() - after.front() - away).norm(), 1e-12);
    EXPECT_LT((moved.back() - after.back()).norm(), 1e-12);
  }
}

std::string ball_text(const std::string& markers) {
  return "[time]\nduration = 1\nframe_rate = 100\n[tissue.shape]\nkind = \"ball\"\n"
         "centre = [0, 0, 0.015]\nradius = 0.015\ncells = [6, 6, 6]\nelements = \"hex8\"\n"
         "[tissue.material]\nyoung_modulus = 6000\n"
         "[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\n" +
         markers;
}

// Nodes of the surface slide on it: some markers, 10 um deep in the middle of triangles, then lie
// outside all elements. The body is at rest.
TEST(Markers, stay_on_a_curved_surface_whose_nodes_a_cut_moves) {
  std::string markers;
  std::vector<Vec3> X;
  const auto plain = built(ball_text(""));
  const Mesh& uncut = plain->s->mesh;
  const Vec3 centre(0, 0, 0.015);
  for (const std::array<std::int32_t, 3>& triangle : plain->s->surface.triangle) {
    const Vec3 middle = (uncut.X[triangle[0]] + uncut.X[triangle[1]] + uncut.X[triangle[2]]) / 3;
    X.push_back(middle - 1e-5 * (middle - centre).normalized());
    markers += marker(std::to_string(X.size()), X.back());
  }
  const auto ball = built(ball_text(markers));
  Simulation& s = *ball->s;
  GlobalState global = gather_state(s);
  CutFigures figures;
  CutRecord record;
  apply_cut(s, cut_across(s, global, figures), global, record);
  EXPECT_GT(figures.n_moved, 0);
  const auto is_outside = [](const Location& location) { return location.element < 0; };
  EXPECT_TRUE(std::ranges::any_of(locate_markers(s.scene.markers, s.mesh), is_outside));
  const std::vector<Vec3> x =
      marker_positions(s.markers, s.mesh, s.part, s.state.u, *s.communicator);
  EXPECT_LT(largest_difference(x, X), 1e-6);
}

// Of a plate that bends, on either side of the blade.
TEST(Markers, stay_where_they_are_in_elements_that_are_split_and_follow_their_side) {
  std::string markers;
  std::vector<bool> is_above;
  for (int k = 0; k < 24; ++k) {
    is_above.push_back(k % 2 == 1);
    markers += marker(std::to_string(k), Vec3(0.004 * (k % 6) - 0.011, 0.006 * (k / 6) - 0.008,
                                              is_above.back() ? 0.0039 : 0.0006));
  }
  const auto plate = built(plate_of("tet4-five") + "[[support]]\nregion = \"x+\"\n" + markers +
                           "[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\n");
  Simulation& s = *plate->s;
  while (s.frame < 5) run_frame(s, plate->outputs);
  const auto positions = [&] {
    return marker_positions(s.markers, s.mesh, s.part, s.state.u, *s.communicator);
  };
  const std::vector<Vec3> before = positions();
  const PlateSplit done = split_plate(s);
  ASSERT_EQ(s.n_pieces, 2);
  EXPECT_GT(done.n_inserted, 300);
  const std::vector<Vec3> after = positions();
  // Elements bend: nodes that move smooth that.
  EXPECT_LT(largest_difference(after, before), 1e-5);
  const std::vector<std::int32_t> piece = connected_nodes(s.mesh);
  const auto side_of = [&](std::size_t k) {
    return piece[s.mesh.corners(s.markers[k].element)[0]];
  };
  EXPECT_NE(side_of(0), side_of(1));
  for (std::size_t k = 2; k < before.size(); ++k) EXPECT_EQ(side_of(k), side_of(k % 2)) << k;
}

TEST(Markers, are_refused_outside_the_body_and_by_the_same_name) {
  const auto error = [](const std::string& markers) {
    return error_of([&] { built(stretched_bar("hex8", markers)); });
  };
  EXPECT_NE(error(marker("m", Vec3(0, 0, 0.06)))
                .find("marker[0].position: marker \"m\" lies outside the undeformed body"),
            std::string::npos);
  EXPECT_NE(error(marker("m", Vec3(0, 0, 0.01)) + marker("m", Vec3(0, 0, 0.02)))
                .find("marker[1].name: two markers are called \"m\""),
            std::string::npos);
}

}  // namespace
}  // namespace trocar
