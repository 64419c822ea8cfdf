#include "collision/contact_solve.h"

#include <array>
#include <cmath>

#include "collision_contacts.h"
#include "collision_random.h"
#include "larger_or_nan.h"
#include "largest.h"
#include "mesh/facets.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

// Random contacts of three tools on 12 nodes, most of them penetrating after the step.
struct Crowd {
  ContactBench bench;

  explicit Crowd(unsigned seed, double friction) : bench(nodes(seed), masses(seed)) {
    Random random(seed + 100);
    bench.options.friction = friction;
    bench.tools.resize(3);
    for (ToolMotion& tool : bench.tools)
      tool = {.pose = {random.rotation(), random.in_box(0.01)},
              .velocity = random.in_box(0.1),
              .angular_velocity = random.in_box(5)};
    std::vector<Contact> contacts;
    for (int c = 0; c < 40; ++c) contacts.push_back(contact(random));
    for (double& u : bench.u) u = random.between(-1e-3, 1e-3);
    for (std::size_t i = 0; i < bench.u.size(); ++i)
      bench.u_next[i] = bench.u[i] + random.between(-1e-5, 1e-5);
    bench.prepare(contacts);
  }

  static std::vector<Vec3> nodes(unsigned seed) {
    Random random(seed);
    std::vector<Vec3> X;
    for (int i = 0; i < 12; ++i) X.push_back(random.in_box(0.02));
    return X;
  }
  static std::vector<double> masses(unsigned seed) {
    Random random(seed + 1);
    std::vector<double> mass;
    for (int i = 0; i < 12; ++i) mass.push_back(random.between(1e-5, 3e-4));
    return mass;
  }
  Contact contact(Random& random) const {
    const auto pick = [&] { return static_cast<std::int32_t>(random.between(0, 12)); };
    Contact c;
    c.tool = static_cast<std::int32_t>(random.between(0, 3));
    const std::int32_t first = pick();
    c.node = {first, (first + 1 + pick() % 4) % 12, (first + 5) % 12};
    const double a = random.between(0, 1), b = random.between(0, 1 - a);
    c.weight = {a, b, 1 - a - b};
    // In the world within a cone: nothing is pressed from two sides.
    c.normal = bench.tools[c.tool].pose.rotation.conjugate() *
               (2 * Vec3::UnitZ() + random.direction()).normalized();
    c.point = random.in_box(0.02);
    return c;
  }
};

TEST(SolveContacts, takes_the_point_of_one_contact_to_the_surface_and_no_further) {
  ContactBench bench({Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0)}, {1e-4, 3e-4, 5e-5});
  bench.options.friction = 0;
  const std::array<double, 3> w = {0.5, 0.3, 0.2};
  const Vec3 n(0, 0.6, 0.8);
  // The tool's plane goes through the point before the step.
  bench.prepare({{.node = {0, 1, 2}, .weight = w, .point = Vec3(0.003, 0.002, 0), .normal = n}});
  bench.u_next = {0, 0, -1e-4, 0, 0, -3e-4, 0, 0, -2e-4};
  const auto gap_after = [&] {
    double gap = -n.dot(Vec3(0.003, 0.002, 0));
    for (std::size_t i = 0; i < 3; ++i)
      gap += w[i] * n.dot(bench.X[i] + node_of(bench.u_next, i) +
                          bench.dt * bench.dt / bench.mass[i] * node_of(bench.force, i));
    return gap;
  };
  EXPECT_NEAR(gap_after(), -0.8 * (0.5e-4 + 0.9e-4 + 0.4e-4), 1e-17);
  bench.add_forces();
  EXPECT_NEAR(gap_after(), 0, 1e-17);
  // Shares of momentum go by the weights.
  EXPECT_NEAR(bench.force[5] / bench.force[2], w[1] / w[0], 1e-14);
  EXPECT_NEAR(bench.force[8] / bench.force[2], w[2] / w[0], 1e-14);
}

