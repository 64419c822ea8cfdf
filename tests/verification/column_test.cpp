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

TEST(V20TwistingColumn, the_corner_follows_the_fine_mesh) {
  const int n = 16;
  Body body = column(hex_one_point, n, .5);
  set_velocity(body, [](const Vec3& X) {
    return Vec3(105 * std::sin(std::numbers::pi * X.y() / 12) * Vec3(X.z(), 0, -X.x()));
  });
  const std::vector<std::pair<double, Vec3>> corner = {{.025, {-.5316, -.112, -1.229}},
                                                       {.05, {-1.1264, -.0762, -.1707}},
                                                       {.1, {-.2945, .0293, .1688}}};
  for (const auto& [t, expected] : corner) {
    advance(body, t, .9);
    const Vec3 u = displacement_at(body, {.5, 6, .5});
    // The reference itself is known to .003, and numerics V20 has the spread from n = 16 to n = 32;
    // the corner has moved by about 1 m and is .054 m off at n = 8, .020 m here.
    check_figure(
        {"V20 Twisting column",
         "distance of the corner to the reference at t = " + std::to_string(t).substr(0, 5) +
             " [m]",
         mesh_name(hex_one_point, {n, 6 * n, n}), (u - expected).norm(), 0, .025, "hex8, n = 32"});
  }
}
