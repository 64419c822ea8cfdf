// V11, V12, V13: blocks that are stretched, squeezed and indented, against an implicit mixed solver
// of high order (numerics 2).
#include "dead_load.h"
#include "verification_dynamics.h"
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

static const std::string mixed_solver = "implicit Q3/P2 mixed solver";
static const Material near_incompressible = {MaterialModel::neo_hookean, 3000, .49, 1000};

// A quarter of the cube of edge .1 about the z axis, mirror planes x = 0 and y = 0, top moved by
// `lift`. n: cells over half an edge.
static Body bonded_cube(const Variant& variant, int n, double lift) {
  Body body = make_box_body(
      variant, {.size = {.05, .05, .1},
                .n = {n, n, 2 * n},
                .material = near_incompressible,
                .fixed = [](const Vec3& X) {
                  if (X.z() < 1e-9 || X.z() > .1 - 1e-9) return FixedMask{3};
                  return static_cast<FixedMask>((X.x() < 1e-9 ? 1 : 0) | (X.y() < 1e-9 ? 2 : 0));
                }});
  std::vector<PrescribedNode> ends;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i) {
    const double z = body.mesh.X[i].z();
    if (z < 1e-9) ends.push_back({.node = i});
    if (z > .1 - 1e-9) ends.push_back({.node = i, .u_next = Vec3(0, 0, lift)});
  }
  settle(body, {.prescribed = ends});
  return body;
}

static double top_reaction(const Body& body) {
  return 4 * reaction_of(body, [](const Vec3& X) { return X.z() > .1 - 1e-9; }).z();
}

static void check_cube(const Variant& variant, int n, double lift, double force, double bulge,
                       double tolerance) {
  const Body body = bonded_cube(variant, n, lift);
  const std::string mesh = mesh_name(variant, {n, n, 2 * n});
  const std::string end = lift > 0 ? " at +20 %" : " at -20 %";
  check_figure({"V11 Bonded cube", "force" + end + " [N]", mesh, top_reaction(body), force,
                tolerance, mixed_solver});
  check_figure({"V11 Bonded cube", "bulge of the face" + end + " [m]", mesh,
                displacement_at(body, {.05, 0, .05}).x(), bulge, tolerance, mixed_solver});
}

TEST(V11BondedCube, force_and_bulge_are_those_of_the_mixed_solver) {
  // numerics V11: one-point hexahedra +.8 % and +2.9 % at n = 4, +.3 % and +1.8 % at n = 8.
  check_cube(hex_one_point, 4, .02, 6.084, -.005372, .012);
  check_cube(hex_one_point, 4, -.02, -9.0, .00749, .035);
  check_cube(hex_one_point, 8, .02, 6.084, -.005372, .006);
  check_cube(hex_one_point, 8, -.02, -9.0, .00749, .023);
  // The enhanced form is stiffer in bending than c_mu = .1; averaged pressures leave 5 and 14 % at
  // n = 4 (numerics V11), where the cells' diagonals count.
  check_cube(hex_enhanced, 8, .02, 6.084, -.005372, .02);
  check_cube(hex_enhanced, 8, -.02, -9.0, .00749, .04);
  check_cube(tet_nodal_pressure, 8, .02, 6.084, -.005372, .06);
  check_cube(tet_nodal_pressure, 8, -.02, -9.0, .00749, .15);
}

// A quarter of the block .1 x .1 x .05, its glued top pressed in by a Gaussian of width .012.
static Body indented_block(const Variant& variant, int n) {
  Body body = make_box_body(
      variant, {.size = {.05, .05, .05},
                .n = {n, n, n},
                .material = near_incompressible,
                .fixed = [](const Vec3& X) {
                  if (X.z() < 1e-9) return FixedMask{7};
                  return static_cast<FixedMask>((X.x() < 1e-9 ? 1 : 0) | (X.y() < 1e-9 ? 2 : 0));
                }});
  std::vector<PrescribedNode> top;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i) {
    const Vec3& X = body.mesh.X[i];
    if (X.z() < .05 - 1e-9) continue;
    const double r2 = X.x() * X.x() + X.y() * X.y();
    top.push_back({.node = i, .u_next = Vec3(0, 0, -.01 * std::exp(-r2 / (2 * .012 * .012)))});
  }
  // Rounding of forces in single precision leaves a residual of some 1e-6.
  settle(body,
         {.prescribed = top, .tolerance = variant.precision == Precision::in_single ? 3e-5 : 1e-6});
  return body;
}

static double indentation_force(const Body& body) {
  return 4 * reaction_of(body, [](const Vec3& X) { return X.z() > .05 - 1e-9; }).z();
}

struct Indented {
  double force, energy, u_z;  // u_z at half depth
};

static Indented indented(const Variant& variant, int n) {
  Body body = indented_block(variant, n);
  return {indentation_force(body), 4 * stored_energy(body),
          displacement_at(body, {0, 0, .025}).z()};
}

