#include "collision/contact_force.h"

#include <array>
#include <cmath>

#include "collision_contacts.h"
#include "collision_random.h"
#include "mesh/facets.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

// Random contacts of three tools on 12 nodes, most of them penetrating.
struct Crowd {
  ContactBench bench;
  std::vector<Contact> contacts;

  explicit Crowd(unsigned seed, double friction) : bench(nodes(seed), masses(seed)) {
    Random random(seed + 100);
    bench.options = {.stiffness = 0.2, .friction = friction, .release_speed = 1e9};
    bench.tools.resize(3);
    for (ToolMotion& tool : bench.tools)
      tool = {.pose = {random.rotation(), random.in_box(0.01)},
              .velocity = random.in_box(0.1),
              .angular_velocity = random.in_box(5)};
    for (int c = 0; c < 40; ++c) contacts.push_back(contact(random));
    for (double& u : bench.u) u = random.between(-1e-3, 1e-3);
    for (double& v : bench.v) v = random.between(-0.1, 0.1);
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
    c.node = {first, (first + 1 + pick() % 11) % 12, (first + 5) % 12};
    const double a = random.between(0, 1), b = random.between(0, 1 - a);
    c.weight = {a, b, 1 - a - b};
    c.normal = random.direction();
    c.point = random.in_box(0.02);
    return c;
  }
};

double penalty_energy(const ContactBench& bench) {
  double energy = 0;
  for (const ContactSet::Item& item : bench.set.items) {
    Vec3 x = Vec3::Zero();
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(item.contact.node[a]);
      x += item.contact.weight[a] *
           (bench.X[i] + Vec3(bench.u[3 * i], bench.u[3 * i + 1], bench.u[3 * i + 2]));
    }
    const Pose& pose = bench.tools[static_cast<std::size_t>(item.contact.tool)].pose;
    const double gap =
        (pose.rotation * item.contact.normal).dot(x - pose.apply(item.contact.point));
    energy += 0.5 * item.stiffness * std::pow(std::min(gap, 0.0), 2);
  }
  return energy;
}

TEST(ContactForce, is_minus_the_gradient_of_the_penalty_energy) {
  Crowd crowd(1, 0.0);
  ContactBench& bench = crowd.bench;
  bench.add_forces();
  const std::vector<double> force = bench.force;
  double largest = 0;
  for (const double f : force) largest = std::max(largest, std::abs(f));
  ASSERT_GT(largest, 0);
  for (std::size_t i = 0; i < force.size(); ++i) {
    constexpr double h = 1e-7;
    const double u = bench.u[i];
    bench.u[i] = u + h;
    const double up = penalty_energy(bench);
    bench.u[i] = u - h;
    const double down = penalty_energy(bench);
    bench.u[i] = u;
    // The energy is quadratic: only rounding is left, eps E / h with E about 1e-2 f.
    EXPECT_NEAR(force[i], -(up - down) / (2 * h), 1e-9 * largest);
  }
}

TEST(ContactForce, on_tissue_and_tools_sums_to_zero_with_friction) {
  Crowd crowd(2, 0.4);
  ContactBench& bench = crowd.bench;
  bench.add_forces();
  Vec3 sum = Vec3::Zero(), size = Vec3::Zero();
  for (std::size_t i = 0; i < bench.X.size(); ++i)
    sum += Vec3(bench.force[3 * i], bench.force[3 * i + 1], bench.force[3 * i + 2]);
  for (const Vec3& r : bench.reaction) {
    sum += r;
    size += r.cwiseAbs();
  }
  ASSERT_GT(size.norm(), 0);
  EXPECT_LT(sum.norm(), 1e-14 * size.norm());  // some hundred roundings
}