TEST(SolveContacts, on_tissue_and_tools_sums_to_zero_with_friction) {
  Crowd crowd(2, 0.4);
  ContactBench& bench = crowd.bench;
  bench.add_forces();
  Vec3 sum = bench.reaction();
  double size = 0;
  for (std::size_t i = 0; i < bench.X.size(); ++i) {
    sum += node_of(bench.force, i);
    size += node_of(bench.force, i).norm();
  }
  ASSERT_GT(size, 0);
  EXPECT_LT(sum.norm(), 1e-14 * size);  // some hundred roundings
}

TEST(SolveContacts, is_zero_where_the_gap_stays_open) {
  ContactBench bench({Vec3(0, 0, 2e-6)}, {1e-3});
  bench.u_next = {1, 2, -1e-6};
  bench.prepare({node_contact(0, Vec3::UnitZ())});
  bench.add_forces();
  EXPECT_EQ(bench.force, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(bench.reaction(), Vec3(Vec3::Zero()));
}

TEST(SolveContacts, follows_the_tool_from_pose_to_pose) {
  ContactBench bench({Vec3(0, 0, 0)}, {1e-3});
  bench.options = {.friction = 0, .release_speed = 1e9};
  bench.prepare({node_contact(0, Vec3::UnitZ())});
  // A quarter turn about x takes the normal z to -y; the plane then lies at y = -1 mm, and the node
  // 1 mm inside of it.
  bench.tools[0].pose = {Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0), Vec3(0, -1e-3, 0)};
  bench.add_forces();
  const double k = 1e-3 / (bench.dt * bench.dt);
  EXPECT_NEAR(bench.force[1], -k * 1e-3, 1e-14 * k);
  EXPECT_NEAR(bench.force[0], 0, 1e-14 * k);
  EXPECT_NEAR(bench.force[2], 0, 1e-14 * k);
}

TEST(SolveContacts, has_no_friction_on_a_node_that_moves_with_the_tool) {
  ContactBench bench({Vec3(0.01, 0.02, -1e-3)}, {1e-3});
  const Contact contact = node_contact(0, Vec3::UnitZ(), Vec3(0.01, 0.02, 0));
  bench.prepare({contact});
  bench.tools[0].velocity = Vec3(0.1, 0.2, 0.3);
  bench.tools[0].angular_velocity = Vec3(1, 2, 3);
  const Vec3 v = Vec3(0.1, 0.2, 0.3) + Vec3(1, 2, 3).cross(contact.point);
  for (std::size_t j = 0; j < 3; ++j) bench.u_next[j] = bench.dt * v[static_cast<Eigen::Index>(j)];
  bench.add_forces();
  EXPECT_GT(bench.force[2], 0);
  // k times the rounding of positions of 0.02 m.
  EXPECT_NEAR(bench.force[0], 0, 1e5 * 1e-17);
  EXPECT_NEAR(bench.force[1], 0, 1e5 * 1e-17);
}

TEST(SolveContacts, on_what_is_held_is_none_and_the_others_yield_alone) {
  ContactBench bench({Vec3(0, 0, 0), Vec3(0.01, 0, 0)}, {1e-4, 1e-4});
  bench.options.friction = 0;
  bench.prepare({{.node = {0, 1, 1}, .weight = {0.25, 0.75, 0}, .normal = Vec3::UnitZ()}}, {0, 7});
  bench.u_next = {0, 0, -4e-6, 0, 0, 0};  // the contact point 1e-6 m below
  bench.add_forces();
  EXPECT_EQ(bench.force[5], 0);
  // It alone has to lift the point by 1e-6: 4e-6 at a quarter of the weight.
  EXPECT_NEAR(bench.force[2] * bench.dt * bench.dt / 1e-4, 4e-6, 1e-19);
}

