#include "engine/locate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "mesh/element_boxes.h"
#include "mesh_fixtures.h"

namespace trocar {
namespace {

std::vector<NamedMesh> simplex_meshes() {
  std::vector<NamedMesh> meshes = plane_meshes();
  meshes.push_back({"Kuhn ball", make_ball(Vec3(0.01, 0, 0), 0.1, 6, BoxElements::tet4_kuhn)});
  meshes.push_back({"five box", make_box(Vec3(0, 0, 0), Vec3(0.1, 0.2, 0.1), {3, 3, 2},
                                         BoxElements::tet4_five)});
  for (NamedMesh& named : meshes) jitter(named.mesh, 0.1, 3);
  return meshes;
}

// Positive weights that sum to 1.
std::vector<double> random_weights(std::mt19937& random, std::size_t n) {
  std::uniform_real_distribution<double> unit(0.05, 1);
  std::vector<double> weight(n);
  double sum = 0;
  for (double& w : weight) sum += w = unit(random);
  for (double& w : weight) w /= sum;
  return weight;
}

Vec3 blend(const Mesh& mesh, std::int32_t e, const std::vector<double>& weight) {
  Vec3 point = Vec3::Zero();
  for (std::size_t a = 0; a < weight.size(); ++a) point += weight[a] * mesh.X[mesh.corners(e)[a]];
  return point;
}

Location locate(const Mesh& mesh, const Vec3& point) {
  return locate_points(mesh, mesh.X, std::span(&point, 1))[0];
}

TEST(Locate, finds_the_elements_and_the_weights_of_inner_points) {
  std::mt19937 random(1);
  for (const NamedMesh& named : simplex_meshes()) {
    const Mesh& mesh = named.mesh;
    std::vector<std::vector<double>> weight;
    std::vector<Vec3> point;
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
      weight.push_back(random_weights(random, mesh.corners(e).size()));
      point.push_back(blend(mesh, e, weight.back()));
    }
    const std::vector<Location> found = locate_points(mesh, mesh.X, point);
    for (std::size_t e = 0; e < point.size(); ++e) {
      ASSERT_EQ(found[e].element, e) << named.name;
      // Rounding errors grow with the condition of the element, below 1e3 here.
      for (std::size_t a = 0; a < weight[e].size(); ++a)
        EXPECT_NEAR(found[e].weight[a], weight[e][a], 1e-12) << named.name;
    }
  }
}

TEST(Locate, gives_a_node_to_the_lowest_of_its_elements) {
  for (const NamedMesh& named : simplex_meshes()) {
    const NodeElements around = node_elements(named.mesh);
    for (std::int32_t i = 0; i < named.mesh.n_nodes(); ++i)
      EXPECT_EQ(locate(named.mesh, named.mesh.X[i]).element, around.of(i)[0]) << named.name << i;
  }
}

TEST(Locate, says_that_a_point_lies_outside) {
  for (const NamedMesh& named : simplex_meshes())
    EXPECT_EQ(locate(named.mesh, Vec3(5, 5, 0)).element, -1) << named.name;
}

TEST(Locate, looks_in_the_positions_that_it_is_given) {
  const Mesh mesh = make_rectangle(0.07, 0.04, 5, 4);
  std::vector<Vec3> x = mesh.X;
  for (Vec3& point : x) point += Vec3(1, 2, 0);
  const std::array points{Vec3(0.03, 0.02, 0), Vec3(1.03, 2.02, 0)};
  const std::vector<Location> found = locate_points(mesh, x, points);
  EXPECT_EQ(found[0].element, -1);
  EXPECT_EQ(found[1].element, locate(mesh, Vec3(0.03, 0.02, 0)).element);
}

// Within the reach of the boxes and far beyond it.
TEST(Locate, finds_the_same_by_boxes_as_without_them) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.1, 0.2);
  for (const NamedMesh& named : all_meshes()) {
    const Mesh& mesh = named.mesh;
    const ElementBoxes boxes = make_element_boxes(mesh, mesh.X);
    for (const double strain : {0.0, 0.1, -0.05, 3.0}) {
      std::vector<Vec3> x = mesh.X, points = mesh.X;
      for (Vec3& point : x) point += strain * Vec3(point.y(), point.x(), 0);
      points.insert(points.end(), x.begin(), x.end());
      const double way = largest_way(x, boxes);
      for (int k = 0; k < 100; ++k) points.emplace_back(place(random), place(random), 0);
      for (std::size_t k = 0; k < points.size(); k += 7) {
        const std::span some =
            std::span(points).subspan(k, std::min<std::size_t>(3, points.size() - k));
        const std::vector<Location> expected = locate_points(mesh, x, some);
        const std::vector<Location> found =
            locate_points(mesh, x, some, elements_near(box_around(some), way, boxes));
        for (std::size_t j = 0; j < some.size(); ++j) {
          EXPECT_EQ(found[j].element, expected[j].element) << named.name;
          EXPECT_EQ(found[j].weight, expected[j].weight) << named.name;
        }
      }
    }
  }
}

