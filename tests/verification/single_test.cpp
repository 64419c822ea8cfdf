// What elements in single precision lose beside the same ones in double: rounding of forces, and
// what it makes of trajectories.
#include "larger_or_nan.h"
#include "verification_dynamics.h"
#include "verification_figure.h"

using namespace trocar;

constexpr const char* single_problem = "Single precision beside double";

static Variant in_single(Variant variant) {
  variant.precision = Precision::in_single;
  return variant;
}

// Greatest difference over the greatest force in a random strain of this size.
static double force_error(const Variant& variant, double nu, double strain) {
  const BoxProblem cube{.size = {.04, .04, .04},
                        .n = {4, 4, 4},
                        .material = {MaterialModel::neo_hookean, 3000, nu, 1000}};
  Body exact = make_box_body(variant, cube), rounded = make_box_body(in_single(variant), cube);
  shake(exact.state.u, strain * .01, 5);
  rounded.state.u = exact.state.u;
  const std::vector<double>&f = force(exact), &g = force(rounded);
  return largest_difference(f, g) / largest(f);
}

TEST(SinglePrecision, rounding_of_forces_does_not_grow_when_strains_are_small) {
  // A force is a sum of some tens of terms, rounded to 6e-8 each (numerics 1.4: 3.6e-7 in stress).
  for (const Variant& variant :
       {hex_one_point, hex_enhanced, hex_full, tet_plain, tet_nodal_pressure})
    for (const double strain : {1e-1, 1e-3, 1e-5})
      check_figure({single_problem,
                    "forces at nu = 0.49 and a strain of " + std::to_string(strain).substr(0, 7),
                    mesh_name(variant, {4, 4, 4}), force_error(variant, .49, strain), 0, 3e-6,
                    "relative"});
}

static Body swing(const Variant& variant) {
  Body body = make_box_body(
      variant, {.size = {.1, .02, .02},
                .n = {10, 2, 2},
                .material = {MaterialModel::neo_hookean, 3000, .45, 1000},
                .fixed = [](const Vec3& X) { return FixedMask(X.x() < 1e-9 ? 7 : 0); }});
  set_velocity(body, [](const Vec3& X) { return Vec3(0, 0, .3 * std::pow(X.x() / .1, 2)); });
  return body;
}

// Greatest difference of displacements over the greatest displacement, over all of the motion.
static double trajectory_error(const Variant& variant, double factor, int n_steps) {
  Body exact = swing(variant), rounded = swing(in_single(variant));
  const double dt = factor * least_element_step(exact);
  double most = 0, error = 0;
  for (int k = 0; k < n_steps; ++k) {
    step(exact, dt);
    step(rounded, dt);
    most = larger_or_nan(most, largest(exact.state.u));
    if (k % 100 != 99) continue;
    error = larger_or_nan(error, largest_difference(exact.state.u, rounded.state.u));
  }
  return error / most;
}

TEST(SinglePrecision, trajectories_of_a_large_swing_stay_together) {
  // numerics 1.12: 6e-6 with the state in double after 3e4 steps of .9; here the greatest over the
  // whole motion, whose phase drifts a little.
  const int n_steps = is_report() ? 30000 : 5000;
  for (const Variant& variant : {hex_one_point, tet_plain})
    for (const double factor : {.1, .9})
      check_figure({single_problem,
                    "displacement over " + std::to_string(n_steps) + " steps at " +
                        std::to_string(factor).substr(0, 3) + " dt_c",
                    mesh_name(variant, {10, 2, 2}), trajectory_error(variant, factor, n_steps), 0,
                    1e-4, "relative"});
}
