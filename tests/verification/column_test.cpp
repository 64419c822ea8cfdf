// V19, V20: the bending and the twisting column [0,1] x [0,6] x [0,1], at large strain, against
// computations with many more elements (numerics 2).
#include <numbers>

#include "verification_dynamics.h"
#include "verification_figure.h"

using namespace trocar;

static Body column(const Variant& variant, int n, double centre) {
  return make_box_body(
      variant, {.size = {1, 6, 1},
                .n = {n, 6 * n, n},
                .material = {MaterialModel::neo_hookean, 17e6, .45, 1100},
                .fixed = [](const Vec3& X) { return FixedMask(X.y() < 1e-9 ? 7 : 0); },
                .map = [centre](const Vec3& X) { return Vec3(X - Vec3(centre, 0, centre)); }});
}

struct Peak {
  double u = 0, t = 0;
};

// The first greatest u_x of the middle of the top, from the parabola through three samples.
static Peak first_peak(Body& body) {
  const Vec3 top(.5, 6, .5);
  std::vector<std::array<double, 2>> samples;
  advance(body, .5, .9, [&](const Body& b) {
    samples.push_back({b.state.time, displacement_at(b, top).x()});
  });
  std::size_t k = 1;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i)
    if (samples[i][1] > samples[k][1]) k = i;
  const double h = samples[k + 1][0] - samples[k][0], a = samples[k - 1][1], b = samples[k][1],
               c = samples[k + 1][1];
  const double s = (a - c) / (2 * (a - 2 * b + c));
  return {b - (a - c) * s / 4, samples[k][0] + s * h};
}

static Peak bending_peak(const Variant& variant, int n) {
  Body body = column(variant, n, 0);
  set_velocity(body, [](const Vec3& X) { return Vec3(10 * X.y() / 6, 0, 0); });
  return first_peak(body);
}

static void check_peak(const Variant& variant, double u_tolerance, double t_tolerance) {
  const std::string name = "V19 Bending column", mesh = mesh_name(variant, {8, 48, 8});
  const double u = 2.9955, t = .4535;
  const Peak coarse = bending_peak(variant, 4), fine = bending_peak(variant, 8);
  check_figure({name, "first peak of u_x [m]", mesh, fine.u, u, u_tolerance, "implicit, +-.001",
                order_between(coarse.u - u, fine.u - u)});
  check_figure({name, "time of the peak [s]", mesh, fine.t, t, t_tolerance, "implicit, +-.0008",
                order_between(coarse.t - t, fine.t - t)});
}

TEST(V19BendingColumn, first_peak_converges_to_that_of_the_fine_mesh) {
  // numerics V19 has +.3 % and +1.4 % at n = 4 with another stabilisation; here +1.5 % and +2.5 %,
  // so a quarter of it at n = 8, and the reference is known to .03 % and .2 %.
  check_peak(hex_one_point, .005, .007);
  check_peak(hex_enhanced, .005, .01);
  if (is_report()) check_peak(tet_nodal_pressure, .03, .03);
}

static std::vector<Vec3> twisted_corner(int n, const std::vector<double>& times) {
  Body body = column(hex_one_point, n, .5);
  set_velocity(body, [](const Vec3& X) {
    return Vec3(105 * std::sin(std::numbers::pi * X.y() / 12) * Vec3(X.z(), 0, -X.x()));
  });
  std::vector<Vec3> u;
  for (const double t : times) {
    advance(body, t, .9);
    u.push_back(displacement_at(body, {.5, 6, .5}));
  }
  return u;
}

TEST(V20TwistingColumn, the_corner_follows_the_fine_mesh) {
  const int n = is_report() ? 32 : 16;
  const std::vector<double> time = {.025, .05, .1};
  const std::vector<Vec3> corner = {
      {-.5316, -.112, -1.229}, {-1.1264, -.0762, -.1707}, {-.2945, .0293, .1688}};
  const std::vector<Vec3> coarse = twisted_corner(n / 2, time), fine = twisted_corner(n, time);
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double error = (fine[k] - corner[k]).norm();
    // numerics V20 knows each component to .003, which is what 32 cells, those of the reference,
    // are held to. 16 cells get Roache's index, |coarse - fine|, beside it.
    const double known = .003 * std::sqrt(3);
    const double tolerance = is_report() ? known : known + (coarse[k] - fine[k]).norm();
    check_figure({"V20 Twisting column",
                  "distance of the corner to the reference at t = " +
                      std::to_string(time[k]).substr(0, 5) + " [m]",
                  mesh_name(hex_one_point, {n, 6 * n, n}), error, 0, tolerance, "hex8, n = 32",
                  order_between((coarse[k] - corner[k]).norm(), error)});
  }
}