TEST(LocateNearest, agrees_with_locate_inside) {
  std::mt19937 random(2);
  for (const NamedMesh& named : simplex_meshes())
    for (std::int32_t e = 0; e < named.mesh.n_elements(); e += 3) {
      const Vec3 point = blend(named.mesh, e, random_weights(random, named.mesh.corners(e).size()));
      EXPECT_EQ(locate_nearest(named.mesh, named.mesh.X, point).element, e) << named.name;
    }
}

TEST(LocateNearest, extrapolates_outside_exactly_for_linear_fields) {
  const auto linear = [](const Vec3& x) {
    return Vec3(1 + x.x() - 2 * x.y(), 3 * x.y(), x.x() + x.z());
  };
  for (const NamedMesh& named : simplex_meshes()) {
    const Mesh& mesh = named.mesh;
    std::vector<Vec3> field;
    for (const Vec3& X : mesh.X) field.push_back(linear(X));
    const double z = mesh.dimension() == 2 ? 0 : 0.05;
    for (const Vec3& point : {Vec3(-0.05, 0.01, z), Vec3(0.2, 0.3, z), Vec3(0.03, 0.02, z)}) {
      const Location found = locate_nearest(mesh, mesh.X, point);
      ASSERT_GE(found.element, 0);
      // Barycentric coordinates are affine; weights of a few tens magnify roundings of 1e-15.
      EXPECT_LT((interpolate(mesh, found, field) - linear(point)).norm(), 1e-12) << named.name;
    }
  }
}

double length_of(const std::vector<SegmentPiece>& pieces) {
  double length = 0;
  for (const SegmentPiece& piece : pieces) length += piece.length;
  return length;
}

std::vector<SegmentPiece> located(const Mesh& mesh, const std::array<Vec3, 2>& segment) {
  std::vector<std::int32_t> all(static_cast<std::size_t>(mesh.n_elements()));
  std::iota(all.begin(), all.end(), 0);
  return locate_segment(mesh, mesh.X, segment, all);
}

// By the closed form of a box: a vertical segment that ends above it is inside by its depth. On
// planes and edges of the grid, too, where elements share it.
TEST(LocateSegment, is_as_long_as_the_segment_is_deep_in_a_box) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(0.1, 0.1, 0.1), {5, 5, 5}, elements);
    for (const double x : {0.033, 0.04, 0.1})
      for (const double y : {0.051, 0.06, 0.0})
        for (const double depth : {0.0, 0.003, 0.02, 0.0777})
          EXPECT_NEAR(length_of(located(mesh, {Vec3(x, y, 0.1 - depth), Vec3(x, y, 0.15)})), depth,
                      1e-10)
              << x << " " << y << " " << depth;
  }
}

// The pieces are in the elements that hold their middles, and a segment within a convex body has
// all of its length.
TEST(LocateSegment, pieces_lie_in_their_elements_and_make_up_an_inner_segment) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0.021, 0.079);
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(0.1, 0.1, 0.1), {4, 4, 4}, BoxElements::tet4_five);
  jitter(mesh, 0.1, 3);
  for (int k = 0; k < 100; ++k) {
    const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    const std::array<Vec3, 2> segment = {point(), point()};
    const double length = (segment[1] - segment[0]).norm();
    const std::vector<SegmentPiece> pieces = located(mesh, segment);
    EXPECT_NEAR(length_of(pieces), length, 1e-9 * length);
    double done = 0;
    for (const SegmentPiece& piece : pieces) {
      const Vec3 middle =
          segment[0] + (done + piece.length / 2) / length * (segment[1] - segment[0]);
      EXPECT_LT((interpolate(mesh, piece.middle, mesh.X) - middle).norm(), 1e-11);
      EXPECT_GE(*std::min_element(piece.middle.weight.begin(), piece.middle.weight.begin() + 4),
                -1e-11);
      done += piece.length;
    }
  }
}

}  // namespace
}  // namespace trocar
