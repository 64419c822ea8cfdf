// Bridges that a blade left between the tip of its slit and an older slit, and is to part now.
#include "cutting_plane.h"

namespace trocar {
namespace {

struct BridgeCount {
  int n = 0, n_parted = 0, n_told = 0;
};

// A slit across the plate, and one from below that stops `left` before it.
struct Slits {
  Mesh mesh;
  std::int32_t tip = -1;

  Slits(int configuration, double x, double left) {
    const Mesh crossed =
        applied(cut(paper_mesh(configuration), {{10 * mm, 20 * mm, 0}, {60 * mm, 20 * mm, 0}}).edit,
                paper_mesh(configuration));
    const PlaneCut slit = cut(crossed, {{x, -2 * mm, 0}, {x, 20 * mm - left, 0}});
    tip = slit.tip;
    mesh = applied(slit.edit, crossed);
  }
  PlaneCut go_on(const Vec3& from, const Vec3& to, int configuration) const {
    const double floor = 0.5 * least_step_bound(paper_mesh(configuration));
    return cut_plane(mesh, std::vector<Vec3>{from, to}, tip, {none_held(mesh)},
                     {.least_step = floor});
  }
};

void go_on_to_slit(int configuration, double x, double left, double aside, BridgeCount& outcome) {
  const Slits slits(configuration, x, left);
  ASSERT_GE(slits.tip, 0);
  const Vec3 tip = slits.mesh.X[slits.tip];
  const PlaneCut rest = slits.go_on(tip, {tip.x() + aside, 20 * mm, 0}, configuration);
  ++outcome.n;
  if (rest.edit.is_empty()) {
    EXPECT_GT(rest.figures.n_refused, 0);
    ++outcome.n_told;
    return;
  }
  EXPECT_TRUE(validate(applied(rest.edit, slits.mesh)).empty());
  EXPECT_EQ(rest.tip, -1);
  ++outcome.n_parted;
}

// With all cut points that the path has room for: 13 of 144. The others would need elements below
// the floor under the step.
TEST(CutPlaneBridge, between_a_tip_and_a_slit_is_parted_or_told) {
  BridgeCount outcome;
  for (const int configuration : {1, 2, 3, 4})
    for (const double x : {27.3, 33.0, 36.1, 41.9})
      for (const double left : {0.8, 1.0, 1.2, 1.6, 2.5})
        for (const double aside : {0.0, 1.0})
          go_on_to_slit(configuration, x * mm, left * mm, aside * mm, outcome);
  EXPECT_GE(outcome.n_parted, outcome.n * 3 / 4);
}

// The blade has come to 0.3 mm before the slit, whose lip gave way.
TEST(CutPlaneBridge, path_that_begins_at_a_slit_goes_on_from_its_other_lip) {
  for (const double x : {27.3, 33.0, 36.1, 41.9}) {
    const Slits slits(2, x * mm, 0.3 * mm);
    EXPECT_EQ(slits.tip, -1);
    const PlaneCut rest = slits.go_on({x * mm, 19.7 * mm, 0}, {x * mm, 42 * mm, 0}, 2);
    EXPECT_GT(rest.figures.n_opened_facets, 2) << x;
    EXPECT_EQ(n_pieces(applied(rest.edit, slits.mesh)), 2) << x;
  }
}

}  // namespace
}  // namespace trocar