TEST(ContactForce, is_zero_where_the_gap_is_open) {
  ContactBench bench({Vec3(0, 0, 1e-6)}, {1e-3});
  bench.v = {1, 2, -3};
  bench.prepare({node_contact(0, Vec3::UnitZ())});
  bench.add_forces();
  EXPECT_EQ(bench.force, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(bench.reaction[0], Vec3(Vec3::Zero()));
}

TEST(ContactForce, follows_the_tool_from_pose_to_pose) {
  ContactBench bench({Vec3(0, 0, 0)}, {1e-3});
  bench.options.friction = 0;
  bench.prepare({node_contact(0, Vec3::UnitZ())});
  // A quarter turn about x takes the normal z to -y; the plane then lies at y = -1 mm, and the node
  // 1 mm inside of it.
  bench.tools[0].pose = {Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0), Vec3(0, -1e-3, 0)};
  bench.add_forces();
  const double k = bench.set.items[0].stiffness;
  EXPECT_NEAR(bench.force[1], -k * 1e-3, 1e-15 * k);
  EXPECT_NEAR(bench.force[0], 0, 1e-15 * k);
  EXPECT_NEAR(bench.force[2], 0, 1e-15 * k);
}

TEST(ContactForce, has_no_friction_on_a_node_that_moves_with_the_tool) {
  ContactBench bench({Vec3(0.01, 0.02, -1e-3)}, {1e-3});
  Contact contact = node_contact(0, Vec3::UnitZ(), Vec3(0.01, 0.02, 0));
  bench.prepare({contact});
  bench.tools[0].velocity = Vec3(0.1, 0.2, 0.3);
  bench.tools[0].angular_velocity = Vec3(1, 2, 3);
  const Vec3 v = Vec3(0.1, 0.2, 0.3) + Vec3(1, 2, 3).cross(contact.point);
  bench.v = {v.x(), v.y(), v.z()};
  bench.add_forces();
  EXPECT_EQ(bench.force[0], 0);
  EXPECT_EQ(bench.force[1], 0);
  EXPECT_GT(bench.force[2], 0);
}

// Largest eigenvalue of M^-1 A dt^2 or dt, where A is what `field` feels, by power iteration.
double largest_eigenvalue(ContactBench& bench, std::vector<double>& field, double factor) {
  const std::vector<double> origin = field;
  bench.add_forces();
  const std::vector<double> force = bench.force;
  Random random(5);
  std::vector<double> w(field.size());
  for (double& x : w) x = random.between(-1, 1);
  double eigenvalue = 0;
  for (int k = 0; k < 500; ++k) {
    for (std::size_t i = 0; i < w.size(); ++i) field[i] = origin[i] + 1e-4 * w[i];
    bench.add_forces();
    double norm = 0;
    for (std::size_t i = 0; i < w.size(); ++i) {
      w[i] = -(bench.force[i] - force[i]) / 1e-4 / bench.mass[i / 3] * factor;
      norm += w[i] * w[i] * bench.mass[i / 3];
    }
    double before = 0;
    for (std::size_t i = 0; i < w.size(); ++i)
      before += std::pow((field[i] - origin[i]) / 1e-4, 2) * bench.mass[i / 3];
    eigenvalue = std::sqrt(norm / before);
    for (double& x : w) x /= std::sqrt(norm) / 0.01;
  }
  return eigenvalue;
}

TEST(ContactForce, keeps_stiffness_and_damping_below_their_bounds_however_many_contacts_meet) {
  for (const unsigned seed : {3u, 4u, 5u}) {
    Crowd stiff(seed, 0.0);
    for (Contact& c : stiff.contacts) c.point = 0.1 * c.normal;  // all deep: the law is linear
    stiff.bench.prepare(stiff.contacts);
    const double dt = stiff.bench.dt;
    const double k = largest_eigenvalue(stiff.bench, stiff.bench.u, dt * dt);
    EXPECT_LE(k, 0.2 * (1 + 1e-9));
    EXPECT_GT(k, 0.02);  // and not far below: the bound is no excuse for soft contacts
    Crowd sticky(seed, 1e9);
    for (Contact& c : sticky.contacts) c.point = 0.1 * c.normal;
    sticky.bench.prepare(sticky.contacts);
    const double c = largest_eigenvalue(sticky.bench, sticky.bench.v, dt);
    EXPECT_LE(c, 0.2 * (1 + 1e-6));
    EXPECT_GT(c, 0.02);
  }
}

