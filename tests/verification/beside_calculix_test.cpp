// Problems that CalculiX 2.20 computes on the same meshes with the same elements and materials:
// calculix/compare.py writes its decks and printed the references (seven digits).
#include "dead_load.h"
#include "verification_dynamics.h"
#include "verification_figure.h"

using namespace trocar;

static const std::string calculix = "CalculiX 2.20";

static bool is_at_start(const Vec3& X) {
  return X.x() < 1e-9;
}

static FixedMask clamp_start(const Vec3& X) {
  return is_at_start(X) ? 7 : 0;
}

static std::vector<double> end_load(const Body& body, const Vec3& size, const std::array<int, 3>& n,
                                    const Vec3& total) {
  return load_by(body, [&](const Vec3& X) {
    const bool is_end = X.x() > size.x() * (1 - 1e-9);
    return Vec3((is_end ? face_share(X, size, n, 0) : 0) * total);
  });
}

TEST(BesideCalculiX, the_small_deflection_of_a_cantilever_of_tetrahedra_is_the_same) {
  const Vec3 size(.1, .02, .02);
  const std::array<int, 3> n = {10, 2, 2};
  Body body = make_box_body(tet_plain, {.size = size,
                                        .n = n,
                                        .material = {MaterialModel::linear, 3000, .3, 1000},
                                        .fixed = clamp_start});
  const std::vector<double> load = end_load(body, size, n, {0, 0, -1e-4});
  settle(body, {.add_load = dead_load(load), .ramp_iterations = 0, .tolerance = 1e-8});
  check_figure({"Beside CalculiX", "C1 small cantilever, tip u_z [m]",
                "C3D4 / " + mesh_name(tet_plain, n), displacement_at(body, {.1, .01, .01}).z(),
                -.0004354194, 1e-6, calculix});
}

TEST(BesideCalculiX, the_large_deflection_under_gravity_of_neo_hookean_tetrahedra_is_the_same) {
  const std::array<int, 3> n = {12, 4, 4};
  Body body = make_box_body(tet_plain, {.size = {.06, .02, .02},
                                        .n = n,
                                        .material = {MaterialModel::neo_hookean, 1e4, .45, 1000},
                                        .fixed = clamp_start,
                                        .gravity = {0, 0, -9.81}});
  settle(body, {.tolerance = 1e-8});
  const Vec3 u = displacement_at(body, {.06, .01, .01});
  const std::string mesh = "C3D4 / " + mesh_name(tet_plain, n);
  check_figure({"Beside CalculiX", "C2 gravity cantilever, tip u_z [m]", mesh, u.z(), -.03050795,
                1e-6, calculix});
  check_figure({"Beside CalculiX", "C2 gravity cantilever, tip u_x [m]", mesh, u.x(), -.007431281,
                1e-6, calculix});
}

static double cube_force(const Variant& variant, double lift) {
  Body body = make_box_body(variant, {.size = {.1, .1, .1},
                                      .n = {4, 4, 4},
                                      .material = {MaterialModel::neo_hookean, 3000, .45, 1000}});
  std::vector<PrescribedNode> ends;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i) {
    const double z = body.mesh.X[i].z();
    if (z < 1e-9 || z > .1 - 1e-9) ends.push_back({.node = i, .u_next = Vec3(0, 0, z / .1 * lift)});
  }
  settle(body, {.prescribed = ends, .tolerance = 1e-8});
  return reaction_of(body, [](const Vec3& X) { return X.z() > .1 - 1e-9; }).z();
}

TEST(BesideCalculiX, the_forces_of_a_stretched_and_a_squeezed_cube_are_the_same) {
  const std::string mesh = "C3D4 / " + mesh_name(tet_plain, {4, 4, 4});
  check_figure({"Beside CalculiX", "C3 bonded cube at +20 %, force [N]", mesh,
                cube_force(tet_plain, .02), 7.231114, 1e-6, calculix});
  check_figure({"Beside CalculiX", "C3 bonded cube at -20 %, force [N]", mesh,
                cube_force(tet_plain, -.02), -11.14741, 1e-6, calculix});
}

TEST(BesideCalculiX, fully_integrated_hexahedra_are_those_of_calculix) {
  const std::string mesh = "C3D8 / " + mesh_name(hex_full, {4, 4, 4});
  check_figure({"Beside CalculiX", "C3 bonded cube of hexahedra at +20 %, force [N]", mesh,
                cube_force(hex_full, .02), 6.818381, 1e-6, calculix});
  check_figure({"Beside CalculiX", "C3 bonded cube of hexahedra at -20 %, force [N]", mesh,
                cube_force(hex_full, -.02), -10.56887, 1e-6, calculix});
}

