// V23, V24: what Coulomb's law and energy say of nodes that slide and bounce on a rigid plane.
#include <cmath>

#include "collision_contacts.h"
#include "verification_figure.h"

using namespace trocar;

constexpr double g = 9.81;

TEST(V24Bounce, a_node_rebounds_with_the_speed_of_impact) {
  // numerics 1.10: .995 to 1.005 at kappa = .1; the default .2 leaves and takes more.
  for (const auto& [kappa, tolerance] : {std::pair{.1, .005}, std::pair{.2, .02}}) {
    constexpr double speed = .5;
    double worst = 1;
    for (int phase = 0; phase < 50; ++phase) {
      ContactBench bench({Vec3::Zero()}, {2e-4});
      bench.options.stiffness = kappa;
      bench.prepare({node_contact(0, Vec3::UnitZ())});
      bench.u[2] = (3 + phase / 50.) * speed * bench.dt;  // reaches the plane after so many steps
      bench.v[2] = -speed;
      for (int k = 0; k < 60; ++k) bench.step(Vec3::Zero());
      const double restitution = bench.v[2] / speed;
      if (std::abs(restitution - 1) > std::abs(worst - 1)) worst = restitution;
    }
    check_figure({"V24 Bounce",
                  "worst restitution over 50 phases, kappa = " + std::to_string(kappa).substr(0, 3),
                  "one node", worst, 1, tolerance, "elastic impact"});
  }
}

// A triangle of three equal nodes lies on a plane of normal n, as deep as its weight presses it.
static ContactBench block_on_plane(const Vec3& n, double friction) {
  constexpr double m = 1e-4;
  ContactBench bench({Vec3(0, 0, 0), Vec3(6e-3, 0, 0), Vec3(0, 6e-3, 0)}, {m, m, m});
  bench.options = {.stiffness = .2, .friction = friction, .release_speed = 1e9};
  const Vec3 point = n.dot(bench.X[0] / 3 + bench.X[1] / 3 + bench.X[2] / 3) * n;
  bench.prepare(
      {{.node = {0, 1, 2}, .weight = {1. / 3, 1. / 3, 1. / 3}, .point = point, .normal = n}});
  const double depth = 3 * m * g * n.z() / bench.set.items[0].stiffness;
  for (std::size_t i = 0; i < 9; ++i) bench.u[i] = -depth * n[static_cast<Eigen::Index>(i % 3)];
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
  // It counts as stopped when it creeps with the regularisation: mu f_n / c = mu g dt / 0.2.
  const double creep = .3 * g * bench.dt / .2;
  for (int k = 1; k <= 10000; ++k) {
    bench.step(Vec3(0, 0, -g));
    if (steps_to_stop == 0 && bench.v[0] < creep) steps_to_stop = k;
  }
  // One step is worth v0 dt = 1e-4 m, the creeping creep^2 / (mu g) = 1e-6 m and creep / (mu g).
  check_figure({sliding, "distance [m]", "three nodes", bench.u[0] - start, 1 / (2 * .3 * g),
                1.01e-4 / .17, "Coulomb"});
  check_figure({sliding, "time [s]", "three nodes", steps_to_stop * bench.dt, 1 / (.3 * g),
                7e-4 / .34, "Coulomb"});
  EXPECT_LT(std::abs(bench.v[0]), 1e-12);
}

TEST(V23SlidingBlock, slides_down_an_incline_steeper_than_friction_holds) {
  const double sine = .6, cosine = .8, mu = .5;
  ContactBench bench = block_on_plane(Vec3(-sine, 0, cosine), mu);
  const int n = 2000;
  for (int k = 0; k < n; ++k) bench.step(Vec3(0, 0, -g));
  const double t = n * bench.dt, a = g * (sine - mu * cosine);
  // Until it slides there are some 5 steps of sticking drag.
  check_figure({sliding, "speed down an incline after .2 s [m/s]", "three nodes",
                speed_along(bench, Vec3(-cosine, 0, -sine)), a * t, g * 10 * bench.dt / (a * t),
                "Coulomb"});
}

TEST(V23SlidingBlock, creeps_down_a_flatter_incline_with_the_speed_of_the_regularisation) {
  const double sine = .28, cosine = .96, mu = .5;
  ContactBench bench = block_on_plane(Vec3(-sine, 0, cosine), mu);
  for (int k = 0; k < 2000; ++k) bench.step(Vec3(0, 0, -g));
  // M g sin = c v with c = 0.2 (M / dt): the law has no memory, so it cannot hold.
  check_figure({sliding, "creep on an incline that should hold it [m/s]", "three nodes",
                speed_along(bench, Vec3(-cosine, 0, -sine)), g * sine * bench.dt / .2, 1e-6,
                "regularised law"});
}
