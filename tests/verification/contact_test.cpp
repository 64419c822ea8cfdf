// V23, V24: what Coulomb's law and energy say of nodes that slide and bounce on a rigid plane.
#include <cmath>

#include "collision_contacts.h"
#include "larger_or_nan.h"
#include "verification_figure.h"

using namespace trocar;

constexpr double g = 9.81;

TEST(V24Bounce, a_node_keeps_nothing_of_the_speed_of_impact) {
  // numerics 1.10: restitution 0 of a kinematic contact. The node stops in the step in which it
  // would pass the plane.
  constexpr double speed = .5;
  double worst = 0;
  for (int phase = 0; phase < 50; ++phase) {
    ContactBench bench({Vec3::Zero()}, {2e-4});
    bench.prepare({node_contact(0, Vec3::UnitZ())});
    bench.u[2] = (3 + phase / 50.) * speed * bench.dt;  // reaches the plane after so many steps
    bench.v[2] = -speed;
    for (int k = 0; k < 60; ++k) bench.step(Vec3(0, 0, 0));
    worst = larger_or_nan(worst, std::abs(bench.v[2]) / speed);
  }
  check_figure({"V24 Bounce", "worst restitution over 50 phases", "one node", worst, 0, 1e-14,
                "kinematic contact"});
}

// A triangle of three equal nodes lies on a plane of normal n.
static ContactBench block_on_plane(const Vec3& n, double friction) {
  constexpr double m = 1e-4;
  ContactBench bench({Vec3(0, 0, 0), Vec3(6e-3, 0, 0), Vec3(0, 6e-3, 0)}, {m, m, m});
  bench.options.friction = friction;
  const Vec3 point = n.dot(bench.X[0] / 3 + bench.X[1] / 3 + bench.X[2] / 3) * n;
  bench.prepare(
      {{.node = {0, 1, 2}, .weight = {1. / 3, 1. / 3, 1. / 3}, .point = point, .normal = n}});
  return bench;
}

static double speed_along(const ContactBench& bench, const Vec3& direction) {
  return Vec3::Map(bench.v.data()).dot(direction);
}

constexpr const char* sliding = "V23 Sliding block";

TEST(V23SlidingBlock, stops_after_the_distance_and_the_time_of_coulombs_law) {
  ContactBench bench = block_on_plane(Vec3::UnitZ(), .3);
  for (std::size_t i = 0; i < 9; i += 3) bench.v[i] = 1;
  const double start = bench.u[0];
  int steps_to_stop = 0;
  for (int k = 1; k <= 10000; ++k) {
    bench.step(Vec3(0, 0, -g));
    if (steps_to_stop == 0 && bench.v[0] < 1e-12) steps_to_stop = k;
  }
  // The sum of v dt over the steps is v0 dt / 2 shorter than the integral; a step is 1e-4 s.
  check_figure({sliding, "distance [m]", "three nodes", bench.u[0] - start, 1 / (2 * .3 * g),
                5.01e-5 / .17, "Coulomb"});
  check_figure({sliding, "time [s]", "three nodes", steps_to_stop * bench.dt, 1 / (.3 * g),
                1.01e-4 / .34, "Coulomb"});
  EXPECT_LT(std::abs(bench.v[0]), 1e-12);
}

TEST(V23SlidingBlock, slides_down_an_incline_steeper_than_friction_holds) {
  const double sine = .6, cosine = .8, mu = .5;
  ContactBench bench = block_on_plane(Vec3(-sine, 0, cosine), mu);
  const int n = 2000;
  for (int k = 0; k < n; ++k) bench.step(Vec3(0, 0, -g));
  const double t = n * bench.dt, a = g * (sine - mu * cosine);
  check_figure({sliding, "speed down an incline after .2 s [m/s]", "three nodes",
                speed_along(bench, Vec3(-cosine, 0, -sine)), a * t, 1e-12, "Coulomb"});
}

TEST(V23SlidingBlock, stays_on_a_flatter_incline) {
  ContactBench bench = block_on_plane(Vec3(-.28, 0, .96), .5);
  const std::vector<double> start = bench.u;
  for (int k = 0; k < 10000; ++k) bench.step(Vec3(0, 0, -g));
  const double drift = (Vec3::Map(bench.u.data()) - Vec3::Map(start.data())).norm();
  // numerics 1.10: below 1e-6 of its size in 1e4 steps.
  check_figure({sliding, "drift on an incline that holds it, over its size", "three nodes",
                drift / 6e-3, 0, 1e-6, "Coulomb"});
}