// Unit cube, three mirror planes, x = 1 moved.
static double uniaxial_stress(const Variant& variant, double stretch) {
  Body body =
      make_box_body(variant, {.size = {1, 1, 1},
                              .n = {1, 1, 1},
                              .material = material_of(MaterialModel::neo_hookean, 1000, 49000),
                              .fixed = [](const Vec3& X) {
                                unsigned mask = X.x() > .5 ? 1 : 0;
                                for (int j = 0; j < 3; ++j)
                                  if (X[j] < 1e-9) mask |= 1U << j;
                                return static_cast<FixedMask>(mask);
                              }});
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    body.state.u[3 * static_cast<std::size_t>(i)] = (stretch - 1) * body.mesh.X[i].x();
  settle(body, {.tolerance = 1e-9});
  return reaction_of(body, [](const Vec3& X) { return X.x() > .5; }).x();
}

TEST(BesideCalculiX, uniaxial_stresses_of_neo_hookean_material_are_the_same) {
  for (const auto& [stretch, expected] : {std::pair{.8, -758.1219}, std::pair{1.5, 1043.554}})
    check_figure({"Beside CalculiX",
                  "C4 uniaxial stretch " + std::to_string(stretch).substr(0, 3) + ", P11 [Pa]",
                  "C3D8 / hex8 1 x 1 x 1", uniaxial_stress(hex_one_point, stretch), expected, 1e-6,
                  calculix});
}

TEST(BesideCalculiX, cooks_membrane_of_plane_strain_triangles_bends_the_same) {
  const int n = 16;
  const double thickness = 3;
  Mesh mesh = make_rectangle(1, 1, n + 1, n + 1);
  BodyOptions options{.materials = {{MaterialModel::linear, 70, 1.0 / 3, 1000}},
                      .solver = {.thickness = thickness}};
  for (Vec3& X : mesh.X) {
    options.fixed.push_back(X.x() < 1e-9 ? 7 : 4);
    X = {48 * X.x(), 44 * X.x() + X.y() * (44 - 28 * X.x()), 0};
  }
  Body body = make_body(std::move(mesh), options);
  const std::vector<double> load = load_by(body, [&](const Vec3& X) {
    const bool is_end = X.y() < 44 + 1e-9 || X.y() > 60 - 1e-9;
    return Vec3(0, X.x() < 48 - 1e-9 ? 0 : 100 * thickness / n / (is_end ? 2 : 1), 0);
  });
  settle(body, {.add_load = dead_load(load), .ramp_iterations = 0, .tolerance = 1e-8});
  check_figure({"Beside CalculiX", "C5 Cook's membrane, plane strain, u_y", "CPE3 / tri3 16 x 16",
                displacement_at(body, {48, 52, 0}).y(), 27.21616, 1e-6, calculix});
}

// Bar .1 x .01 x .01 pulled with 1e-5 N from t = 0 on.
static double bar_end(double dt) {
  const Vec3 size(.1, .01, .01);
  const std::array<int, 3> n = {20, 2, 2};
  Body body = make_box_body(tet_plain, {.size = size,
                                        .n = n,
                                        .material = {MaterialModel::linear, 3000, .3, 1000},
                                        .fixed = clamp_start});
  const std::vector<double> load = end_load(body, size, n, {1e-5, 0, 0});
  const int n_steps = static_cast<int>(std::ceil(.08 / dt));
  for (int k = 0; k < n_steps; ++k)
    forced_step(body, .08 / n_steps, [&](Body& b) {
      for (std::size_t i = 0; i < load.size(); ++i) b.scratch.force[i] += load[i];
    });
  return displacement_at(body, {.1, .005, .005}).x();
}

TEST(BesideCalculiX, the_end_of_a_suddenly_pulled_bar_is_at_the_same_place) {
  // Explicit there with the same step and mass, started half a step apart: (dt / T)^2 of the load's
  // first step. Implicit there with consistent mass, whose waves run faster by (k h)^2 / 12.
  check_figure({"Beside CalculiX", "C6 pulled bar, u_x of the end at .08 s [m], explicit",
                "C3D4 / tet4 20 x 2 x 2", bar_end(1.49912e-4), 4.618521e-6, 1e-5, calculix});
  check_figure({"Beside CalculiX", "C6 pulled bar, u_x of the end at .08 s [m], implicit",
                "C3D4 / tet4 20 x 2 x 2", bar_end(1.49912e-4), 4.623974e-6, 3e-3, calculix});
}
