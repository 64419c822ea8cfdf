// Sides turned where an opening would pinch the body.
#include "cutting/cut_mend.h"

#include <gtest/gtest.h>

#include <numbers>

#include "cutting/cut_open.h"
#include "cutting_tet.h"

namespace trocar {
namespace {

using namespace cutting_test;

constexpr int n_sectors = 3;
constexpr std::int32_t top = 0, middle = 1, bottom = 2;

std::int32_t ring_node(int ring, int k) {
  return 3 + n_sectors * ring + k % n_sectors;
}

void add_tet(Mesh& mesh, std::array<std::int32_t, 4> corner) {
  if (six_volumes(mesh.X, corner) < 0) std::swap(corner[2], corner[3]);
  add_element(mesh, ElementType::tet4, corner);
}

// Around the axis: `n_sectors` tetrahedra between top and middle, as many between middle and
// bottom, and around the upper ones, up to the outer surface, two rings of pyramids over `top`, of
// two tetrahedra each: more than a pair in the way from the axis to the outside.
Mesh tent() {
  Mesh mesh;
  mesh.X = {{0, 0, 1}, {0, 0, 0}, {0, 0, -1}};
  for (int ring = 0; ring < 3; ++ring)
    for (int k = 0; k < n_sectors; ++k) {
      const double angle = 2 * std::numbers::pi * k / n_sectors, r = ring + 1;
      mesh.X.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.3 * ring);
    }
  for (int k = 0; k < n_sectors; ++k)
    add_tet(mesh, {top, middle, ring_node(0, k), ring_node(0, k + 1)});
  for (int k = 0; k < n_sectors; ++k) {
    add_tet(mesh, {middle, bottom, ring_node(0, k), ring_node(0, k + 1)});
    for (int ring = 0; ring < 2; ++ring) {
      const std::int32_t across = ring_node(ring + 1, k + 1);
      add_tet(mesh, {top, ring_node(ring, k), ring_node(ring, k + 1), across});
      add_tet(mesh, {top, ring_node(ring, k), across, ring_node(ring + 1, k)});
    }
  }
  return mesh;
}

CutSurroundings surroundings_of(const Body& body) {
  CutSurroundings around;
  around.h = 1;
  around.patch = whole_patch(body);
  around.surface_cost.assign(body.mesh.X.size(), 0.0);
  return around;
}

// Both sides meet inside but for a tent of - elements, whose tip touches the outer surface.
TEST(MendLabels, takes_a_tent_down_whose_tip_pinches_the_outer_surface) {
  Body body(tent());
  ASSERT_EQ(fault(body), "");
  const CutSurroundings around = surroundings_of(body);
  const PatchMesh mesh = make_patch_mesh(around.patch);
  CutLabels labels;
  labels.kind.assign(body.mesh.element_type.size(), CutKind::separated);
  labels.is_left.assign(body.mesh.X.size(), 0);
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
    const auto corner = body.mesh.corners(e);
    const bool is_at_axis = std::ranges::find(corner, middle) != corner.end();
    labels.side.push_back(is_at_axis ? -1 : 1);
  }
  EXPECT_EQ(pinched_nodes(around, mesh, labels), std::vector<std::int32_t>{top});
  EXPECT_EQ(mend_labels(around, mesh, {}, labels), n_sectors);
  EXPECT_TRUE(pinched_nodes(around, mesh, labels).empty());
  for (int k = 0; k < n_sectors; ++k) EXPECT_EQ(labels.side[std::size_t(k)], 1);
}

}  // namespace
}  // namespace trocar