// `stated`: force of such elements at this n in numerics V12, none: 0.
static void check_smooth_indentation(const Variant& variant, int n, double stated) {
  const Indented coarse = indented(variant, n / 2), fine = indented(variant, n);
  const std::string name = "V12 Smooth indentation", mesh = mesh_name(variant, {n, n, n});
  const auto check = [&](const char* quantity, double Indented::*of, double reference,
                         double tolerance) {
    check_figure({name, quantity, mesh, fine.*of, reference, tolerance, mixed_solver,
                  order_between(coarse.*of - reference, fine.*of - reference)});
  };
  const auto two_meshes = [&](double Indented::*of, double reference) {
    return two_mesh_tolerance(coarse.*of, fine.*of, reference);
  };
  // The digits that the table prints, and the reference's own.
  const double F = -.9730, own = .0003 / .9730 + .00005;
  check("force [N]", &Indented::force, F,
        stated == 0 ? two_meshes(&Indented::force, F) : std::abs(stated / F - 1) + own);
  check("energy [J]", &Indented::energy, 3.649e-3, two_meshes(&Indented::energy, 3.649e-3));
  check("u_z at half depth [m]", &Indented::u_z, -.002772, two_meshes(&Indented::u_z, -.002772));
}

TEST(V12SmoothIndentation, force_and_energy_are_those_of_the_mixed_solver) {
  check_smooth_indentation(hex_one_point, 8, -.9796);
  check_smooth_indentation(hex_one_point_single, 8, -.9796);
  check_smooth_indentation(hex_enhanced, 8, 0);
  if (is_report()) check_smooth_indentation(hex_one_point, 16, -.9759);
}

static double locked_force(const Variant& variant, const std::string& remark) {
  const Body body = indented_block(variant, 8);
  const Figure figure{.problem = "V12 Smooth indentation",
                      .quantity = "force [N]" + remark,
                      .mesh = mesh_name(variant, {8, 8, 8}),
                      .number = indentation_force(body),
                      .reference = -.9730,
                      .tolerance = .5,
                      .source = mixed_solver};
  check_figure(figure);
  return -error_of(figure);
}

TEST(V12SmoothIndentation, plain_tetrahedra_and_full_integration_lock) {
  // numerics V12: 41 % too stiff at this mesh. How its cells were cut into tetrahedra is not told,
  // and that matters: five of them in place of six make 14 % of the error.
  EXPECT_NEAR(locked_force(tet_plain, " (locks)"), .41, .06);
  EXPECT_GT(locked_force(hex_full, " (locks)"), .05);
}

TEST(V12SmoothIndentation, averaged_pressures_leave_a_quarter_of_the_tetrahedras_error) {
  // numerics V12: 7.8 % without a share of the element's own volume change, of which 3 % for where
  // the diagonals lie.
  Variant without_share = tet_nodal_pressure;
  without_share.own_volume_stiffness = 0;
  const double error = locked_force(without_share, ", no share of the element's own volume");
  EXPECT_NEAR(error, .078, .03);
  EXPECT_NEAR(locked_force(tet_nodal_pressure, ""), error, .018);
}

// Pressure 4 r on a quarter of the top of the unit cube.
static double block_settlement(const Variant& variant, int n, double r) {
  Body body = make_box_body(
      variant, {.size = {1, 1, 1},
                .n = {n, n, n},
                .material = material_of(MaterialModel::neo_hookean, 80.194, 400889.806),
                .fixed = [](const Vec3& X) {
                  if (X.y() > 1 - 1e-9) return FixedMask{5};
                  return static_cast<FixedMask>((X.x() < 1e-9 ? 1 : 0) | (X.y() < 1e-9 ? 2 : 0) |
                                                (X.z() < 1e-9 ? 4 : 0));
                }});
  const Vec3 patch(.5, 1, .5);
  const std::vector<double> load = load_by(body, [&](const Vec3& X) {
    const bool is_loaded = X.y() > 1 - 1e-9 && X.x() < .5 + 1e-9 && X.z() < .5 + 1e-9;
    const double share = is_loaded ? face_share(X, patch, {n / 2, 1, n / 2}, 1) : 0;
    return Vec3(0, -4 * r * .25 * share, 0);
  });
  settle(body, {.add_load = dead_load(load), .ramp_iterations = 4000, .tolerance = 1e-5});
  return -displacement_at(body, {0, 1, 0}).y();
}

static void check_settlement(int n, double r, double expected) {
  const double coarse = block_settlement(hex_one_point, n / 2, r);
  const double fine = block_settlement(hex_one_point, n, r);
  check_figure({"V13 Nearly incompressible block",
                "settlement at r = " + std::to_string(static_cast<int>(r)),
                mesh_name(hex_one_point, {n, n, n}), fine, expected,
                two_mesh_tolerance(coarse, fine, expected), "implicit Q2/P1 mixed solver",
                order_between(coarse - expected, fine - expected)});
}

TEST(V13NearlyIncompressibleBlock, settlement_is_that_of_the_mixed_solver) {
  check_settlement(8, 20, .2197);
  check_settlement(8, 40, .4249);
  check_settlement(8, 60, .5857);
  check_settlement(8, 80, .694);
  if (is_report()) check_settlement(16, 80, .694);
}