TEST(SolveContacts, is_what_one_contact_asks_for_where_several_ask_for_the_same) {
  ContactBench bench({Vec3::Zero()}, {1e-4});
  bench.options.friction = 0;
  bench.u_next = {0, 0, -1e-5};
  bench.prepare(std::vector<Contact>(6, node_contact(0, Vec3::UnitZ())));
  bench.add_forces();
  EXPECT_NEAR(bench.force[2] * bench.dt * bench.dt / 1e-4, 1e-5, 1e-19);
}

// The least that any positions without penetration are away from the prediction, in the norm of the
// masses, is where the projections end: no admissible point is nearer (variational inequality).
TEST(SolveContacts, leaves_what_many_contacts_allow_nearest_to_the_step_without_them) {
  for (const unsigned seed : {3u, 4u, 5u}) {
    Crowd crowd(seed, 0.0);
    ContactBench& bench = crowd.bench;
    bench.add_forces();
    double pushed = 0, work = 0;
    for (const ContactSet::Item& item : bench.set.items) {
      const Contact& c = item.contact;
      const ToolMotion& tool = bench.tools[c.tool];
      const Vec3 n = tool.pose.rotation * c.normal, arm = tool.pose.rotation * c.point;
      Vec3 start = Vec3::Zero(), end = Vec3::Zero();
      for (std::size_t a = 0; a < 3; ++a) {
        const auto i = static_cast<std::size_t>(c.node[a]);
        start += c.weight[a] * (bench.X[i] + node_of(bench.u, i));
        end += c.weight[a] * (bench.X[i] + node_of(bench.u_next, i) +
                              bench.dt * bench.dt / bench.mass[i] * node_of(bench.force, i));
      }
      const double gap = n.dot(end - arm - tool.pose.translation);
      const double before = n.dot(start - arm - tool.pose.translation +
                                  bench.dt * (tool.velocity + tool.angular_velocity.cross(arm)));
      const double least =
          before < 0 ? std::min(0.0, before + bench.options.release_speed * bench.dt) : 0.0;
      EXPECT_GT(gap, least - 2e-6);  // a tenth of a usual depth is left after 30 rounds
      const double push = -item.reaction_sum.dot(n);
      EXPECT_GE(push, 0);
      pushed += push;
      work += push * (gap - least);
    }
    ASSERT_GT(pushed, 0);
    EXPECT_LT(work, 2e-6 * pushed);  // only contacts at their limit push
  }
}

// The stable step of a spring between a wall and a node that it presses into a tool is that of the
// spring alone: omega dt = 2.
TEST(SolveContacts, leaves_the_stable_step_as_it_is) {
  for (const double omega_dt : {0.5, 1.9, 1.999}) {
    ContactBench bench({Vec3::Zero()}, {1e-4});
    bench.options.friction = 0;
    bench.prepare({node_contact(0, Vec3::UnitZ())});
    const double k = 1e-4 * std::pow(omega_dt / bench.dt, 2), rest = -1e-3;
    bench.u[2] = 1e-4;
    double after_impact = 0;
    for (int n = 0; n < 20000; ++n) {
      bench.step(std::vector<double>{0, 0, k * (rest - bench.u[2])});
      EXPECT_GE(bench.u[2], -1e-18) << n;
      if (n == 100) after_impact = bench.u[2];
    }
    EXPECT_NEAR(bench.u[2], 0, 1e-18) << omega_dt << " after 100 steps " << after_impact;
  }
}

TEST(SolveContacts, lets_what_lies_inside_go_with_the_release_speed) {
  ContactBench bench({Vec3(0, 0, -2e-3)}, {1e-4});
  bench.options = {.friction = 0, .release_speed = 0.5};
  bench.prepare({node_contact(0, Vec3::UnitZ())});
  double fastest = 0;
  for (int n = 0; n < 100; ++n) {
    bench.step(Vec3(0, 0, 0));
    fastest = larger_or_nan(fastest, bench.v[2]);
  }
  EXPECT_NEAR(fastest, 0.5, 1e-9);
  EXPECT_GT(bench.X[0].z() + bench.u[2], 0);
}

