// A cut looks at no node that it has not asked for: what lies far away may stay unknown.
#include "cutting/cut_positions.h"

#include <gtest/gtest.h>

#include "cutting_tet.h"
#include "known_positions.h"

namespace trocar {
namespace {

using namespace cutting_test;

// Knows what it was asked for since it was made.
class AskedPositions final : public PresentPositions {
 public:
  explicit AskedPositions(const Body& body)
      : known_(body.mesh, body.x),
        x_(body.x.size(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN())) {}

  std::span<const Vec3> x() const override { return x_; }
  void find(std::span<const std::int32_t> nodes) override {
    for (const std::int32_t i : nodes) x_[i] = known_.x()[i];
  }
  std::vector<std::int32_t> nodes_near(const OrientedBox& box) override {
    std::vector<std::int32_t> nodes = known_.nodes_near(box);
    find(nodes);
    return nodes;
  }
  std::ptrdiff_t n_asked() const {
    return std::ranges::count_if(x_, [](const Vec3& p) { return !std::isnan(p.x()); });
  }

 private:
  KnownPositions known_;
  std::vector<Vec3> x_;
};

Body bent(Mesh mesh) {
  Body body(std::move(mesh));
  body.deform([](const Vec3& X) {
    return Vec3(X.x() + 0.1 * X.y() * X.y(), 1.1 * X.y(), X.z() - 0.2 * X.x() * X.x());
  });
  return body;
}

TEST(PresentPositions, of_nodes_around_the_blade_are_all_that_a_cut_looks_at) {
  const Vec3 normal = Vec3(0.9, 0.4, 0.1).normalized();
  for (const BoxElements elements :
       {BoxElements::tet4_kuhn, BoxElements::tet4_five, BoxElements::hex8}) {
    Body body = bent(make_box({0, 0, 0}, {1, 1, 1}, {14, 14, 14}, elements));
    const Blade blade =
        straight_blade({0.53, -0.05, 1.05}, {0.53, -0.05, 0.7}, {-0.35, 0.6, -0.05}, 8);
    TetCutter cutter{CutTetOptions{}}, asking{CutTetOptions{}};
    Ledger ledger;
    constexpr int n_steps = 24;
    std::ptrdiff_t most_asked = 0;
    for (int k = 0; k < n_steps; ++k) {
      const BladeSweep sweep{blade(double(k) / n_steps), blade(double(k + 1) / n_steps), normal};
      AskedPositions positions(body);
      CutFigures figures;
      const MeshEdit local =
          asking.advance(body.mesh, positions, {body.is_held}, sweep, k + 1 == n_steps, figures);
      if (k + 1 < n_steps) most_asked = std::max(most_asked, positions.n_asked());
      const MeshEdit edit = advance(cutter, body, sweep, k + 1 == n_steps, ledger);
      EXPECT_EQ(local.duplicate_parent, edit.duplicate_parent);
      ASSERT_EQ(local.moves.size(), edit.moves.size());
      for (std::size_t m = 0; m < edit.moves.size(); ++m) {
        EXPECT_EQ(local.moves[m].X, edit.moves[m].X);
        EXPECT_EQ(local.moves[m].weight, edit.moves[m].weight);
      }
      EXPECT_EQ(local.splits.size(), edit.splits.size());
      EXPECT_EQ(asking.stroke().hit.size(), cutter.stroke().hit.size());
      EXPECT_EQ(asking.stroke().mean_edge, cutter.stroke().mean_edge);
    }
    EXPECT_GT(ledger.n_edits, 5);
    EXPECT_LT(most_asked, body.mesh.n_nodes() / 3);
  }
}

}  // namespace
}  // namespace trocar
