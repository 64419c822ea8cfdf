// Slices that are thinner somewhere than an element.
#include "cutting/cut_neck.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"

namespace trocar {
namespace {

using namespace cutting_test;

constexpr int n_bar_cells = 5;

// A bar of cells in a row, all of it on the side of `distance` from the surface; the elements of
// cell `other` got the other side.
struct PartedBar {
  CutSurroundings around;
  CutLabels labels;
  std::vector<std::int32_t> cell;  // elements of `other`
};

PartedBar parted_bar(int other, double distance) {
  PartedBar bar;
  const Body body(
      make_box({0, 0, 0}, {n_bar_cells, 1, 1}, {n_bar_cells, 1, 1}, BoxElements::tet4_kuhn));
  bar.around.h = 1;
  bar.around.patch = whole_patch(body);
  bar.around.distance.assign(bar.around.patch.node.size(), distance);
  const std::int8_t side = distance > 0 ? 1 : -1;
  for (std::int32_t e = 0; e < body.mesh.n_elements(); ++e) {
    const bool is_other = int(centre_of(bar.around.patch, {&e, 1}).x()) == other;
    if (is_other) bar.cell.push_back(e);
    bar.labels.side.push_back(is_other ? static_cast<std::int8_t>(-side) : side);
    bar.labels.kind.push_back(CutKind::separated);
  }
  return bar;
}

TEST(JoinNecks, gives_what_parts_a_slice_the_side_that_it_lies_on) {
  for (const double distance : {0.5, -0.5}) {
    PartedBar bar = parted_bar(2, distance);
    EXPECT_EQ(join_necks(bar.around, bar.cell, bar.labels), bar.cell);
    for (const std::int8_t side : bar.labels.side) EXPECT_EQ(side, distance > 0 ? 1 : -1);
  }
}

TEST(JoinNecks, leaves_alone_the_end_of_a_slice_and_what_is_thinner_than_a_slice) {
  for (const auto& [other, distance] : {std::pair{0, 0.5}, {n_bar_cells - 1, 0.5}, {2, 0.3}}) {
    PartedBar bar = parted_bar(other, distance);
    const std::vector<std::int8_t> side = bar.labels.side;
    EXPECT_TRUE(join_necks(bar.around, bar.cell, bar.labels).empty());
    EXPECT_EQ(bar.labels.side, side);
  }
}

TEST(JoinNecks, turns_nothing_that_was_decided_before) {
  PartedBar bar = parted_bar(2, 0.5);
  const std::vector<std::int8_t> side = bar.labels.side;
  EXPECT_TRUE(join_necks(bar.around, {}, bar.labels).empty());
  EXPECT_EQ(bar.labels.side, side);
}

// A block whose top sinks in the middle, to `depth` above the blade along one side and 0.1 along
// the middle and the other: its two ends came off apart.
TEST(Slices, with_a_neck_come_off_whole) {
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::tet4_five})
    for (const double depth : {0.4, 0.5, 0.6}) {
      Mesh mesh = make_box({0, 0, 0}, {6, 2, 2}, {6, 2, 2}, elements);
      for (Vec3& X : mesh.X)
        if (X.z() == 2) X.z() = 1.2 + (X.x() < 2 || X.x() > 4 ? 1 : X.y() == 0 ? depth : 0.1);
      Body body(std::move(mesh));
      const Blade blade = straight_blade({-1, -1, 1.2}, {-1, 3, 1.2}, {8, 0, 0});
      cut(body, blade, Vec3::UnitZ(), 12);
      EXPECT_EQ(fault(body), "");
      EXPECT_EQ(n_pieces(body.mesh), 2) << depth;
    }
}

}  // namespace
}  // namespace trocar
