// V5, V6, V21: waves and modes with closed forms.
#include <numbers>

#include "larger_or_nan.h"
#include "verification_dynamics.h"
#include "verification_figure.h"

using namespace trocar;

using std::numbers::pi;

// The bar of numerics V5: nu = 0, one cell across, traction s on the end x = L from t = 0 on.
struct Bar {
  static constexpr double L = .1, E = 3000, rho = 1000, s = 10;
  int n = 50;
  double c() const { return std::sqrt(E / rho); }
};

static Body bar_body(const Bar& bar) {
  const double h = Bar::L / bar.n;
  return make_box_body(hex_one_point,
                       {.size = {Bar::L, h, h},
                        .n = {bar.n, 1, 1},
                        .material = {MaterialModel::linear, Bar::E, 0, Bar::rho},
                        .fixed = [](const Vec3& X) { return FixedMask(X.x() < 1e-9 ? 7 : 0); }});
}

static void pull_end(Body& body) {
  const double h = body.mesh.X[1].x();
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    if (body.mesh.X[i].x() > Bar::L - 1e-9) body.scratch.force[3 * i] += Bar::s * h * h / 4;
}

// Tip displacement: a triangle between 0 and 2 s L / E with period 4 L / c.
static double exact_tip(const Bar& bar, double t) {
  const double T = 4 * Bar::L / bar.c(), phase = t / T - std::floor(t / T);
  return 2 * Bar::s * Bar::L / Bar::E * (phase < .5 ? 2 * phase : 2 - 2 * phase);
}

// What dispersion does to the kinks at t = 2 L/c and 4 L/c, where the speed of the tip jumps by 2
// V, V = s c / E. Central differences with steps of g h/c and linear elements with lumped mass make
// of w_t + c w_x = 0 the equation w_t + c w_x + c h^2 (1 - g^2)/24 w_xxx = 0: after a way x a kink
// is as if folded with Ai(x / l) / l, l^3 = x h^2 (1 - g^2) / 8, but no sharper than a cell, l >=
// h. With integrals of z Ai(z) over z > 0 = -Ai'(0) = .25882 and, by Parseval, of the square of the
// error of a unit ramp = 1/9:
//   greatest value: 2 V l/c .25882 below the amplitude 2 V L/c,
//   sum of squares over both kinks: (2V)^2 (l_1^3 + l_2^3) / (9 c^3), over the time 4 L/c.
struct KinkError {
  double peak, root_mean_square;  // over the amplitude
};

static KinkError kink_error(const Bar& bar, double g) {
  const double h = Bar::L / bar.n;
  const auto cube = [&](double way) { return h * h * std::max(h, way * (1 - g * g) / 8); };
  const double first = cube(2 * Bar::L), second = cube(4 * Bar::L);
  return {.25882 * std::cbrt(first) / Bar::L,
          std::sqrt((first + second) / (36 * std::pow(Bar::L, 3)))};
}

TEST(V05BarWave, the_end_of_the_bar_follows_the_travelling_step) {
  const Bar bar;
  for (const double factor : {.99, .5}) {
    const KinkError tolerance = kink_error(bar, factor);
    Body body = bar_body(bar);
    const double dt = factor * Bar::L / bar.n / bar.c();
    double square = 0, most = 0;
    int n = 0;
    for (; body.state.time < 4 * Bar::L / bar.c(); ++n) {
      forced_step(body, dt, pull_end);
      const double u = body.state.u[3 * static_cast<std::size_t>(bar.n)];
      square += std::pow(u - exact_tip(bar, body.state.time), 2);
      most = larger_or_nan(most, u);
    }
    const double amplitude = 2 * Bar::s * Bar::L / Bar::E;
    const std::string mesh =
        "hex8 50 x 1 x 1, dt = " + std::to_string(factor).substr(0, 4) + " h/c";
    check_figure(
        {"V5 Bar wave", "greatest tip displacement [m]", mesh, most, amplitude, tolerance.peak});
    check_figure({"V5 Bar wave", "root mean square tip error over the amplitude", mesh,
                  std::sqrt(square / n) / amplitude, 0, tolerance.root_mean_square});
  }
}

// V6: u = (cos sin, -sin cos)(pi x/a, pi y/a) of a free square prism, omega = sqrt 2 pi c_s / a for
// any Poisson ratio.
static double lame_error(int n, double nu, Variant variant = hex_one_point) {
  const double a = .04, E = 3000;
  variant.hourglass = .2;
  Body body = make_box_body(variant, {.size = {a, a, a / n},
                                      .n = {n, n, 1},
                                      .material = {MaterialModel::neo_hookean, E, nu, 1000}});
  const double T = measured_period(
      body,
      [a](const Vec3& X) {
        const double x = pi * X.x() / a, y = pi * X.y() / a;
        return Vec3(std::cos(x) * std::sin(y), -std::sin(x) * std::cos(y), 0);
      },
      .5);
  return T / (std::sqrt(2) * a / std::sqrt(E / (2 * (1 + nu)) / 1000)) - 1;
}