// Positions travel between ranks as they are: here by hand.
TEST(SolveContacts, gives_every_rank_that_holds_nodes_the_same_forces) {
  const Mesh mesh = make_ball(Vec3::Zero(), 0.02, 6, BoxElements::tet4_kuhn);
  const Surface surface = boundary_surface(mesh);
  ContactDetector detector({{.pieces = {{.points = {Vec3::Zero()}, .radius = 8e-3}}}});
  detector.set_surface(surface);
  const std::vector<ToolMotion> tools = {{.pose = {.translation = Vec3(0.004, 0.003, 0.024)},
                                          .velocity = Vec3(0.1, 0.2, 0),
                                          .angular_velocity = Vec3(0, 3, 1)}};
  std::vector<Contact> contacts;
  const std::vector<double> margin = {1e-3}, mass(mesh.X.size(), 1e-4);
  const std::vector<Pose> pose = {tools[0].pose};
  detector.detect(mesh.X, pose, margin, contacts);
  ASSERT_GT(contacts.size(), 10u);
  const auto moved = [&](std::int32_t i, int k) { return 1e-6 * ((i * 5 + k * 2) % 7); };
  std::vector<Vec3> force;
  for (const int n_ranks : {1, 2, 3}) {
    std::vector<std::int32_t> owner(mesh.X.size());
    for (std::size_t i = 0; i < owner.size(); ++i)
      owner[i] = static_cast<std::int32_t>((i / 5) % static_cast<std::size_t>(n_ranks));
    int n_counted = 0;
    std::size_t n_owned = 0;
    for (int rank = 0; rank < n_ranks; ++rank) {
      const Part part = make_part(mesh, owner, rank);
      ContactSet set =
          prepare_contacts({contacts}, owner, part, {mass, std::vector<std::uint8_t>(mass.size())});
      for (std::size_t k = 0; k < set.node.size(); ++k) {
        const std::int32_t i = set.node[k];
        set.x_start[k] = mesh.X[i];
        set.x_end[k] = set.x_start[k] + Vec3(moved(i, 0), moved(i, 1), moved(i, 2));
      }
      const ContactStep step = {.tools = tools, .dt = 1e-4, .response = 1e-8};
      look_again(detector, step, set);
      solve_contacts(detector, step, {}, set);
      if (force.empty()) force = set.force;
      EXPECT_EQ(set.force, force);
      n_counted += set.is_counted_here ? 1 : 0;
      n_owned += set.owned.size();
      EXPECT_EQ(set.halo.neighbours.size(), static_cast<std::size_t>(n_ranks - 1));
      for (const Halo::Neighbour& other : set.halo.neighbours) {
        EXPECT_EQ(other.send, set.owned);
        for (const std::int32_t place : other.receive)
          EXPECT_EQ(owner[set.node[place]], other.rank);
      }
    }
    EXPECT_EQ(n_counted, 1);
    EXPECT_EQ(n_owned, force.size());
  }
  EXPECT_GT(largest(force), 0);
}

TEST(SolveContacts, leaves_ranks_without_contact_nodes_alone) {
  ContactBench bench({Vec3(0, 0, 0), Vec3(1, 0, 0)}, {1e-4, 1e-4});
  const std::vector<Contact> contacts = {node_contact(0, Vec3::UnitZ())};
  bench.part.rank = 1;
  const ContactSet set = prepare_contacts({contacts}, std::vector<std::int32_t>{0, 1}, bench.part,
                                          {bench.mass, std::vector<std::uint8_t>(2)});
  EXPECT_TRUE(set.items.empty());
  EXPECT_TRUE(set.halo.neighbours.empty());
}

