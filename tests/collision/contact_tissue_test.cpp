#include "collision/contact_tissue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "collision_contacts.h"
#include "larger_or_nan.h"

namespace trocar {
namespace {

// A triangle in z = 0 and a node that comes through it from above within the step.
ContactBench node_over_triangle(double friction) {
  ContactBench bench({Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0), Vec3(0.003, 0.002, 0)},
                     {1e-4, 3e-4, 5e-5, 2e-4});
  bench.options.friction = friction;
  bench.u[11] = 2e-5;
  for (std::size_t i = 0; i < 12; ++i) bench.u_next[i] = bench.u[i];
  bench.u_next[9] = 8e-5;  // along the triangle
  bench.u_next[11] = -3e-5;
  bench.prepare({}, {}, {{.node = 3, .corner = {0, 1, 2}}});
  bench.add_forces();
  return bench;
}

Vec3 place_after(const ContactBench& bench, std::size_t i) {
  const double response = bench.dt * bench.dt;
  return bench.X[i] + node_of(bench.u_next, i) + response / bench.mass[i] * node_of(bench.force, i);
}

TEST(ContactTissue, keeps_a_node_out_of_a_triangle_of_tissue) {
  const ContactBench bench = node_over_triangle(0);
  const Triangle after = {place_after(bench, 0), place_after(bench, 1), place_after(bench, 2)};
  // The triangle has turned a little by then.
  EXPECT_NEAR(touch_tissue(place_after(bench, 3), after).height, 0, 1e-8);
}

TEST(ContactTissue, between_tissue_and_tissue_conserves_both_momenta) {
  for (const double friction : {0.0, 0.3, 10.0}) {
    const ContactBench bench = node_over_triangle(friction);
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    double largest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 f = node_of(bench.force, i);
      sum += f;
      moment += bench.set.x_end[i].cross(f);
      largest = larger_or_nan(largest, f.norm());
    }
    EXPECT_GT(largest, 0.1);
    EXPECT_LT(sum.norm(), 1e-14 * largest);
    // Friction acts at the node and at the point below it, apart by what the node lacks.
    EXPECT_LT(moment.norm(), friction == 0 ? 1e-16 * largest : 3.1e-5 * largest);
  }
}

TEST(ContactTissue, between_tissue_and_tissue_holds_with_at_most_mu_times_the_push) {
  for (const double friction : {0.3, 10.0}) {
    const ContactBench bench = node_over_triangle(friction);
    const Vec3 f = node_of(bench.force, 3);
    const double drag = std::hypot(f.x(), f.y());
    EXPECT_LT(f.x(), 0);
    if (friction < 1)
      EXPECT_NEAR(drag, friction * f.z(), 1e-9 * f.z());
    else
      EXPECT_LT(drag, 9 * f.z());  // it sticks
  }
}

}  // namespace
}  // namespace trocar