TEST(ContactForce, gives_the_same_bits_on_any_number_of_ranks) {
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

  std::vector<double> force(3 * mesh.X.size(), 0.0);
  std::vector<Vec3> reaction;
  for (const int n_ranks : {1, 2, 3}) {
    // Owners in stripes, so that contacts straddle ranks.
    std::vector<std::int32_t> owner(mesh.X.size());
    for (std::size_t i = 0; i < owner.size(); ++i)
      owner[i] = static_cast<std::int32_t>((i / 5) % static_cast<std::size_t>(n_ranks));
    std::vector<double> gathered(force.size(), 0.0);
    std::vector<int> n_counted(contacts.size(), 0);
    for (int rank = 0; rank < n_ranks; ++rank) {
      const Part part = make_part(mesh, owner, rank);
      const ContactSet set = prepare_contacts(contacts, part, mass, 1e-4, {});
      std::vector<double> u, v, f(3 * static_cast<std::size_t>(part.n_owned), 0.0);
      for (const std::int32_t i : part.node_global)
        for (int k = 0; k < 3; ++k) {
          u.push_back(1e-5 * ((i * 7 + k * 3) % 11));
          v.push_back(1e-2 * ((i * 5 + k * 2) % 7));
        }
      std::vector<Vec3> r(set.items.size());
      add_contact_force(set, part, mesh.X, u, v, tools, {}, f, r);
      for (std::int32_t i = 0; i < part.n_owned; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          gathered[3 * static_cast<std::size_t>(part.node_global[static_cast<std::size_t>(i)]) +
                   k] = f[3 * static_cast<std::size_t>(i) + k];
      for (std::size_t k = 0; k < set.items.size(); ++k) {
        if (!set.items[k].is_counted_here) continue;
        std::size_t c = 0;
        while (contacts[c].triangle != set.items[k].contact.triangle) ++c;
        ++n_counted[c];
        if (n_ranks == 1) reaction.push_back(r[k]);
        EXPECT_EQ(r[k], reaction[c]);
      }
    }
    if (n_ranks == 1) force = gathered;
    EXPECT_EQ(gathered, force);
    EXPECT_EQ(n_counted, std::vector<int>(contacts.size(), 1));
  }
}

TEST(ContactForce, of_a_plane_contact_goes_to_the_two_nodes_of_the_edge) {
  const double m = 1e-4;
  ContactBench bench({Vec3(0, 0, 0), Vec3(0.01, 0, 0)}, {m, m});
  bench.options.friction = 0;
  bench.prepare({{.node = {0, 1, 1},
                  .weight = {0.25, 0.75, 0},
                  .point = Vec3(0.0075, -1e-3, 0),
                  .normal = -Vec3::UnitY()}});
  bench.add_forces();
  const double k = 0.2 * (m / 0.75) / (bench.dt * bench.dt);  // the nearer node limits
  EXPECT_NEAR(bench.set.items[0].stiffness, k, 1e-14 * k);
  EXPECT_NEAR(bench.force[1], -0.25 * k * 1e-3, 1e-14 * k);
  EXPECT_NEAR(bench.force[4], -0.75 * k * 1e-3, 1e-14 * k);
}

// k d with d = v_r dt / sqrt(kappa): the spring's energy at that depth is m v_r^2 / 2.
TEST(ContactForce, saturates_at_the_depth_of_the_release_speed) {
  ContactBench bench({Vec3::Zero()}, {1e-4});
  bench.options = {.stiffness = 0.2, .friction = 0, .release_speed = 0.5};
  bench.prepare({node_contact(0, Vec3::UnitZ(), Vec3(0, 0, 2e-3))});
  bench.add_forces();
  const double depth = 0.5 * bench.dt / std::sqrt(0.2), k = 0.2 * 1e-4 / (bench.dt * bench.dt);
  EXPECT_NEAR(bench.force[2], k * depth, 1e-12 * k * depth);
  bench.u[2] = 2e-3 - 0.5 * depth;
  bench.add_forces();
  EXPECT_NEAR(bench.force[2], 0.5 * k * depth, 1e-9 * k * depth);
}

}  // namespace
}  // namespace trocar
