// The cantilever .1 x .02 x .02 m under a tip load (numerics 1.2): bending without locking,
// whatever the Poisson ratio, beside plain tetrahedra, which lock.
#include "dead_load.h"
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

static double tip_deflection(const Variant& variant, int n, double nu) {
  const Vec3 size(.1, .02, .02);
  const std::array<int, 3> cells = {5 * n, n, n};
  Body body = make_box_body(
      variant, {.size = size,
                .n = cells,
                .material = {MaterialModel::neo_hookean, 3000, nu, 1000},
                .fixed = [](const Vec3& X) { return FixedMask(X.x() < 1e-9 ? 7 : 0); }});
  const auto share = [&](const Vec3& X) {
    return X.x() < .1 - 1e-9 ? 0 : face_share(X, size, cells, 0);
  };
  const std::vector<double> load =
      load_by(body, [&](const Vec3& X) { return Vec3(0, 0, -1e-4 * share(X)); });
  settle(body, {.add_load = dead_load(load), .ramp_iterations = 0, .tolerance = 1e-5});
  double mean = 0;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    mean -= share(body.mesh.X[i]) * body.state.u[3 * static_cast<std::size_t>(i) + 2];
  return mean;
}

static Figure deflection(const Variant& variant, int n, double nu, double exact) {
  return {.problem = "Locking: tip-loaded cantilever",
          .quantity = "deflection at nu = " + std::to_string(nu).substr(0, 5) + " [m]",
          .mesh = mesh_name(variant, {5 * n, n, n}) +
                  (variant.formulation == Formulation::hex8_one_point
                       ? ", c_mu = " + std::to_string(variant.hourglass).substr(0, 4)
                       : ""),
          .number = tip_deflection(variant, n, nu),
          .reference = exact,
          .tolerance = 1,
          .source = "implicit Q3/P2 mixed solver"};
}

TEST(Locking, deflection_of_one_point_hexahedra_is_the_known_one_whatever_the_poisson_ratio) {
  struct Case {
    int n;
    double c_mu, nu, exact, ratio;
  };
  // numerics 1.2: tip / exact, to its printed digits and 1 % for where on the end face it was
  // taken.
  for (const Case& c : {Case{2, .1, .49, 8.305e-4, 1.16}, Case{4, .1, .49, 8.305e-4, 1.032},
                        Case{2, 1. / 3, .49, 8.305e-4, .921}, Case{2, .1, .499, 8.293e-4, 1.16},
                        Case{4, .1, .499, 8.293e-4, 1.032}}) {
    Variant variant = hex_one_point;
    variant.hourglass = c.c_mu;
    const Figure figure = deflection(variant, c.n, c.nu, c.exact);
    check_figure(figure);
    EXPECT_NEAR(figure.number / figure.reference, c.ratio, .012);
  }
}

TEST(Locking, the_enhanced_hexahedron_bends_alike_near_incompressibility_and_the_full_one_locks) {
  struct Case {
    double nu, exact, full_2, full_4;
  };
  // numerics 1.2: fully integrated .56 and .31 with 2 elements over the thickness, .76 and .49 with
  // 4; the enhanced form lies between c_mu = .1 and 1/3.
  for (const Case& c : {Case{.49, 8.305e-4, .56, .76}, Case{.499, 8.293e-4, .31, .49}}) {
    const Figure enhanced = deflection(hex_enhanced, 2, c.nu, c.exact);
    const Figure full_2 = deflection(hex_full, 2, c.nu, c.exact);
    const Figure full_4 = deflection(hex_full, 4, c.nu, c.exact);
    for (const Figure& figure :
         {enhanced, deflection(hex_enhanced, 4, c.nu, c.exact), full_2, full_4})
      check_figure(figure);
    EXPECT_GT(enhanced.number / c.exact, .921);
    EXPECT_LT(enhanced.number / c.exact, 1.16);
    EXPECT_NEAR(full_2.number / c.exact, c.full_2, .012);
    EXPECT_NEAR(full_4.number / c.exact, c.full_4, .012);
  }
}

TEST(Locking, averaged_pressures_free_tetrahedra_from_most_of_what_plain_ones_suffer) {
  Variant without_share = tet_nodal_pressure;
  without_share.own_volume_stiffness = 0;
  without_share.name = "tet4-nodal-pressure, no own share,";
  double kept[3];  // of the share of the exact deflection that is there at nu = .3
  int k = 0;
  for (const Variant& variant : {tet_plain, tet_nodal_pressure, without_share}) {
    const Figure soft = deflection(variant, 2, .3, 8.478e-4);
    const Figure hard = deflection(variant, 2, .499, 8.293e-4);
    check_figure(soft);
    check_figure(hard);
    kept[k++] = hard.number / hard.reference / (soft.number / soft.reference);
  }
  EXPECT_LT(kept[0], .2);
  EXPECT_GT(kept[1], .6);
  EXPECT_NEAR(kept[2], kept[1],
              .05);  // the element's own share, being of the order of mu, is no lock
}
