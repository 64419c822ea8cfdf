// What contact does with nodes that supports hold in some components.
#include "collision/contact_constraint.h"

#include <gtest/gtest.h>

#include <cmath>

#include "collision_contacts.h"

namespace trocar {
namespace {

constexpr std::uint8_t held_in_y = 2, held_in_z = 4;
constexpr double lack = 1e-6, mass = 1e-4;

// A node of which the step lacks `lack` along n.
ContactBench lacking_node(const Vec3& n, std::uint8_t held, double friction) {
  ContactBench bench({Vec3::Zero()}, {mass});
  bench.options.friction = friction;
  const Vec3 u = -lack * n;
  bench.u_next = {u.x(), u.y(), u.z()};
  bench.prepare({node_contact(0, n)}, {held});
  return bench;
}

TEST(ContactConstraint, lets_a_node_yield_in_the_components_that_are_free) {
  const Vec3 n(0.48, 0.6, 0.64);
  ContactBench bench = lacking_node(n, held_in_y, 0);
  bench.add_forces();
  const Vec3 force = Vec3::Map(bench.force.data());
  const Vec3 moved = bench.dt * bench.dt / mass * Vec3(force.x(), 0, force.z());
  EXPECT_NEAR(n.dot(moved), lack, 1e-6 * lack);
  EXPECT_NEAR(force.normalized().dot(n), 1, 1e-14);  // the support takes its share
  EXPECT_EQ(bench.reaction(), Vec3(-force));
}

// A mirror plane y = 0 cuts an edge of two equal nodes in half and leaves half of each one on it.
TEST(ContactConstraint, of_half_a_mirrored_pair_has_half_the_force) {
  const Vec3 n(0, 0.6, 0.8), mirrored(0, -0.6, 0.8);
  const auto lowered = [](std::vector<double> masses) {
    ContactBench bench({Vec3::Zero(), Vec3(0, 0.01, 0), Vec3(0, -0.01, 0)}, std::move(masses));
    bench.options.friction = 0;
    bench.u_next = {0, 0, -lack, 0, 0, -lack, 0, 0, -lack};
    return bench;
  };
  const Contact right{.node = {0, 1, 1}, .weight = {0.7, 0.3, 0}, .normal = n},
      left{.node = {0, 2, 2}, .weight = {0.7, 0.3, 0}, .normal = mirrored};
  ContactBench whole = lowered({2 * mass, mass, mass}), half = lowered({mass, mass, mass});
  whole.prepare({right, left});
  half.prepare({right}, {held_in_y});
  for (Contact* c : {&whole.set.items[0].contact, &half.set.items[0].contact})
    c->point.y() = 0.003;  // that the plane goes through the edge
  whole.set.items[1].contact.point.y() = -0.003;
  whole.add_forces();
  half.add_forces();
  ASSERT_GT(half.reaction().norm(), 0);
  // Rounds end where one changes less than 1e-3 of the deepest point.
  EXPECT_NEAR(half.reaction().z() / whole.reaction().z(), 0.5, 2e-3);
}

TEST(ContactConstraint, has_all_the_friction_along_a_component_that_is_held) {
  ContactBench bench = lacking_node(Vec3::UnitZ(), held_in_y, 0.3);
  bench.tools[0].velocity = Vec3(0, 1, 0);
  bench.add_forces();
  EXPECT_NEAR(bench.force[1], 0.3 * bench.force[2], 1e-12 * bench.force[2]);
  EXPECT_NEAR(bench.force[2] * bench.dt * bench.dt / mass, lack, 1e-9 * lack);
}

TEST(ContactConstraint, fades_where_supports_hold_along_its_normal) {
  ContactBench held = lacking_node(Vec3::UnitZ(), held_in_z, 0);
  held.add_forces();
  EXPECT_EQ(held.force[2], 0);
  double before = 0;
  for (const double x : {1e-6, 1e-4, 1e-2, 0.3, 0.6}) {
    ContactBench bench = lacking_node(Vec3(x, 0, std::sqrt(1 - x * x)), held_in_z, 0);
    bench.add_forces();
    const double free_force = lack * mass / (bench.dt * bench.dt), force = bench.reaction().norm();
    EXPECT_GT(force, before);
    EXPECT_LE(force, std::min(4.0, 17 * x * x) * free_force);
    before = force;
  }
}

// The point of contact lies on the held corner of an edge, or near it.
TEST(ContactConstraint, fades_with_the_weight_of_what_yields) {
  double before = 0;
  for (const double w : {0.0, 1e-16, 1e-8, 1e-3, 0.05, 0.25}) {
    ContactBench bench({Vec3::Zero(), Vec3(0.01, 0, 0)}, {mass, mass});
    bench.options.friction = 0;
    bench.tools[0] = {.pose = {Quat::Identity(), Vec3(0, 0, lack)},
                      .velocity = Vec3(0, 0, lack / bench.dt)};
    bench.prepare({{.node = {0, 1, 1}, .weight = {w, 1 - w, 0}, .normal = Vec3::UnitZ()}}, {0, 7});
    bench.add_forces();
    const double moved = bench.dt * bench.dt / mass * bench.force[2];
    EXPECT_LE(moved, 16.001 * w * lack) << w;  // 4 lack while it didn't fade
    EXPECT_GE(moved, before) << w;
    before = moved;
  }
  EXPECT_NEAR(before, 4 * lack, 1e-9 * lack);
}

// A ball at rest has a corner in it that nothing moves, or that only slides past it.
TEST(ContactConstraint, throws_nothing_out_that_a_held_corner_keeps_inside) {
  const auto thrown = [](std::uint8_t held, const Vec3& corner) {
    ContactBench bench({Vec3(-0.01, 0, 0), corner}, {mass, mass});
    bench.detector = ContactDetector({{{{.points = {Vec3::Zero()}, .radius = 0.002}}}});
    bench.options.friction = 0;
    const Vec3 middle = 0.5 * (bench.X[0] + bench.X[1]);
    bench.prepare({{.node = {0, 1, 1},
                    .weight = {0.5, 0.5, 0},
                    .point = middle + Vec3(0, 0, 1e-4),
                    .normal = Vec3::UnitZ()}},
                  {0, held});
    bench.add_forces();
    return bench.dt * bench.dt / mass * bench.force[2];
  };
  const Vec3 inside(0.001, 0, 0), outside(0.003, 0, 0);
  const double released = 2 * ContactOptions().release_speed * ContactBench({}, {}).dt;
  EXPECT_EQ(thrown(7, inside), 0);
  EXPECT_EQ(thrown(held_in_z, inside), 0);
  EXPECT_NEAR(thrown(7, outside), released, 1e-9 * released);
  EXPECT_NEAR(thrown(held_in_y, inside), 0.5 * released, 1e-9 * released);
  EXPECT_NEAR(thrown(0, inside), 0.5 * released, 1e-9 * released);
}

}  // namespace
}  // namespace trocar
