#include "cutting/cut_near.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"
#include "known_positions.h"
#include "mesh_joined.h"

namespace trocar {
namespace {

using namespace cutting_test;

// Two blocks side by side with a gap: a body whose surface a band enters several times.
Mesh two_blocks() {
  Mesh mesh = joined(make_box({0, 0, 0}, {1, 1, 1}, {6, 6, 6}, BoxElements::tet4_kuhn),
                     make_box({1.5, 0, 0}, {2.5, 1, 1}, {6, 6, 6}, BoxElements::tet4_five));
  jitter(mesh, 0.2, 3);
  return mesh;
}

Vec3 random_point(std::mt19937& random, const Vec3& low, const Vec3& high) {
  std::uniform_real_distribution<double> u(0, 1);
  Vec3 p;
  for (int d = 0; d < 3; ++d) p[d] = low[d] + (high[d] - low[d]) * u(random);
  return p;
}

OrientedBox random_box(std::mt19937& random) {
  const Vec3 n = random_point(random, {-1, -1, -1}, {1, 1, 1}).normalized();
  const Vec3 u = n.unitOrthogonal();
  OrientedBox box;
  box.axes << n, u, n.cross(u);
  const Vec3 middle = box.axes.transpose() * random_point(random, {0, 0, 0}, {2.5, 1, 1});
  const Vec3 half = random_point(random, {0, 0.02, 0.02}, {0.02, 0.6, 0.6});
  box.low = middle - half;
  box.high = middle + half;
  return box;
}

// Whether points of a fine grid over the box's flat middle lie in the element: it is surely met.
bool is_met(const Mesh& mesh, std::int32_t e, const OrientedBox& box) {
  const auto c = mesh.corners(e);
  Mat3 D;
  for (int k = 0; k < 3; ++k) D.col(k) = mesh.X[c[k + 1]] - mesh.X[c[0]];
  const Mat3 inverse = D.inverse();
  constexpr int n = 12;
  for (int j = 0; j <= n; ++j)
    for (int k = 0; k <= n; ++k) {
      const Vec3 part(0.5, double(j) / n, double(k) / n);
      const Vec3 p = box.axes * (box.low + (box.high - box.low).cwiseProduct(part));
      const Vec3 b = inverse * (p - mesh.X[c[0]]);
      if (b.minCoeff() >= 0 && b.sum() <= 1) return true;
    }
  return false;
}

// The element that holds the middle of the box, nothing if it is outside.
std::vector<std::int32_t> begin_of(const Mesh& mesh, OrientedBox box) {
  box.low = box.high = 0.5 * (box.low + box.high);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    if (is_met(mesh, e, box)) return {e};
  return {};
}

TEST(NearElements, are_found_from_the_surface_or_the_begin_wherever_a_band_lies) {
  const Mesh mesh = two_blocks();
  CutIndex index = index_of(mesh);
  KnownPositions positions(mesh, mesh.X);
  std::mt19937 random(1);
  int n_met = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const OrientedBox box = random_box(random);
    const auto all = near_elements(mesh, index, positions, box).tets;
    const auto found = near_elements(mesh, index, positions, box, begin_of(mesh, box)).tets;
    EXPECT_TRUE(std::ranges::includes(all, found));
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
      if (!is_met(mesh, e, box)) continue;
      ++n_met;
      EXPECT_TRUE(std::ranges::binary_search(found, e)) << trial << " " << e;
    }
  }
  EXPECT_GT(n_met, 500);
  EXPECT_TRUE(std::ranges::all_of(index.ring, [](int r) { return r == no_ring; }));
}

// Neither the box's axes nor those of space part them.
bool may_meet(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x, const OrientedBox& box) {
  Box along_axes, own, around;
  for (const std::int32_t i : mesh.corners(e)) {
    along_axes.add(box.axes.transpose() * x[i]);
    own.add(x[i]);
  }
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p = box.low;
    for (int d = 0; d < 3; ++d)
      if ((corner >> d & 1) != 0) p[d] = box.high[d];
    around.add(box.axes * p);
  }
  return along_axes.overlaps({box.low, box.high}) && own.overlaps(around);
}

TEST(NearElements, of_a_cut_and_stretched_body_are_those_that_a_look_at_all_finds) {
  Body body(two_blocks());
  CutIndex index = index_of(body.mesh);
  const Vec3 normal = Vec3(1, 0.3, 0.2).normalized();
  ASSERT_GT(cut_with_index(normal, body, index).n_edits, 3);
  for (std::size_t i = 0; i < body.x.size(); ++i) {  // the halves and the other block far apart
    const double far = normal.dot(body.mesh.X[i] - Vec3(0.5, 0.5, 0.5)) > 0 ? 0.8 : 0;
    body.x[i] = Vec3(2.2 * body.mesh.X[i].x() + far, 0.7 * body.mesh.X[i].y(), body.mesh.X[i].z());
  }
  KnownPositions positions(body.mesh, body.x);
  std::mt19937 random(2);
  std::size_t n_found = 0;
  for (int trial = 0; trial < 60; ++trial) {
    OrientedBox box = random_box(random);
    box.low += box.axes.transpose() * Vec3(random() % 5, 0, 0);
    box.high = box.high.cwiseMax(box.low + Vec3::Constant(0.05));
    std::vector<std::int32_t> all, at_surface;
    for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
      if (!may_meet(body.mesh, e, body.x, box)) continue;
      all.push_back(e);
      const auto is_surface = [&](std::int32_t i) { return index.is_surface[i] != 0; };
      if (std::ranges::any_of(body.mesh.corners(e), is_surface)) at_surface.push_back(e);
    }
    EXPECT_EQ(near_elements(body.mesh, index, positions, box).tets, all) << trial;
    const auto found = near_elements(body.mesh, index, positions, box, {}).tets;
    EXPECT_TRUE(std::ranges::includes(found, at_surface)) << trial;
    EXPECT_TRUE(std::ranges::includes(all, found)) << trial;
    n_found += found.size();
  }
  EXPECT_GT(n_found, 500U);
}

TEST(NearElements, deep_in_the_body_are_found_from_the_begin_only) {
  const Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {16, 16, 16}, BoxElements::tet4_kuhn);
  CutIndex index = index_of(mesh);
  OrientedBox box;
  box.axes = Mat3::Identity();
  box.low = box.high = Vec3(0.51, 0.52, 0.53);  // eight cells deep
  KnownPositions positions(mesh, mesh.X);
  EXPECT_TRUE(near_elements(mesh, index, positions, box, {}).tets.empty());
  const auto found = near_elements(mesh, index, positions, box, begin_of(mesh, box)).tets;
  EXPECT_EQ(found, near_elements(mesh, index, positions, box).tets);
  EXPECT_FALSE(found.empty());
}

}  // namespace
}  // namespace trocar
