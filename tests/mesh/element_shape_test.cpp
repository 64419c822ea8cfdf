#include "mesh/element_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "mesh_fixtures.h"

using namespace trocar;

static Mesh reference_element(ElementType type) {
  if (type == ElementType::hex8) return single_element(type, unit_cube_corners());
  std::vector<Vec3> X = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  if (type == ElementType::tet4) X.emplace_back(0, 0, 1);
  return single_element(type, X);
}

// Area vector of a facet; in 2D the edge turned by -90 degrees.
static Vec3 facet_normal(const Mesh& mesh, const std::array<int, 4>& corner) {
  const Vec3 &a = mesh.X[corner[0]], &b = mesh.X[corner[1]];
  if (corner[2] < 0) return {(b - a).y(), -(b - a).x(), 0};
  return (b - a).cross(mesh.X[corner[2]] - a);
}

TEST(FacetCorners, normals_of_all_element_types_point_outward) {
  for (const ElementType type : {ElementType::tri3, ElementType::tet4, ElementType::hex8}) {
    const Mesh mesh = reference_element(type);
    for (int f = 0; f < n_facets(type); ++f) {
      const std::array<int, 4> corner = facet_corners(type, f);
      const Vec3 outward = mesh.X[corner[0]] - element_centre(mesh, 0);
      EXPECT_GT(facet_normal(mesh, corner).dot(outward), 0) << element_type_name(type) << " " << f;
    }
  }
}

TEST(FacetCorners, of_simplices_leave_out_the_opposite_corner) {
  for (const ElementType type : {ElementType::tri3, ElementType::tet4})
    for (int f = 0; f < n_facets(type); ++f)
      for (const int corner : facet_corners(type, f)) EXPECT_NE(corner, f);
}

// Each edge is a side of two facets; a triangle's facets are its edges, there and back.
TEST(EdgeCorners, are_the_sides_of_the_facets_each_once) {
  for (const ElementType type : {ElementType::tri3, ElementType::tet4, ElementType::hex8}) {
    std::map<std::pair<int, int>, int> sides;
    for (int f = 0; f < n_facets(type); ++f) {
      const std::array<int, 4> corner = facet_corners(type, f);
      const std::size_t n =
          static_cast<std::size_t>(std::ranges::count_if(corner, [](int a) { return a >= 0; }));
      for (std::size_t k = 0; k < n; ++k) ++sides[std::minmax({corner[k], corner[(k + 1) % n]})];
    }
    std::map<std::pair<int, int>, int> edges;
    for (const auto& [a, b] : edge_corners(type)) edges[std::minmax({a, b})] += 2;
    EXPECT_EQ(edges, sides) << element_type_name(type);
  }
}
