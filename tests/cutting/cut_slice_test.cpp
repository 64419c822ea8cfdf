// Slices one element thick, and edges of a body.
#include "cutting/cut_slice.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"

namespace trocar {
namespace {

using namespace cutting_test;

// Three cells wide and two deep; the plane leaves a slice of `part` of the upper cells.
int pieces_after_slice(double part, BoxElements elements) {
  Body body(make_box({0, 0, 0}, {3, 3, 2}, {3, 3, 2}, elements));
  const double z = 2 - part;
  const Blade blade = straight_blade({-1, -1, z}, {-1, 4, z}, {5, 0, 0});
  const Ledger ledger = cut(body, blade, Vec3::UnitZ(), 10);
  EXPECT_EQ(fault(body), "");
  EXPECT_EQ(ledger.total.n_refused > 0, n_pieces(body.mesh) == 1);
  return n_pieces(body.mesh);
}

// The slice has no element that the blade left whole.
TEST(Slices, that_are_half_an_edge_thick_come_off) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five})
    for (const double part : {0.6, 0.7, 0.8, 0.9}) {
      EXPECT_EQ(pieces_after_slice(part, elements), 2) << part;
    }
}

// The edge of a bar, along which each outer facet has a corner beyond the blade.
TEST(Slices, along_an_edge_of_the_body_come_off) {
  for (const double leg : {0.75, 0.8, 0.9}) {
    Body body(make_box({0, 0, 0}, {6, 2, 2}, {6, 2, 2}, BoxElements::tet4_kuhn));
    const Vec3 normal = Vec3(0, 1, 1).normalized(), middle{3, 2 - leg / 2, 2 - leg / 2};
    const Vec3 half{5, 0, 0}, way{0, 2, -2};
    const Blade blade = straight_blade(middle - way - half, middle - way + half, 2 * way);
    cut(body, blade, normal, 10);
    EXPECT_EQ(fault(body), "");
    EXPECT_EQ(n_pieces(body.mesh), 2) << leg;
  }
}

// A bar of three cells that all got the - side; nodes at its ends lie at `low` and `high`, the
// others on the surface.
struct SlicedBar {
  CutSurroundings around;
  CutLabels labels;
  std::vector<std::int32_t> element, high_end;  // all; those around nodes of the high end
};

SlicedBar sliced_bar(double low, double high) {
  SlicedBar bar;
  const Body body(make_box({0, 0, 0}, {3, 1, 1}, {3, 1, 1}, BoxElements::tet4_kuhn));
  bar.around.h = 1;
  bar.around.patch = whole_patch(body);
  for (const Vec3& X : body.mesh.X)
    bar.around.distance.push_back(X.x() == 0 ? low : X.x() == 3 ? high : 0);
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
    bar.element.push_back(e);
    if (centre_of(bar.around.patch, {&e, 1}).x() > 2) bar.high_end.push_back(e);
    bar.labels.side.push_back(-1);
    bar.labels.kind.push_back(CutKind::separated);
  }
  return bar;
}

TEST(JoinSlices, gives_the_elements_around_lost_nodes_their_side) {
  SlicedBar bar = sliced_bar(-0.5, 0.4);
  EXPECT_EQ(join_slices(bar.around, {}, bar.element, bar.labels), bar.high_end);
  for (const std::int32_t e : bar.element)
    EXPECT_EQ(bar.labels.side[e] > 0, std::ranges::binary_search(bar.high_end, e));
}

TEST(JoinSlices, leaves_alone_thin_slices_parted_nodes_and_what_was_decided_before) {
  SlicedBar bar = sliced_bar(-0.5, 0.3);
  EXPECT_TRUE(join_slices(bar.around, {}, bar.element, bar.labels).empty());
  bar = sliced_bar(-0.5, 0.4);
  EXPECT_TRUE(join_slices(bar.around, bar.around.patch.node, bar.element, bar.labels).empty());
  EXPECT_TRUE(join_slices(bar.around, {}, {}, bar.labels).empty());
  for (const std::int8_t side : bar.labels.side) EXPECT_EQ(side, -1);
}

// One element, which the deepest node gets.
TEST(JoinSlices, leaves_a_deeper_node_of_the_other_side_its_last_element) {
  Mesh mesh;
  mesh.X = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.region_name = {""};
  add_element(mesh, ElementType::tet4, std::array<std::int32_t, 4>{0, 1, 2, 3});
  for (const double high : {0.4, 0.6}) {
    SlicedBar bar{{}, {{CutKind::separated}, {-1}}, {0}, {}};
    bar.around.h = 1;
    bar.around.patch = whole_patch(Body(mesh));
    bar.around.distance = {-0.5, -0.5, -0.5, high};
    EXPECT_EQ(join_slices(bar.around, {}, bar.element, bar.labels).empty(), high < 0.5);
    EXPECT_EQ(bar.labels.side[0], high < 0.5 ? -1 : 1);
  }
}

}  // namespace
}  // namespace trocar
