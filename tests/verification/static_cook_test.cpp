// V10, Cook's membrane in plane strain and plane stress: corners (0,0) (48,44) (48,60) (0,44), left
// edge clamped, uniform shear traction on the right one; displacement of its middle (48,52).
#include "dead_load.h"
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

static Vec3 cook_map(const Vec3& s) {
  return {48 * s.x(), 44 * s.x() + s.y() * (44 - 28 * s.x()), s.z()};
}

// A slab of n x n hexahedra as thick as they are wide, or triangles of the same thickness.
static Body cook_body(int n, Formulation formulation, const Material& material) {
  const double thickness = 48.0 / n;
  const bool is_plane = shape_of(formulation) == ElementType::tri3;
  Mesh mesh = is_plane
                  ? make_rectangle(1, 1, n + 1, n + 1)
                  : make_box(Vec3(0, 0, 0), Vec3(1, 1, thickness), {n, n, 1}, BoxElements::hex8);
  BodyOptions options{.materials = {material},
                      .solver = with(formulation, {.hourglass = .1, .thickness = thickness})};
  for (Vec3& X : mesh.X) {
    options.fixed.push_back(X.x() < 1e-9 ? 7 : 4);
    X = cook_map(X);
  }
  return make_body(std::move(mesh), options);
}

static Vec3 cook_middle(int n, Formulation formulation, const Material& material, double force) {
  Body body = cook_body(n, formulation, material);
  const double layers = shape_of(formulation) == ElementType::tri3 ? 1 : 2;
  const double thickness = 48.0 / n;
  const std::vector<double> load = load_by(body, [&](const Vec3& X) {
    if (X.x() < 48 - 1e-9) return Vec3(0, 0, 0);
    const bool is_end = X.y() < 44 + 1e-9 || X.y() > 60 - 1e-9;
    return Vec3(0, force * thickness / layers / n / (is_end ? 2 : 1), 0);
  });
  settle(body, {.add_load = dead_load(load), .ramp_iterations = 4000, .tolerance = 1e-5});
  return displacement_at(body, {48, 52, 0});
}

struct CookCase {
  const char* name;
  Material material;
  double u_y;
  bool do_triangles_lock;
};

static std::vector<CookCase> cook_cases() {
  const double mu = 80.194;
  return {
      {"b, linear, nu = 1/3", {MaterialModel::linear, 70, 1.0 / 3, 1}, 30.749, false},
      {"c, linear, nu = .4999", {MaterialModel::linear, 240.565, .4999, 1}, 7.695, true},
      {"d, neo-Hookean, nu = .3", {MaterialModel::neo_hookean, 2 * mu * 1.3, .3, 1}, 8.9718, false},
      {"e, neo-Hookean, nu = .4999", material_of(MaterialModel::neo_hookean, mu, 400889.806, 1),
       6.964, true},
      {"f, neo-Hookean, nu = .49",
       {MaterialModel::neo_hookean, 2 * mu * 1.49, .49, 1},
       7.0737,
       true}};
}

static double check_cook(const CookCase& c, int n, Formulation formulation, double tolerance,
                         double force = 100) {
  const bool is_plane = shape_of(formulation) == ElementType::tri3;
  const std::string mesh = std::string(name_of(formulation)) + " " + std::to_string(n) + " x " +
                           std::to_string(n) + (is_plane ? " x 2" : "");
  const double u_y = cook_middle(n, formulation, c.material, force).y();
  check_figure({"V10 Cook's membrane", std::string("u_y, ") + c.name, mesh, u_y, c.u_y, tolerance,
                "implicit Q3 to Q5 mixed solver"});
  return u_y;
}

TEST(V10CooksMembrane, hexahedra_bend_as_the_mixed_solver_says_whatever_the_poisson_ratio) {
  // numerics V10: about 3 % at 16 x 16, 1 % at 32 x 32.
  for (const CookCase& c : cook_cases()) {
    check_cook(c, 16, Formulation::hex8_one_point, .03);
    check_cook(c, 16, Formulation::hex8_enhanced, .03);
    if (is_report()) check_cook(c, 32, Formulation::hex8_one_point, .01);
    if (is_report()) check_cook(c, 32, Formulation::hex8_enhanced, .01);
  }
}

TEST(V10CooksMembrane, fully_integrated_hexahedra_lock_near_incompressibility) {
  for (const CookCase& c : cook_cases()) {
    if (!c.do_triangles_lock) {
      check_cook(c, 16, Formulation::hex8_full, .03);
    } else if (is_report() || c.material.model == MaterialModel::linear) {
      // Too stiff by more than the 3 % within which the others are; by how much is no promise.
      EXPECT_LT(check_cook(c, 16, Formulation::hex8_full, 1), (1 - .03) * c.u_y);
    }
  }
}

// Linear triangles are too stiff, by an amount that falls faster than h but, because of the clamped
// corner's singularity, not quite as h^2: halving h halves it at least.
static void check_triangles(const CookCase& c, Formulation formulation, double force) {
  const double coarse = check_cook(c, 16, formulation, .12, force);
  const double fine = check_cook(c, 32, formulation, .04, force);
  EXPECT_LT(fine, c.u_y);
  EXPECT_LT(c.u_y - fine, .5 * (c.u_y - coarse));
}

TEST(V10CooksMembrane, triangles_bend_as_the_mixed_solver_says_where_they_do_not_lock) {
  check_triangles(
      {"a, linear, nu = 1/3, plane stress", {MaterialModel::linear, 1, 1.0 / 3, 1}, 23.968},
      Formulation::tri3_plane_stress, 1);
  for (const CookCase& c : cook_cases())
    if (!c.do_triangles_lock) check_triangles(c, Formulation::tri3_plane_strain, 100);
}
