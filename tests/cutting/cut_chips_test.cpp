// Chips that a cut would split off.
#include "cutting/cut_chips.h"

#include <gtest/gtest.h>

#include <numbers>

#include "cutting_tet.h"

namespace trocar {
namespace {

using namespace cutting_test;

std::vector<double> piece_volumes(const Mesh& mesh) {
  const std::vector<std::int32_t> piece = element_pieces(mesh);
  std::vector<double> volume(std::size_t(n_pieces(mesh)), 0.0);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    volume[std::size_t(piece[std::size_t(e)])] += element_volume(mesh, e, mesh.X);
  return volume;
}

TEST(CutChips, planes_that_shave_a_corner_leave_it_or_cut_off_more_than_a_chip) {
  const Vec3 normal = Vec3(1, 1.2, 0.9).normalized();
  int n_whole = 0, n_parted = 0;
  for (int k = 1; k <= 24; ++k) {  // from nothing to two cells deep
    Body body(make_box({0, 0, 0}, {1, 1, 1}, {6, 6, 6}, BoxElements::tet4_kuhn));
    const double h = mean_edge_length(body.mesh);
    cut(body, plane_blade(k * (2.0 / 6 / 24) * std::numbers::sqrt3 * normal, normal, 1.5), normal,
        40);
    EXPECT_EQ(fault(body), "") << k;
    const std::vector<double> volume = piece_volumes(body.mesh);
    (volume.size() == 1 ? n_whole : n_parted) += 1;
    // What is a chip shows before nodes are displaced; that may halve a piece.
    EXPECT_GT(*std::min_element(volume.begin(), volume.end()), chip_volume / 2 * h * h * h) << k;
  }
  EXPECT_GT(n_whole, 0);
  EXPECT_GT(n_parted, 8);  // a corner one cell deep and more
}

}  // namespace
}  // namespace trocar
