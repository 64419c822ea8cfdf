// V1: vectors of an independent reference solver (golden.txt), digit by digit.
#include <gtest/gtest.h>

#include "solver/element_hex8.h"
#include "solver_body.h"

using namespace trocar;

// Displacement of the golden vectors: u_a,i = 1e-3 sin(1 + 3a + 1.7 i (a+1)).
static Body golden_body(const Mesh& mesh, SolverOptions solver, Precision precision) {
  solver.precision = precision;
  Body body = make_body(mesh, {.materials = {material_of(MaterialModel::neo_hookean, 1000, 49000)},
                               .solver = solver});
  for (int a = 0; a < body.model.n_local; ++a)
    for (int i = 0; i < 3; ++i)
      body.state.u[3 * a + i] = 1e-3 * std::sin(1 + 3 * a + 1.7 * i * (a + 1));
  return body;
}

// Relative to the largest force and to the energy: the digits printed, and what single has.
static double tolerance(Precision precision) {
  return precision == Precision::in_double ? 5e-11 : 1e-5;
}

template <std::size_t n>
static void expect_golden(Body& body, const double (&f)[n][3], double energy) {
  const double tol = tolerance(body.model.options.precision);
  force(body);
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(-body.scratch.force[3 * a + i], f[a][i], tol * .2)
          << name_of(body.model.options.precision);
  EXPECT_NEAR(stored_energy(body) / energy, 1, tol);
}

static Mesh golden_hex() {
  return irregular_elements()[2];
}
static Mesh two_tetrahedra() {
  return irregular_patch(Formulation::tet4_nodal_pressure);
}

