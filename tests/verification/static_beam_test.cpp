// V14, V15, V16, V18: slender and twisted bodies under gravity, end loads and turned ends.
#include <numbers>

#include "dead_load.h"
#include "verification_clamped_edge.h"
#include "verification_dynamics.h"
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

static Vec3 gravity_tip(const Variant& variant, int n) {
  Body body = make_box_body(variant,
                            {.size = {.06, .02, .02},
                             .n = {3 * n, n, n},
                             .material = {MaterialModel::neo_hookean, 1e4, .49, 1000},
                             .fixed = [](const Vec3& X) { return FixedMask(X.x() < 1e-9 ? 7 : 0); },
                             .gravity = {0, 0, -9.81}});
  settle(body, {.ramp_iterations = 1000});
  return displacement_at(body, {.06, .01, .01});
}

// `stated`: u_z of such elements at this n in numerics V14, half of whose last digit is .13 % of
// the reference, itself +-.3 %.
static void check_gravity_cantilever(const Variant& variant, int n, double stated) {
  const Vec3 u = gravity_tip(variant, n), coarse = gravity_tip(variant, n / 2);
  const std::string mesh = mesh_name(variant, {3 * n, n, n});
  const double u_z = -.03933, u_x = -.01352;
  check_figure({"V14 Gravity cantilever", "tip u_z [m]", mesh, u.z(), u_z,
                std::abs(stated / u_z - 1) + .0013 + .003, "implicit Q3/P2 mixed solver",
                order_between(coarse.z() - u_z, u.z() - u_z)});
  check_figure({"V14 Gravity cantilever", "tip u_x [m]", mesh, u.x(), u_x,
                two_mesh_tolerance(coarse.x(), u.x(), u_x, order_at_clamped_edge(.49)) + .003,
                "implicit Q3/P2 mixed solver", order_between(coarse.x() - u_x, u.x() - u_x)});
}

TEST(V14GravityCantilever, tip_is_where_the_mixed_solver_has_it) {
  check_gravity_cantilever(hex_one_point, 4, -.0395);
  check_gravity_cantilever(hex_one_point, 8, -.0392);
  check_gravity_cantilever(hex_enhanced, 8, -.0388);  // as J-bar
  check_gravity_cantilever(tet_nodal_pressure, 4, -.0346);
}

// An elastica of L / h = 20 with nu = 0, so that E I is all that counts: shear adds .15 %.
struct Elastica {
  static constexpr double L = .2, h = .01, E = 3000;
  int n = 4;
  double width() const { return h / n; }
  double EI() const { return E * width() * h * h * h / 12; }
};

// Square cells under a bending moment are exact with c_mu = E / (9 mu) (numerics 1.2).
static Body elastica_body(const Elastica& e, double line_load) {
  Variant variant = hex_one_point;
  variant.hourglass = 2.0 / 9;
  const double density = 1000;
  return make_box_body(variant,
                       {.size = {Elastica::L, Elastica::h, e.width()},
                        .n = {20 * e.n, e.n, 1},
                        .material = {MaterialModel::neo_hookean, Elastica::E, 0, density},
                        .fixed = [](const Vec3& X) { return FixedMask(X.x() < 1e-9 ? 7 : 0); },
                        .gravity = {0, -line_load / (density * Elastica::h * e.width()), 0}});
}

static void check_tip(const Body& body, const std::string& load, double w, double u) {
  const Vec3 tip = displacement_at(body, {Elastica::L, Elastica::h / 2, 0}) / Elastica::L;
  check_figure({"V15 Elastica", "w/L at " + load, "hex8 80 x 4 x 1", -tip.y(), w, .015,
                "elliptic integrals"});
  check_figure({"V15 Elastica", "u/L at " + load, "hex8 80 x 4 x 1", -tip.x(), u, .025,
                "elliptic integrals"});
}

TEST(V15Elastica, a_tip_load_bends_the_beam_into_the_elastica) {
  const Elastica e;
  const std::vector<std::array<double, 3>> cases = {{1, .30172077, .05643324},
                                                    {2, .49345748, .16064172},
                                                    {5, .71379152, .38762836},
                                                    {10, .81060902, .55499560}};
  for (const auto& [k, w, u] : cases) {
    Body body = elastica_body(e, 0);
    const double P = k * e.EI() / (Elastica::L * Elastica::L);
    const std::vector<double> load = load_by(body, [&](const Vec3& X) {
      if (X.x() < Elastica::L * (1 - 1e-9)) return Vec3(0, 0, 0);
      const Vec3 size(Elastica::L, Elastica::h, e.width());
      return Vec3(0, -P * face_share(X, size, {20 * e.n, e.n, 1}, 0), 0);
    });
    settle(body, {.add_load = dead_load(load), .ramp_iterations = 4000, .tolerance = 1e-5});
    check_tip(body, "P L^2/EI = " + std::to_string(int(k)), w, u);
  }
}

