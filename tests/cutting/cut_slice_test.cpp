// Slices one element thick.
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

}  // namespace
}  // namespace trocar
