// V22, a rigid flat punch, without friction or sticking, on a bonded elastic layer, against the
// formulas of the half space with what the layer's finite thickness adds. Linear material; the
// punch is its face, pushed down.
#include <numbers>

#include "verification_dynamics.h"
#include "verification_figure.h"
#include "verification_layer.h"
#include "verification_statics.h"

using namespace trocar;

using std::numbers::pi;

namespace {

constexpr double depth = 1e-3, punch_radius = 5e-3, width = .1;

// Sneddon's 2 a E* d, and what the layer adds to the half space's displacement at the distance r of
// a force F, in Dimitriadis' series F / (pi E* h) [ alpha0 + beta0 r^2 / h^2 + … ]: its mean over
// two points of the pressure F / (2 pi a sqrt(a^2 - r^2)), whose r^2 is 2/3 a^2 on average, so that
//   d = F / (2 a E*) [ 1 + 2/pi alpha0 a/h + 8/(3 pi) beta0 (a/h)^3 + O((a/h)^5) ].
double punch_force(double thickness) {
  const double x = punch_radius / thickness;
  return 2 * punch_radius * plane_strain_E * depth /
         (1 + 2 / pi * alpha0 * x + 8 / (3 * pi) * beta0 * x * x * x);
}

// Of a punch that sticks over one without friction, on a half space (Mossakovskii 1963, Spence
// 1968): 4 mu a d log(3 - 4 nu) / (1 - 2 nu) over 2 a E* d; both 8 mu a d at nu = 1/2.
const double stick_factor = std::log(3 - 4 * layer_nu) * (1 - layer_nu) / (1 - 2 * layer_nu);

// A quarter of the layer: n cells from the axis to the rim of the punch and 2 n from there to the
// end, finer towards the rim, where the pressure has its pole; 2 n through the thickness.
struct PunchMesh {
  int n = 8;
  double thickness = .05;

  double radius_of(double s) const {  // s: 0 axis, 1 rim, 3 end
    if (s <= 1) return punch_radius * s * (2 - s);
    const double t = (s - 1) / 2;
    return punch_radius + (width - punch_radius) * t * t * (.1 + .9 * t);
  }
  // Rings of cells are squares at the axis and at the end, a circle at the rim.
  Vec3 operator()(const Vec3& s) const {
    const double ring = std::max(s.x(), s.y()), r = radius_of(ring);
    const double t = 1 - s.z(), z = -thickness * t * t * (.2 + .8 * t);
    if (ring == 0) return {0, 0, z};
    // On the diagonal r (1 - (1 - 1/sqrt 2) roundness) must grow with r.
    const double roundness = ring <= 1 ? r / punch_radius : (3 - ring) / 2;
    const Vec3 flat(s.x(), s.y(), 0), square = flat / ring, circle = flat / flat.norm();
    return r * ((1 - roundness) * square + roundness * circle) + Vec3(0, 0, z);
  }
};

// `held`: the components in which the punch holds the face.
double measured_force(const PunchMesh& mesh, FixedMask held) {
  std::vector<bool> is_punch;
  Body body = make_box_body(
      hex_one_point,
      {.size = {3, 3, 1},
       .n = {3 * mesh.n, 3 * mesh.n, 2 * mesh.n},
       .material = {MaterialModel::linear, layer_E, layer_nu, 1000},
       .fixed =
           [&](const Vec3& s) {
             is_punch.push_back(s.z() > 1 - 1e-9 && std::max(s.x(), s.y()) < 1 + 1e-9);
             if (s.z() < 1e-9) return FixedMask{7};
             return static_cast<FixedMask>((s.x() < 1e-9 ? 1 : 0) | (s.y() < 1e-9 ? 2 : 0) |
                                           (is_punch.back() ? held : 0));
           },
       .map = mesh});
  // The face of the punch has moved down: its support in z has the displacement to begin with.
  for (std::size_t i = 0; i < is_punch.size(); ++i)
    if (is_punch[i]) body.state.u[3 * i + 2] = -depth;
  settle(body, {.tolerance = 1e-5});
  double F = 0;
  for (std::size_t i = 0; i < is_punch.size(); ++i)
    if (is_punch[i]) F += body.scratch.force[3 * i + 2];
  return 4 * F;
}

constexpr FixedMask along_z = 4, everywhere = 7;

void check_punch(const std::string& punch, FixedMask held, double factor) {
  // Cells at the rim are as wide as a / n^2: with them the pole of the pressure, a displacement
  // like the root of the distance, costs no more than h^2 elsewhere.
  const int n = is_report() ? 8 : 4;
  const double coarse = measured_force({.n = n / 2}, held), fine = measured_force({.n = n}, held);
  const double exact = factor * punch_force(PunchMesh{}.thickness);
  check_figure({"V22 Flat punch on a bonded layer", "force, " + punch + ", h = 0.05 m [N]",
                mesh_name(hex_one_point, {3 * n, 3 * n, 2 * n}) + ", graded", fine, exact,
                two_mesh_tolerance(coarse, fine, exact), "Sneddon, Spence, Dimitriadis et al. 2002",
                order_between(coarse - exact, fine - exact)});
}

}  // namespace

TEST(V22Punch, the_formulas_are_those_of_the_table_for_a_thick_layer) {
  EXPECT_NEAR(punch_force(1e6), .0394788, 1e-7);  // digits printed, the rest cut off
  // 8 mu a d, within the square of 1 - 2 nu = .02.
  EXPECT_NEAR(
      stick_factor * punch_force(1e6) / (8 * layer_E / (2 * (1 + layer_nu)) * punch_radius * depth),
      1 / (2 * (1 - layer_nu)), 4e-4);
}

TEST(V22Punch, a_rigid_flat_punch_feels_the_layer_of_the_formula) {
  check_punch("no friction", along_z, 1);
}

// The tissue under it would slide by 1 - 2 nu of what it sinks: the layer adds to both alike.
TEST(V22Punch, a_rigid_flat_punch_that_sticks_feels_hardly_more) {
  check_punch("sticks", everywhere, stick_factor);
}
