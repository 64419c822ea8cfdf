// What a stroke remembers of an edit.
#include "cutting/cut_edit.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"
#include "known_positions.h"

namespace trocar {
namespace {

using namespace cutting_test;

// A chip is measured by the mean edge around the blade: the next advance may have another one.
TEST(Remember, keeps_the_sides_of_chips_though_nothing_is_open_there) {
  Body body(make_box({0, 0, 0}, {1, 1, 1}, {1, 1, 1}, BoxElements::tet4_kuhn));
  CutIndex index = index_of(body.mesh);
  KnownPositions positions(body.mesh, body.x);
  TetCut cut;
  cut.around.h = 1;
  cut.around.patch = make_patch(body.mesh, index, positions, {body.is_held}, std::vector{0, 1, 2});
  const CutPatch& patch = cut.around.patch;
  cut.around.points.offset.assign(patch.node.size() + 1, 0);
  cut.labels.kind.assign(patch.element.size(), CutKind::uncut);
  cut.labels.side.assign(patch.element.size(), 1);
  cut.opening.corner = patch.corner;
  cut.is_cut.assign(patch.node.size(), 0);
  cut.X = patch.X;
  cut.chips = {{Vec3::Zero(), {1, 4}}};
  CutStroke stroke;
  remember(cut, body.mesh, stroke);
  ASSERT_EQ(stroke.side.size(), 2U);
  EXPECT_EQ(stroke.side[0].element, 1);
  EXPECT_EQ(stroke.side[1].element, 4);
}

}  // namespace
}  // namespace trocar