TEST(Golden, volume_gradients_and_hourglass_stiffness_of_the_one_point_hexahedron) {
  const Mesh mesh = golden_hex();
  const Material material = material_of(MaterialModel::neo_hookean, 1000, 49000);
  const ElementConstants c = constants_hex8({.X = mesh.X,
                                             .lambda = lame_lambda(material),
                                             .mu = 1000,
                                             .density = 1000,
                                             .hourglass = 0.25});
  EXPECT_NEAR(c.volume / 1.147250000000e-06, 1, 1e-12);
  EXPECT_NEAR(c.value[ElementHex8::value_k] / 4.959240734183e-01, 1, 1e-11);
  const double B[8][3] = {{-2.0701677925e+01, -2.4624101111e+01, -2.3098714317e+01},
                          {2.3970363914e+01, -2.4987288443e+01, -2.3389264182e+01},
                          {1.9448681630e+01, 2.5949734873e+01, -2.5459431975e+01},
                          {-2.2935280017e+01, 2.6276603472e+01, -2.5895256773e+01},
                          {-2.2826323818e+01, -2.4388029346e+01, 2.4878332244e+01},
                          {2.5223360209e+01, -2.5150722743e+01, 2.3135033050e+01},
                          {2.1791239922e+01, 2.3098714317e+01, 2.4406188712e+01},
                          {-2.3970363914e+01, 2.3825088981e+01, 2.5423113242e+01}};
  const double gamma[8][4] = {{1.05186315, 0.89060798, 1.05622140, -1.11898017},
                              {1.03028982, -0.95358466, -1.14534757, 0.85697683},
                              {-1.20287644, -0.89300501, 0.95140553, -1.07263747},
                              {-1.18446285, 0.95914143, -0.85737633, 0.94730152},
                              {-0.80420571, -1.11647418, 1.06613641, 1.07434445},
                              {-0.83002833, 1.05055568, -1.15123121, -0.95779763},
                              {0.95837873, 1.11091741, 0.93658749, 1.12137721},
                              {0.98104162, -1.04815864, -0.85639573, -0.85058473}};
  const int xi[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                        {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  std::array<double, ElementHex8::n_values * block_lanes<double>> value{};
  for (std::size_t k = 0; k < ElementHex8::n_values; ++k)
    value[k * block_lanes<double>] = c.value[k];
  std::array<double, ElementHex8::n_kept * block_lanes<double>> kept{};
  ElementHex8::prepare(BlockValues<double>{value.data()}, Stash<double>{kept.data()});
  const auto b = [&](int m, int j) {
    return c.value[ElementHex8::value_inverse] *
           kept[(ElementHex8::kept_b + 3 * m + j) * block_lanes<double>];
  };
  for (int a = 0; a < 8; ++a) {
    const double x = xi[a][0], y = xi[a][1], z = xi[a][2];
    const double S[7] = {x, y, z, y * z, z * x, x * y, x * y * z};
    Vec3 sum = Vec3::Zero();
    for (int m = 0; m < 6; ++m)
      for (int j = 0; j < 3; ++j) sum[j] += S[m] * b(m, j);
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(sum[j], B[a][j], 1e-8);  // printed digits
    for (int p = 0; p < 4; ++p) {
      double g = S[3 + p];
      for (int j = 0; j < 3; ++j) g -= sum[j] * c.value[ElementHex8::value_X + 3 * p + j];
      EXPECT_NEAR(g, gamma[a][p], 6e-9);  // printed digits
    }
  }
}

TEST(Golden, forces_and_energies_of_the_one_point_hexahedron) {
  const double f[8][3] = {{1.4290457768e-01, 2.0774397451e-01, 1.6127925238e-01},
                          {-1.8865238709e-01, 2.1441178579e-01, 1.6427529723e-01},
                          {-1.2697365226e-01, -2.2037640786e-01, 1.7930385741e-01},
                          {1.7660689436e-01, -2.2608201799e-01, 1.8135334931e-01},
                          {1.5631355012e-01, 2.0599903444e-01, -1.7553401567e-01},
                          {-1.9673431497e-01, 2.1635970378e-01, -1.6211005239e-01},
                          {-1.4805187296e-01, -1.9475998661e-01, -1.7026417601e-01},
                          {1.8458720513e-01, -2.0329608608e-01, -1.7830351225e-01}};
  for (const Precision precision : precisions) {
    Body body = golden_body(golden_hex(), {.hourglass = 0.25}, precision);
    expect_golden(body, f, 6.543774386906e-04);
    EnergyTerms terms;
    energy_terms(body.model, body.part, body.state, terms);
    EXPECT_NEAR(terms.hourglass[0] / 4.609697023262e-06, 1, tolerance(precision));
  }
}

TEST(Golden, bound_of_the_one_point_hexahedron_lies_closely_above_its_frequency) {
  const Body body = golden_body(golden_hex(), {.hourglass = 0.25}, Precision::in_double);
  const double omega = 2 / body.model.element_step[0];
  EXPECT_GT(omega, 2328.932905);
  EXPECT_LT(omega, 1.05 * 2328.932905);  // attained for cubes, a few per cent off when distorted
}

TEST(Golden, forces_and_energy_of_two_linear_tetrahedra) {
  const double f[5][3] = {{1.6734853307e-01, 9.4546989262e-02, 1.6874868726e-01},
                          {-2.0870892644e-01, 5.1251860914e-02, 6.5076751277e-04},
                          {4.7243792409e-02, -1.6017304475e-01, 2.2447714773e-02},
                          {7.2572212618e-03, 1.9156607770e-02, -1.7533140996e-01},
                          {-1.3140620302e-02, -4.7824131994e-03, -1.6515759584e-02}};
  for (const Precision precision : precisions) {
    Body body = golden_body(two_tetrahedra(), {}, precision);
    expect_golden(body, f, 2.402757759831e-04);
  }
}

TEST(Golden, forces_and_energy_of_two_tetrahedra_with_averaged_nodal_pressure) {
  const double f[5][3] = {{1.0317339440e-01, 5.7486475335e-02, 1.0271849708e-01},
                          {-1.8602244806e-01, 7.8684756909e-02, 4.2697689531e-02},
                          {8.2151028349e-02, -1.5610951967e-01, 5.6954983359e-02},
                          {5.9372434482e-02, 5.1016017648e-02, -1.3900541831e-01},
                          {-5.8674409170e-02, -3.1077730224e-02, -6.3365751660e-02}};
  for (const Precision precision : precisions) {
    Body body =
        golden_body(two_tetrahedra(),
                    with(Formulation::tet4_nodal_pressure, {.own_volume_stiffness = 0}), precision);
    expect_golden(body, f, 1.619106166792e-04);
  }
}

TEST(Golden, a_whole_share_of_its_own_pressure_makes_the_tetrahedron_the_linear_one) {
  Body averaged = golden_body(two_tetrahedra(),
                              with(Formulation::tet4_nodal_pressure, {.own_volume_stiffness = 1e9}),
                              Precision::in_double);
  Body linear = golden_body(two_tetrahedra(), {}, Precision::in_double);
  const std::vector<double> f = force(linear);
  force(averaged);
  // Some ten roundings.
  EXPECT_LE(largest_difference(averaged.scratch.force, f), 1e-14 * largest(f));
}
