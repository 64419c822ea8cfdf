// V1, V3, V4, V29: one element or one strain. Their details are checked where the formulas are
// (golden_test.cpp, element_setup_test.cpp, material_golden_test.cpp, history_test.cpp); here whole
// bodies give the figures of the table.
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

namespace {

constexpr double mu = 1000, K = 49000;

// V1: energy under u_a,i = 1e-3 sin(1 + 3a + 1.7 i (a+1)), to the digits printed or those of
// single.
void check_golden(const Variant& variant, const Mesh& mesh, double expected, double tolerance) {
  Body body = make_body(mesh, {.materials = {material_of(MaterialModel::neo_hookean, mu, K)},
                               .solver = solver_options(variant)});
  for (int a = 0; a < body.model.n_local; ++a)
    for (int i = 0; i < 3; ++i)
      body.state.u[3 * a + i] = 1e-3 * std::sin(1 + 3 * a + 1.7 * i * (a + 1));
  check_figure({"V1 Golden vectors", "energy [J]", std::string(variant.name) + ", distorted",
                stored_energy(body), expected, tolerance, "independent program, golden.txt"});
}

// V3: greatest force under a rotation of 1.1 rad about (1, 2, 2) / 3, over K h^2.
void check_rotation(Variant variant, Precision precision, double tolerance) {
  variant.precision = precision;
  const double h = .01;
  Mesh mesh = make_box(Vec3::Zero(), Vec3(2 * h, 2 * h, 2 * h), {2, 2, 2}, variant.elements);
  jitter(mesh, .25, 1);
  Body body = make_body(mesh, {.materials = {material_of(MaterialModel::neo_hookean, mu, K)},
                               .solver = solver_options(variant)});
  const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, 2, 2) / 3).toRotationMatrix();
  displace(body, [&](const Vec3& X) { return Vec3(R * X - X); });
  check_figure({"V3 Rigid rotation", "greatest force over K h^2",
                mesh_name(variant, {2, 2, 2}) + " " + name_of(precision),
                largest(force(body)) / (K * h * h), 0, tolerance, "no strain"});
}

// V4: P11 of a bar of stretch l that nothing holds sideways, relaxed from straight sides.
double bar_stress(MaterialModel model, double l) {
  const double edge = .01;
  Body body = make_box_body(hex_one_point,
                            {.size = {edge, edge, edge},
                             .n = {1, 1, 1},
                             .material = material_of(model, mu, K),
                             .fixed = [&](const Vec3& X) {
                               // Mirror planes at 0; the end stays where it is put.
                               return static_cast<FixedMask>(1 | (X.y() < .5 * edge ? 2 : 0) |
                                                             (X.z() < .5 * edge ? 4 : 0));
                             }});
  displace(body, [&](const Vec3& X) { return Vec3((l - 1) * X.x(), 0, 0); });
  settle(body, {.tolerance = 1e-9});
  return reaction_of(body, [&](const Vec3& X) { return X.x() > .5 * edge; }).x() / (edge * edge);
}

void check_bar(MaterialModel model, const std::string& name, double l, double expected) {
  check_figure({"V4 Homogeneous states",
                "P11 at stretch " + std::to_string(l).substr(0, 3) + ", " + name + " [Pa]",
                "hex8 1 x 1 x 1", bar_stress(model, l), expected, 1e-6, "independent program"});
}

}  // namespace

TEST(V01Golden, energies_of_distorted_elements_are_those_of_the_independent_program) {
  Variant hex = hex_one_point, hex_single = hex_one_point_single, nodal = tet_nodal_pressure;
  hex.hourglass = hex_single.hourglass = .25;
  nodal.own_volume_stiffness = 0;
  check_golden(hex, irregular_elements()[2], 6.543774386906e-4, 1e-11);
  check_golden(hex_single, irregular_elements()[2], 6.543774386906e-4, 1e-5);
  const Mesh tetrahedra = irregular_patch(Formulation::tet4_nodal_pressure);
  check_golden(tet_plain, tetrahedra, 2.402757759831e-4, 1e-11);
  check_golden(nodal, tetrahedra, 1.619106166792e-4, 1e-11);
}

TEST(V03Rotation, of_a_distorted_body_makes_no_force) {
  for (const Variant& variant :
       {hex_one_point, hex_enhanced, hex_full, tet_plain, tet_nodal_pressure}) {
    check_rotation(variant, Precision::in_double, 3e-15);  // numerics V3
    check_rotation(variant, Precision::in_single, 6e-7);
  }
}

TEST(V04Homogeneous, bars_have_the_stress_of_the_table) {
  for (const auto& [l, P11] : {std::pair{.6, -2165.899144}, std::pair{1.5, 1043.554101}})
    check_bar(MaterialModel::neo_hookean, "neo-Hookean", l, P11);
  check_bar(MaterialModel::mooney_rivlin, "Mooney-Rivlin", 1.5, 906.605831);
  check_bar(MaterialModel::yeoh, "Yeoh", 1.5, 1377.391356);
  check_bar(MaterialModel::ogden, "Ogden", 1.5, 827.768384);
  check_bar(MaterialModel::transversely_isotropic, "transversely isotropic", 1.5, 7554.791958);
  check_bar(MaterialModel::holzapfel_gasser_ogden, "Holzapfel-Gasser-Ogden", 1.2, 1620.690258);
}

TEST(V29Viscoelastic, a_sheared_body_relaxes_as_its_branch_says) {
  Material material = material_of(MaterialModel::neo_hookean, mu, K);
  material.prony = {{.5, .1}};
  for (const Variant& variant : {hex_one_point, hex_full, tet_plain}) {
    Body body = make_box_body(variant, {{.02, .01, .01}, {2, 1, 1}, material});
    displace(body, [](const Vec3& X) { return Vec3(.2 * X.y(), 0, 0); });  // det F = 1
    const double start = largest(force(body));
    for (const auto& [t, share] :
         {std::pair{.05, .80326533}, std::pair{.1, .68393972}, std::pair{.5, .50336897}}) {
      body.state.time = t;
      check_figure({"V29 Viscoelastic", "G / G0 at " + std::to_string(t).substr(0, 4) + " s",
                    mesh_name(variant, {2, 1, 1}), largest(force(body)) / start, share, 1e-8,
                    "closed form"});
    }
  }
}