TEST(V06LameMode, one_point_hexahedra_have_the_known_error_which_falls_with_the_mesh) {
  for (const double nu : {.3, .49}) {
    const double exact = .04 * std::sqrt(2) / std::sqrt(3000 / (2 * (1 + nu)) / 1000);
    const double coarse = lame_error(8, nu), fine = lame_error(16, nu);
    // numerics V6: +2.6 % at n = 8, +0.5 % at n = 16, for c_mu = 0.2. The last digit is rounded,
    // and the time step shortens the period by (omega dt)^2 / 24, below 0.1 %.
    EXPECT_NEAR(coarse, .026, .0025) << nu;
    EXPECT_NEAR(fine, .0050, .0015) << nu;
    check_figure({"V6 Lame mode", "period at nu = " + std::to_string(nu).substr(0, 4) + " [s]",
                  "hex8 16 x 16 x 1", exact * (1 + fine), exact, .0065, "closed form",
                  order_between(coarse, fine)});
  }
}

TEST(V06LameMode, the_other_formulations_converge_to_the_closed_form_except_those_that_lock) {
  struct Case {
    Variant variant;
    double tolerance;
  };
  const double nu = .49, exact = .04 * std::sqrt(2) / std::sqrt(3000 / (2 * (1 + nu)) / 1000);
  for (const Case& c : {Case{hex_enhanced, .0065}, Case{tet_nodal_pressure, .02},
                        Case{hex_full, .08}, Case{tet_plain, .3}}) {
    const double coarse = lame_error(8, nu, c.variant), fine = lame_error(16, nu, c.variant);
    const bool locks = c.tolerance > .05;
    check_figure({"V6 Lame mode", "period at nu = 0.49 [s]", mesh_name(c.variant, {16, 16, 1}),
                  exact * (1 + fine), exact, c.tolerance,
                  locks ? "closed form (locks)" : "closed form", order_between(coarse, fine)});
    if (locks) {
      EXPECT_LT(fine, -.01);
    }
  }
}

TEST(V06LameMode, the_error_does_not_grow_near_incompressibility) {
  // Elements that lock shorten the period by 2 to 8 % there (numerics V6).
  EXPECT_NEAR(lame_error(8, .3), lame_error(8, .499), .003);
}

// V21: normal components held on X_i = 0, tangential ones on X_i = L.
static Body swinging_cube(const Variant& variant, int n, double nu) {
  const double L = .1;
  return make_box_body(variant, {.size = {L, L, L},
                                 .n = {n, n, n},
                                 .material = {MaterialModel::linear, 3000, nu, 1000},
                                 .fixed = [L](const Vec3& X) {
                                   unsigned mask = 0;
                                   for (int j = 0; j < 3; ++j) {
                                     if (X[j] < 1e-9) mask |= 1U << j;
                                     if (X[j] > L - 1e-9) mask |= 7U & ~(1U << j);
                                   }
                                   return static_cast<FixedMask>(mask);
                                 }});
}

static double swing_period(const Variant& variant, int n, double nu, const Vec3& a) {
  Body body = swinging_cube(variant, n, nu);
  return measured_period(
      body,
      [&](const Vec3& X) {
        const Vec3 p = pi / .2 * X;
        return Vec3(a.x() * std::sin(p.x()) * std::cos(p.y()) * std::cos(p.z()),
                    a.y() * std::cos(p.x()) * std::sin(p.y()) * std::cos(p.z()),
                    a.z() * std::cos(p.x()) * std::cos(p.y()) * std::sin(p.z()));
      },
      .5);
}

TEST(V21SwingingCube, periods_of_the_volume_and_the_shear_mode_are_the_closed_form) {
  struct Case {
    const char* name;
    double nu;
    Vec3 a;
  };
  for (const Case& c : {Case{"volume", .3, {1, 1, 1}}, Case{"volume", .49, {1, 1, 1}},
                        Case{"shear", .3, {1, -1, 0}}, Case{"shear", .49, {1, 1, -2}}}) {
    const double mu = 3000 / (2 * (1 + c.nu)), lambda = 2 * mu * c.nu / (1 - 2 * c.nu);
    const double speed = std::sqrt((c.a.sum() > 0 ? lambda + 2 * mu : mu) / 1000);
    const double exact = 2 * pi / (std::sqrt(3) / 2 * pi * speed / .1);
    for (const Variant& variant : {hex_one_point, hex_enhanced, tet_plain}) {
      const double coarse = swing_period(variant, 4, c.nu, c.a);
      const double fine = swing_period(variant, 8, c.nu, c.a);
      // omega^2 of linear elements and lumped mass is off by about (k h)^2 / 12 = .7 % at n = 8 for
      // each of three directions; tetrahedra lock in shear at nu = .49.
      const bool locks = variant.elements != BoxElements::hex8 && c.nu > .4 && c.a.sum() == 0;
      check_figure({"V21 Swinging cube",
                    std::string("period of the ") + c.name +
                        " mode at nu = " + std::to_string(c.nu).substr(0, 4) + " [s]",
                    mesh_name(variant, {8, 8, 8}), fine, exact, locks ? .3 : .02,
                    locks ? "closed form (locks)" : "closed form",
                    order_between(coarse - exact, fine - exact)});
    }
  }
}
