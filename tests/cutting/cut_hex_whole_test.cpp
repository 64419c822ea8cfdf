// Hexahedra that a cut can't see as tetrahedra.
#include <gtest/gtest.h>

#include "cutting/cut_hex.h"
#include "cutting_tet.h"
#include "known_positions.h"
#include "mesh/hex_split.h"

namespace trocar {
namespace {

using namespace cutting_test;

// Whole is the one between z = 0 and a sixth. Returns how many places a level blade names for it.
std::ptrdiff_t places_at_whole(bool has_whole, double z, int n_expected_pieces) {
  Body body(make_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {6, 6, 6}, BoxElements::hex8));
  body.mesh.hex_split_rank.assign(body.mesh.X.size(), 0);
  for (std::int32_t i = 0; i < body.mesh.n_nodes() && has_whole; ++i)
    if ((body.mesh.X[i] - Vec3::Constant(1.0 / 12)).cwiseAbs().maxCoeff() < 0.1)
      body.mesh.hex_split_rank[i] = whole_bit;
  EXPECT_EQ(whole_hexahedra(body.mesh).size(), has_whole ? 1U : 0U);
  const Blade blade = plane_blade({0, 0, z}, Vec3::UnitZ(), 1);
  TetCutter cutter{CutTetOptions{}};
  cutter.start_stroke();
  Ledger ledger;
  std::ptrdiff_t n_places = 0;
  for (int k = 0; k < 25; ++k) {
    CutFigures figures;
    KnownPositions positions(body.mesh, body.x);
    const BladeSweep sweep{blade(k / 25.0), blade((k + 1) / 25.0), Vec3::UnitZ()};
    const MeshEdit edit =
        cutter.advance(body.mesh, positions, {body.is_held}, sweep, k == 24, figures);
    apply(edit, figures, body, ledger);
    n_places += std::ranges::count_if(figures.refusals, [](const CutRefusal& place) {
      return place.reason == CutRefusal::bent && (place.X - Vec3::Constant(1.0 / 12)).norm() < 1e-9;
    });
  }
  EXPECT_EQ(n_pieces(body.mesh), n_expected_pieces) << z;
  return n_places;
}

TEST(CutHexWhole, a_blade_tells_of_hexahedra_on_its_way_that_it_cannot_cut) {
  EXPECT_EQ(places_at_whole(true, 0.08, 1), 1);
  EXPECT_EQ(places_at_whole(false, 0.08, 2), 0);
  EXPECT_EQ(places_at_whole(true, 0, 1), 0);  // along its face, which stays: told otherwise
  EXPECT_EQ(places_at_whole(true, -0.1, 2), 0);
}

}  // namespace
}  // namespace trocar
