#include "engine/cut_parted.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "mesh/facets.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

// Four cells a side, of which those facets are marked as cut that lie in the plane x = 0.5 below
// z = 0.5.
struct SlitBox {
  Mesh mesh;
  std::vector<std::int32_t> all;
  explicit SlitBox(BoxElements elements)
      : mesh(make_box(Vec3::Zero(), Vec3::Ones(), {4, 4, 4}, elements)),
        all(static_cast<std::size_t>(mesh.n_elements())) {
    std::iota(all.begin(), all.end(), 0);
    for (const std::int32_t e : all) {
      const auto i = static_cast<std::size_t>(e);
      for (int f = 0; f < n_facets(mesh.element_type[i]); ++f)
        if (lies_in_slit(e, f)) mesh.cut_facets[i] |= static_cast<std::uint8_t>(1U << f);
    }
  }
  bool lies_in_slit(std::int32_t e, int f) const {
    for (const int a : facet_corners(mesh.element_type[e], f)) {
      if (a < 0) continue;
      const Vec3& X = mesh.X[mesh.corners(e)[a]];
      if (std::abs(X.x() - 0.5) > 1e-12 || X.z() > 0.5 + 1e-12) return false;
    }
    return true;
  }
  bool parts(const Vec3& from, const Vec3& to) const { return is_parted(mesh, all, {from, to}); }
};

TEST(IsParted, where_a_segment_goes_through_a_cut_facet) {
  for (const BoxElements elements :
       {BoxElements::tet4_kuhn, BoxElements::tet4_five, BoxElements::hex8}) {
    const SlitBox slit(elements);
    for (const double y : {0.1, 0.25, 0.5, 0.61})
      for (const double z : {0.1, 0.25, 0.37}) {
        EXPECT_TRUE(slit.parts({0.4, y, z}, {0.6, y, z}));
        EXPECT_TRUE(slit.parts({0.6, y, z}, {0.4, y + 0.1, z}));
        EXPECT_FALSE(slit.parts({0.3, y, z}, {0.49, y, z})) << "before it";
        EXPECT_FALSE(slit.parts({0.4, y, z + 0.5}, {0.6, y, z + 0.5})) << "above it";
      }
  }
}

TEST(IsParted, not_by_a_slit_that_the_segment_goes_along) {
  const SlitBox slit(BoxElements::tet4_kuhn);
  EXPECT_FALSE(slit.parts({0.45, 0.1, 0.2}, {0.55, 0.4, 0.2})) << "71 degrees off the normal";
  EXPECT_FALSE(slit.parts({0.5, 0.1, 0.2}, {0.5, 0.4, 0.2}));
}

TEST(IsParted, not_by_the_outer_surface) {
  const SlitBox slit(BoxElements::hex8);
  EXPECT_FALSE(slit.parts({-0.1, 0.3, 0.3}, {0.1, 0.3, 0.3}));
}

}  // namespace
}  // namespace trocar