TEST(V15Elastica, its_own_weight_bends_the_beam_into_the_heavy_elastica) {
  const Elastica e;
  const std::vector<std::array<double, 3>> cases = {
      {5, .49590504, .15334282}, {10, .70019972, .34364624}, {20, .82988144, .55476795}};
  for (const auto& [k, w, u] : cases) {
    Body body = elastica_body(e, k * e.EI() / (Elastica::L * Elastica::L * Elastica::L));
    settle(body, {.ramp_iterations = 4000, .tolerance = 1e-5});
    check_tip(body, "q L^3/EI = " + std::to_string(int(k)), w, u);
  }
}

// A quarter of a column 1 x 1 x 10 cm whose end z = 0 slides on a plate.
static double column_length(double load, double direction) {
  const double mu = 1000, nu = .499, L = .1;
  Body body = make_box_body(hex_one_point,
                            {.size = {.005, .005, L},
                             .n = {1, 1, 20},
                             .material = {MaterialModel::neo_hookean, 2 * mu * (1 + nu), nu, 1000},
                             .fixed =
                                 [](const Vec3& X) {
                                   return static_cast<FixedMask>((X.x() < 1e-9 ? 1 : 0) |
                                                                 (X.y() < 1e-9 ? 2 : 0) |
                                                                 (X.z() < 1e-9 ? 4 : 0));
                                 },
                             .gravity = {0, 0, direction * load * mu / (1000 * L)}});
  settle(body, {.ramp_iterations = 2000});
  return 1 + displacement_at(body, {0, 0, L}).z() / L;
}

TEST(V16Column, length_under_its_weight_is_that_of_the_thin_column) {
  const std::vector<std::array<double, 3>> cases = {{.1, 1.01704321, .98369754},
                                                    {.5, 1.09334762, .92516629},
                                                    {1, 1.20929391, .86451577},
                                                    {2, 1.51273648, .77254249}};
  // Sections stay plane in the thin column: (w/L)^2 = .25 % of the change at w = L/20, and
  // nu = .499 softens it by .07 %.
  for (const auto& [load, hanging, standing] : cases) {
    const std::string at = "l/L at rho g L/mu = " + std::to_string(load).substr(0, 3);
    check_figure({"V16 Hanging column", at, "hex8 1 x 1 x 20", column_length(load, 1), hanging,
                  .005, "quadrature"});
    check_figure({"V16 Standing column", at, "hex8 1 x 1 x 20", column_length(load, -1), standing,
                  .005, "quadrature"});
  }
}

struct TorsionResult {
  double moment, normal;  // over mu a^3, mu a^2
};

// Cylinder of radius and length 1 whose ends turn against each other by psi.
static TorsionResult torsion(const Variant& variant, int n, double psi) {
  const Mesh mesh = make_cylinder(Vec3::Zero(), 1, 1, n, n / 2, variant.elements);
  Body body = make_body(mesh, {.materials = {{MaterialModel::neo_hookean, 2.998, .499, 1}},
                               .solver = solver_options(variant)});
  std::vector<PrescribedNode> ends;
  for (const char* name : {"z-", "z+"})
    for (const std::int32_t i : find_node_set(mesh, name)->node) {
      const Eigen::AngleAxisd turn(psi * (mesh.X[i].z() - .5), Vec3::UnitZ());
      ends.push_back({.node = i, .u_next = turn * mesh.X[i] - mesh.X[i]});
    }
  settle(body, {.prescribed = ends, .ramp_iterations = 2000, .tolerance = 1e-5});
  TorsionResult result{};
  for (const std::int32_t i : find_node_set(mesh, "z+")->node) {
    const Vec3 R = -Vec3::Map(&body.scratch.force[3 * i]);
    const Vec3 x = mesh.X[i] + Vec3::Map(&body.state.u[3 * i]);
    result.moment += x.cross(R).z();
    result.normal += R.z();
  }
  return result;
}

static void check_torsion(int n, double psi, double tolerance) {
  const TorsionResult result = torsion(hex_one_point, n, psi);
  const double mu = 2.998 / (2 * 1.499), pi = std::numbers::pi;
  const std::string at = " at psi = " + std::to_string(psi).substr(0, 3);
  const std::string mesh = mesh_name(hex_one_point, {n, n, n / 2});
  check_figure(
      {"V18 Torsion", "moment" + at, mesh, result.moment / mu, pi / 2 * psi, tolerance / 2});
  check_figure({"V18 Torsion", "normal force" + at, mesh, result.normal / mu, -pi / 4 * psi * psi,
                tolerance});
}

TEST(V18Torsion, moment_and_poynting_force_of_the_twisted_cylinder_are_the_closed_form) {
  // The polygon of 4 n chords has less of the circle's second moment by (4/3) (pi / 4n)^2, .6 % at
  // n = 12; the normal force, a difference of pressures, feels the ill-shaped cells at the rim.
  for (const double psi : {.5, 1.}) check_torsion(12, psi, .05);
  if (is_report()) check_torsion(20, 1, .03);
}
