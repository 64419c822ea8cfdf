// The subdivision that the paper compares itself with.
#include "cutting/cut_plane_subdivide.h"

#include <bit>

#include "base/error.h"
#include "cutting_plane.h"

namespace trocar {
namespace {

// Number of edges between different elements that the line from a to b crosses within its length,
// by brute force over all pairs; each of n such crossings is followed by one more split triangle.
int n_crossed_edges(const Mesh& mesh, const Vec3& a, const Vec3& b) {
  const FacetNeighbours across = facet_neighbours(mesh);
  const auto side = [](const Vec3& p, const Vec3& q, const Vec3& X) {
    return (q - p).cross(X - p).z() > 0;
  };
  int n = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      if (across.of(e, f) < e) continue;
      const Vec3 &u = mesh.X[mesh.corners(e)[(f + 1) % 3]],
                 &v = mesh.X[mesh.corners(e)[(f + 2) % 3]];
      if (side(a, b, u) != side(a, b, v) && side(u, v, a) != side(u, v, b)) ++n;
    }
  return n;
}

// n crossings between the tips: n + 1 triangles are split into 3, along n + 2 nodes of which the
// two outermost are not doubled.
TEST(Subdivision, inner_cut_adds_two_elements_a_triangle_and_doubles_inner_nodes) {
  for (int c = 1; c <= 4; ++c) {
    const Mesh mesh = paper_mesh(c);
    const std::vector<Vec3> path = paper_cut(c);
    const int n = n_crossed_edges(mesh, path[0], path[1]);
    const Mesh after = subdivide_along(mesh, path[0], path[1]);
    EXPECT_EQ(after.n_elements() - mesh.n_elements(), 2 * (n + 1)) << c;
    EXPECT_EQ(after.n_nodes() - mesh.n_nodes(), 2 * (n + 2) - 2) << c;
  }
}

TEST(Subdivision, keeps_area_and_orientation) {
  for (int c = 1; c <= 6; ++c) {
    const Mesh mesh = paper_mesh(c);
    const Mesh after = subdivide_along(mesh, paper_cut(c)[0], paper_cut(c)[1]);
    EXPECT_NEAR(total_volume(after) / total_volume(mesh), 1, 1e-13) << c;  // sums of some hundred
    for (std::int32_t e = 0; e < after.n_elements(); ++e)
      EXPECT_GT(element_volume(after, e, after.X), 0) << c;
  }
}

TEST(Subdivision, through_cut_gives_two_valid_pieces) {
  const Mesh mesh = paper_mesh(2);
  const Mesh after = subdivide_along(mesh, {-1 * mm, 13.1 * mm, 0}, {71 * mm, 22.3 * mm, 0});
  EXPECT_EQ(n_pieces(after), 2);
  EXPECT_TRUE(validate(after).empty());
  EXPECT_TRUE(has_closed_boundary(after));
  bool are_on_boundary = false;
  EXPECT_GT(n_marked_sides(after, are_on_boundary), 0);
  EXPECT_TRUE(are_on_boundary);
}

TEST(Subdivision, keeps_the_lips_of_earlier_cuts) {
  const Mesh mesh = paper_mesh(2);
  const auto lips = [](const Mesh& cut) {
    int n = 0;
    for (const std::uint8_t facets : cut.cut_facets) n += std::popcount(facets);
    return n;
  };
  const Mesh along = subdivide_along(mesh, {-1 * mm, 20.3 * mm, 0}, {71 * mm, 22 * mm, 0});
  const Mesh across = subdivide_along(mesh, {30 * mm, -1 * mm, 0}, {38 * mm, 41 * mm, 0});
  const Mesh both = subdivide_along(along, {30 * mm, -1 * mm, 0}, {38 * mm, 41 * mm, 0});
  // Where they cross lips are split, and triangles of the first cut are halves.
  EXPECT_GE(lips(both), lips(along) + lips(across));
  EXPECT_LE(lips(both), lips(along) + lips(across) + 12);
  bool are_on_boundary = false;
  EXPECT_GT(n_marked_sides(both, are_on_boundary), 0);
  EXPECT_TRUE(are_on_boundary);
}

// The cut runs along a row of nodes and would make triangles of no area.
TEST(Subdivision, cut_through_nodes_inverts_nothing) {
  const Mesh mesh = make_rectangle(8 * mm, 8 * mm, 9, 9);
  const Mesh after = subdivide_along(mesh, {1.5 * mm, 4 * mm, 0}, {6.5 * mm, 4 * mm, 0});
  EXPECT_GT(after.n_elements(), mesh.n_elements());
  for (std::int32_t e = 0; e < after.n_elements(); ++e)
    EXPECT_GT(element_volume(after, e, after.X), 0);
}

TEST(Subdivision, other_elements_than_triangles_are_an_input_error) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::hex8);
  EXPECT_THROW(subdivide_along(mesh, Vec3::Zero(), Vec3::Ones()), InputError);
}

}  // namespace
}  // namespace trocar