// A hull touches with a face, and a node that lies in it is pushed to the nearest one.
TEST(SolveContacts, lifts_the_nodes_of_a_triangle_that_lies_on_a_sphere) {
  ContactDetector detector({{.pieces = {{.points = {Vec3(0, 0, -1)}, .radius = 1}}}});
  ContactBench bench({Vec3(0, 0, 0), Vec3(0, 0.01, 0), Vec3(0.01, 0, 0)}, {1e-4, 1e-4, 1e-4});
  detector.set_surface({.triangle = {{0, 1, 2}, {0, 2, 1}}});
  bench.detector = std::move(detector);
  bench.options.friction = 0;
  Contact contact{.node = {0, 1, 2}};
  bench.prepare({contact});
  bench.u = {0, 0, 1e-4, 0, 0, 1e-4, 0, 0, 1e-4};
  bench.u_next = {0, 0, -1e-4, 0, 0, -2e-4, 0, 0, -3e-4};
  bench.place();
  look_again(bench.detector, bench.contact_step(), bench.set);
  bench.add_forces();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 end = bench.X[i] + node_of(bench.u_next, i) +
                     bench.dt * bench.dt / bench.mass[i] * node_of(bench.force, i);
    EXPECT_GT((end - Vec3(0, 0, -1)).norm() - 1, -3e-7) << i;  // a thousandth of the depth
  }
}

TEST(SolveContacts, of_a_plane_contact_goes_to_the_two_nodes_of_the_edge) {
  ContactBench bench({Vec3(0, 0, 0), Vec3(0.01, 0, 0)}, {1e-4, 1e-4});
  bench.options.friction = 0;
  bench.prepare({{.node = {0, 1, 1},
                  .weight = {0.25, 0.75, 0},
                  .point = Vec3(0.0075, 0, 0),
                  .normal = -Vec3::UnitY()}});
  bench.u_next = {0, 1e-6, 0, 0, 1e-6, 0};
  bench.add_forces();
  const double k = 1e-4 / (0.25 * 0.25 + 0.75 * 0.75) / (bench.dt * bench.dt);
  EXPECT_NEAR(bench.force[1], -0.25 * k * 1e-6, 1e-14 * k * 1e-6);
  EXPECT_NEAR(bench.force[4], -0.75 * k * 1e-6, 1e-14 * k * 1e-6);
}

// The nearest point of a triangle wanders while a sphere rolls over it: the look finds it anew.
TEST(LookAgain, finds_the_nearest_point_of_a_triangle_that_has_moved) {
  ContactBench bench({Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0)}, {1e-4, 1e-4, 1e-4});
  bench.detector = ContactDetector({{.pieces = {{.points = {Vec3(0, 0, 5e-3)}, .radius = 5e-3}}}});
  bench.detector.set_surface({.triangle = {{0, 1, 2}, {0, 2, 1}}});  // a closed surface
  std::vector<Contact> contacts;
  bench.tools[0].pose.translation = Vec3(2e-3, 3e-3, 0);
  bench.detector.detect(bench.X, std::vector<Pose>{bench.tools[0].pose}, std::vector<double>{1e-3},
                        contacts);
  ASSERT_FALSE(contacts.empty());
  bench.prepare({contacts[0]});
  bench.place();
  bench.tools[0].pose.translation = Vec3(4e-3, 1e-3, -1e-4);
  look_again(bench.detector, bench.contact_step(), bench.set);
  const ContactSet::Item& item = bench.set.items[0];
  EXPECT_TRUE(item.is_near);
  EXPECT_NEAR(item.contact.gap, -1e-4, 1e-16);
  const std::array<double, 3> expected = {0.5, 0.4, 0.1};  // of (4, 1, 0) mm
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_NEAR(item.contact.weight[a], expected[item.contact.node[a]], 1e-13);
  bench.tools[0].pose.translation.z() = 1e-4;
  look_again(bench.detector, bench.contact_step(), bench.set);
  EXPECT_FALSE(bench.set.items[0].is_near);
}

}  // namespace
}  // namespace trocar
