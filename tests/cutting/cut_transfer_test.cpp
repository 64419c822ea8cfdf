#include "cutting/cut_transfer.h"

#include <gtest/gtest.h>

#include <random>

#include "cutting_tet.h"

namespace trocar {
namespace {

struct Moved {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {4, 4, 4}, BoxElements::tet4_five);
  CutPatch patch;
  explicit Moved(const std::vector<Vec3>* x = nullptr) {
    cutting_test::Body body(mesh);
    if (x != nullptr) body.x = *x;
    patch = cutting_test::whole_patch(body);
  }
  // Interior nodes moved at random, up to `amount`.
  std::vector<Vec3> moved(double amount) const {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> u(-amount, amount);
    std::vector<Vec3> X = patch.X;
    for (Vec3& p : X)
      if (p.minCoeff() > 0 && p.maxCoeff() < 1) p += Vec3(u(random), u(random), u(random));
    return X;
  }
};

TEST(TransferMoves, gives_weights_that_are_exact_for_affine_fields) {
  const Moved m;
  std::vector<Vec3> X = m.moved(0.05);
  const std::vector<NodeTransfer> transfer = transfer_moves(m.patch, X);
  EXPECT_EQ(transfer.size(), 27U);
  for (const NodeTransfer& t : transfer) {
    Vec3 q = Vec3::Zero();
    for (std::size_t a = 0; a < 4; ++a) q += t.weight[a] * m.patch.X[m.patch.corner[t.host][a]];
    EXPECT_NEAR((q - X[t.node]).norm(), 0, 1e-15);  // rounding
  }
}

TEST(TransferMoves, backs_off_until_no_element_is_inverted) {
  const Moved m;
  std::vector<Vec3> X = m.moved(0.3);
  int n_inverted = 0;
  for (const auto& corner : m.patch.corner) n_inverted += six_volumes(X, corner) <= 0 ? 1 : 0;
  EXPECT_GT(n_inverted, 0);
  transfer_moves(m.patch, X);
  for (const auto& corner : m.patch.corner) EXPECT_GT(six_volumes(X, corner), 0);
}

TEST(TransferMoves, backs_off_until_no_element_is_inverted_in_the_present_configuration) {
  Mesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {4, 4, 4}, BoxElements::tet4_five);
  std::vector<Vec3> x = mesh.X;  // squeezed to a tenth in the upper half: bent where the nodes move
  for (Vec3& p : x) p.z() = p.z() < 0.5 ? p.z() : 0.5 + 0.1 * (p.z() - 0.5) + 0.2 * p.x() * p.z();
  const Moved m(&x);
  std::vector<Vec3> X = m.moved(0.12), y = m.patch.x;
  for (const NodeTransfer& t : transfer_moves(m.patch, X)) {
    y[t.node].setZero();
    for (std::size_t a = 0; a < 4; ++a)
      y[t.node] += t.weight[a] * m.patch.x[m.patch.corner[t.host][a]];
  }
  for (const auto& corner : m.patch.corner) EXPECT_GT(six_volumes(y, corner), 0);
}

}  // namespace
}  // namespace trocar
