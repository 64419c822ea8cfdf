#include "collision/contact_clusters.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "collision/contact_set.h"

namespace trocar {
namespace {

// Four nodes of which the last one is alone, in x; M = diag(m + d) - d d^T / sum d of the first
// three (solver/mass_scaling.h).
struct Joined {
  Eigen::Vector4d m{1, 2, 0.5, 3}, d{0.7, 0.1, 1.5, 0};
  std::array<bool, 4> is_held{};

  // M^-1 of what moves, 0 elsewhere.
  Eigen::Matrix4d inverse() const {
    Eigen::Matrix4d M = Eigen::Matrix4d((m + d).asDiagonal()) - d * d.transpose() / d.sum();
    for (int i = 0; i < 4; ++i)
      if (is_held[i]) {
        M.row(i).setZero();
        M.col(i).setZero();
        M(i, i) = 1;
      }
    Eigen::Matrix4d inverse = M.inverse();
    for (int i = 0; i < 4; ++i)
      if (is_held[i]) inverse(i, i) = 0;
    return inverse;
  }
  ContactClusters clusters() const {
    double whole = 0;
    for (int i = 0; i < 3; ++i) whole += is_held[i] ? d[i] : d[i] * m[i] / (m[i] + d[i]);
    ContactClusters c{.of = {0, 0, 0, -1},
                      .share = {},
                      .alone = {},
                      .yield = {Vec3::Constant(1 / whole)},
                      .impulse = {Vec3::Zero()}};
    for (int i = 0; i < 4; ++i) {
      c.share.emplace_back(is_held[i] ? 0 : d[i] / (m[i] + d[i]), 0, 0);
      c.alone.emplace_back(is_held[i] ? 0 : 1 / (m[i] + d[i]), 0, 0);
    }
    return c;
  }
};

constexpr double of_rounding = 1e-14;

ContactConstraint point_of(const std::array<double, 4>& weight) {
  return {.place = {0, 1, 2, 3}, .weight = weight};
}

TEST(ContactClusters, move_as_the_joined_masses_say) {
  for (const bool is_held : {false, true}) {
    Joined joined;
    joined.is_held[1] = is_held;
    ContactClusters clusters = joined.clusters();
    // Two impulses at different points, then how far a third one goes.
    const std::array<double, 4> first = {0.2, 0.5, 0.3, 0}, second = {1, -0.3, -0.1, -0.6},
                                looked_at = {0.1, 0.2, 0.6, 0.1};
    Eigen::Vector4d f = Eigen::Vector4d::Zero();
    for (const auto& [weight, size] : {std::pair(first, 2.0), std::pair(second, -0.7)}) {
      add_to_clusters(point_of(weight), Vec3(size, 0, 0), clusters);
      for (int i = 0; i < 4; ++i) f[i] += weight[i] * size;
    }
    const Eigen::Vector4d u = joined.inverse() * f;
    double expected = 0, found = move_of_clusters(point_of(looked_at), clusters).x();
    for (int i = 0; i < 4; ++i) {
      expected += looked_at[i] * u[i];
      found += looked_at[i] * clusters.alone[i].x() * f[i];
    }
    EXPECT_NEAR(found, expected, of_rounding) << is_held;
  }
}

TEST(ContactClusters, yield_beside_each_nodes_own_as_the_joined_masses_say) {
  for (const bool is_held : {false, true}) {
    Joined joined;
    joined.is_held[2] = is_held;
    const ContactClusters clusters = joined.clusters();
    const Eigen::Matrix4d inverse = joined.inverse();
    const Eigen::Vector4d w(0.4, 0.35, 0.25, -1);
    double own = 0;
    for (int i = 0; i < 4; ++i) own += w[i] * w[i] * inverse(i, i);
    const double beside = yield_of_clusters(point_of({w[0], w[1], w[2], w[3]}), clusters).x();
    EXPECT_NEAR(own + beside, w.dot(inverse * w), of_rounding) << is_held;
  }
}

// What a node alone feels, and what it moves by for itself.
TEST(ContactClusters, of_a_contact_set_have_the_nodes_own_inverse_masses) {
  const Joined joined;
  const ContactClusters all = joined.clusters();
  const std::vector<double> mass = {1.7, 2.1, 2.0, 3}, share = {0.7 / 1.7, 0.1 / 2.1, 1.5 / 2, 0};
  const std::vector<std::uint8_t> held = {0, 0, 4, 0};  // the third one along z
  Contact contact;
  contact.node = {0, 1, 2};
  Part part;
  part.node_global = {0, 1, 2, 3};
  part.node_local = {0, 1, 2, 3};
  part.n_owned = 4;
  const ContactSet set = prepare_contacts(
      {std::span(&contact, 1)}, std::vector<std::int32_t>{0, 0, 0, 0}, part,
      {.mass = mass, .held = held, .cluster = all.of, .share = share, .yield = all.yield});
  const Eigen::Matrix4d inverse = joined.inverse();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(set.inverse_mass[i].x(), inverse(i, i), of_rounding);
    EXPECT_NEAR(set.clusters.alone[i].x(), 1 / mass[i], of_rounding);
  }
  EXPECT_EQ(set.inverse_mass[2].z(), 0);
  EXPECT_EQ(set.clusters.share[2].z(), 0);
}

}  // namespace
}  // namespace trocar
