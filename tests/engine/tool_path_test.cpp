#include "engine/tool_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace trocar {
namespace {

std::vector<InstrumentKey> random_keys(std::mt19937& random, int n) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<InstrumentKey> keys;
  double time = 0.3;
  for (int k = 0; k < n; ++k, time += 0.05 + 0.5 * (1 + unit(random)))
    keys.push_back({.time = time,
                    .position = 0.1 * Vec3(unit(random), unit(random), unit(random)),
                    .direction = Vec3(unit(random), unit(random), -1.5),
                    .forward = Vec3(1, unit(random), 0)});
  return keys;
}

TEST(ToolPath, passes_through_its_keys_exactly) {
  std::mt19937 random(1);
  const std::vector<InstrumentKey> keys = random_keys(random, 8);
  const ToolPath path(keys);
  for (const InstrumentKey& key : keys) EXPECT_EQ(path.at(key.time).translation, key.position);
}

TEST(ToolPath, rests_before_the_first_key_and_after_the_last) {
  std::mt19937 random(2);
  const std::vector<InstrumentKey> keys = random_keys(random, 5);
  const ToolPath path(keys);
  for (const double time : {-1.0, 0.0, keys.front().time}) {
    EXPECT_EQ(path.at(time).translation, keys.front().position);
    EXPECT_EQ(path.at(time).rotation.coeffs(), path.at(keys.front().time).rotation.coeffs());
  }
  for (const double time : {keys.back().time, keys.back().time + 1, 1e9}) {
    EXPECT_EQ(path.at(time).translation, keys.back().position);
    EXPECT_EQ(path.at(time).rotation.coeffs(), path.at(keys.back().time).rotation.coeffs());
  }
}

TEST(ToolPath, of_one_key_never_moves) {
  const ToolPath path({{.time = 1, .position = Vec3(1, 2, 3)}});
  for (const double time : {0.0, 1.0, 2.0}) EXPECT_EQ(path.at(time).translation, Vec3(1, 2, 3));
}

// Calls visit(leg, path, s, x, last) for 100 places along each leg.
template <class Visit>
void visit_legs(const std::vector<InstrumentKey>& keys, const Visit& visit) {
  const ToolPath path(keys);
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    const Vec3 leg = keys[k + 1].position - keys[k].position;
    Vec3 last = keys[k].position;
    for (int n = 1; n <= 100; ++n) {
      const double time = keys[k].time + (keys[k + 1].time - keys[k].time) * n / 100;
      const Vec3 x = path.at(time).translation;
      visit(keys[k].position, leg, x, last);
      last = x;
    }
  }
}

TEST(ToolPath, goes_forwards_along_each_leg_and_not_beyond) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial)
    visit_legs(random_keys(random, 6),
               [](const Vec3& start, const Vec3& leg, const Vec3& x, const Vec3& last) {
                 // Roundings of x (1e-17 m) times ways of up to 0.35 m.
                 EXPECT_GE((x - last).dot(leg), -1e-17);
                 EXPECT_LE((x - start).dot(leg), leg.squaredNorm() + 1e-17);
               });
}

// Aside, the slope at a key has at most (1 + w1 / w0) / 2 <= 1.5 times cos(turn) tan(turn / 2) <=
// 0.3003 of the leg's velocity; with that much at both ends a cubic lies a quarter of it off.
TEST(ToolPath, stays_beside_each_leg) {
  std::mt19937 random(4);
  double farthest = 0;
  for (int trial = 0; trial < 50; ++trial)
    visit_legs(random_keys(random, 8),
               [&](const Vec3& start, const Vec3& leg, const Vec3& x, const Vec3&) {
                 const Vec3 aside = (x - start) - leg * (x - start).dot(leg) / leg.squaredNorm();
                 farthest = std::max(farthest, aside.norm() / leg.norm());
               });
  std::printf("farthest from a leg: %.3f of its length\n", farthest);
  EXPECT_GT(farthest, 0.01);
  EXPECT_LT(farthest, 1.5 * 0.3003 / 4);
}

// By component the way depended on the axes: 2 mm on legs of 20.
TEST(ToolPath, turns_with_its_keys) {
  std::mt19937 random(8);
  const std::vector<InstrumentKey> keys = random_keys(random, 8);
  const Quat turn = Quat(0.3, -0.5, 0.7, 0.2).normalized();
  std::vector<InstrumentKey> turned = keys;
  for (InstrumentKey& key : turned) key.position = turn * key.position;
  const ToolPath path(keys), turned_path(turned);
  for (double time = 0; time < 6; time += 0.013) {
    const Vec3 expected = turn * path.at(time).translation;
    EXPECT_LT((turned_path.at(time).translation - expected).norm(), 1e-15) << time;
  }
}

TEST(ToolPath, is_straight_between_right_angles) {
  std::vector<InstrumentKey> keys(5);
  for (int k = 0; k < 5; ++k) keys[k].time = k;
  keys[1].position = Vec3(0.03, 0.04, 0);
  keys[2].position = keys[1].position + Vec3(0, 0, 0.02);
  keys[3].position = keys[2].position + Vec3(0.04, -0.03, 0);
  keys[4].position = keys[2].position;
  visit_legs(keys, [](const Vec3& start, const Vec3& leg, const Vec3& x, const Vec3&) {
    EXPECT_LT((x - start).cross(leg).norm(), 1e-17);
  });
}

// A slide at a constant depth, then away obliquely: without stops it goes 4 mm deeper than its
// keys.
TEST(ToolPath, is_straight_between_keys_that_stop) {
  std::vector<InstrumentKey> keys(3);
  keys[0] = {.time = 0.1, .position = Vec3(-0.045, 0.0013, 0.0175)};
  keys[1] = {.time = 1.0, .position = Vec3(0.045, 0.0013, 0.0175)};
  keys[2] = {.time = 1.2, .position = Vec3(0.06, 0.0013, 0.06)};
  const ToolPath::Bulge bulge = ToolPath(keys).largest_bulge();
  EXPECT_EQ(bulge.begin, 0.1);
  EXPECT_EQ(bulge.end, 1);
  EXPECT_NEAR(bulge.width, 3.8e-3, 0.2e-3);
  keys[1].stops = true;
  EXPECT_LT(ToolPath(keys).largest_bulge().width, 1e-17);
  visit_legs(keys, [](const Vec3& start, const Vec3& leg, const Vec3& x, const Vec3&) {
    EXPECT_LT((x - start).cross(leg).norm(), 1e-17);
  });
}

// A jump of the velocity at a key would show as a difference of the two one-sided slopes that does
// not vanish with h.
TEST(ToolPath, has_a_continuous_velocity) {
  std::mt19937 random(5);
  const std::vector<InstrumentKey> keys = random_keys(random, 10);
  const ToolPath path(keys);
  const double h = 1e-6;
  for (const InstrumentKey& key : keys) {
    const Vec3 x = path.at(key.time).translation;
    const Vec3 before = (x - path.at(key.time - h).translation) / h;
    const Vec3 after = (path.at(key.time + h).translation - x) / h;
    // One-sided differences differ by h times the mean second derivative; |x''| <= 12 * 0.2 m /
    // (0.05 s)^2.
    EXPECT_LT((after - before).norm(), h * 12 * 0.35 / (0.05 * 0.05)) << key.time;
  }
}

TEST(ToolPath, starts_and_ends_at_rest) {
  std::mt19937 random(6);
  const std::vector<InstrumentKey> keys = random_keys(random, 4);
  const ToolPath path(keys);
  const double h = 1e-6;  // x = x0 + O(h^2) with |x''| as above
  const double bound = h * 12 * 0.35 / (0.05 * 0.05);
  EXPECT_LT((path.at(keys.front().time + h).translation - keys.front().position).norm() / h, bound);
  EXPECT_LT((path.at(keys.back().time - h).translation - keys.back().position).norm() / h, bound);
}

TEST(ToolPath, turns_at_a_turning_point_without_going_beyond) {
  std::vector<InstrumentKey> keys(3);
  for (int k = 0; k < 3; ++k) keys[k].time = k;
  keys[1].position = Vec3(0.1, 0, 0);
  const ToolPath path(keys);
  double highest = 0;
  for (int n = 0; n <= 2000; ++n) highest = std::max(highest, path.at(1e-3 * n).translation.x());
  EXPECT_LE(highest, 0.1 + 1e-16);
}

TEST(ToolPath, of_equally_spaced_keys_on_a_line_keeps_its_speed_inside) {
  std::vector<InstrumentKey> keys;
  for (int k = 0; k < 6; ++k) keys.push_back({.time = 0.5 * k, .position = Vec3(0.01 * k, 0, 0)});
  const ToolPath path(keys);
  // Harmonic mean of equal slopes is the slope: the inner cubics are the line itself.
  for (double time = 0.5; time <= 2.0; time += 0.07)
    EXPECT_NEAR(path.at(time).translation.x(), 0.02 * time, 1e-16);
}

TEST(ToolPath, rotations_stay_unit_quaternions) {
  std::mt19937 random(7);
  const std::vector<InstrumentKey> keys = random_keys(random, 8);
  const ToolPath path(keys);
  for (double time = 0; time < keys.back().time + 0.5; time += 0.013) {
    const Mat3 R = path.at(time).rotation.toRotationMatrix();
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-14);  // roundings of 27 products
    EXPECT_GT(R.determinant(), 0);
  }
}

// Keys half a second apart that turn about the shaft to these angles [rad].
std::vector<InstrumentKey> turning_keys(const std::vector<double>& angles) {
  std::vector<InstrumentKey> keys;
  for (const double angle : angles)
    keys.push_back({.time = 0.5 * static_cast<double>(keys.size()),
                    .forward = Vec3(std::cos(angle), std::sin(angle), 0)});
  return keys;
}

// [rad / s]
double turning_rate(const ToolPath& path, double t0, double t1) {
  return path.at(t0).rotation.angularDistance(path.at(t1).rotation) / (t1 - t0);
}

// Snellius' angle x of a quaternion is x^4 / 180 too small: 3e-7 of a
// turn by 10 degrees, 2e-3 of one by 90; the cubic's own error is as much.
TEST(ToolPath, turns_at_a_constant_rate_through_equal_turns) {
  for (const auto& [degrees, tolerance] : {std::pair(10.0, 1e-6), std::pair(90.0, 4e-3)}) {
    const double angle = degrees * std::numbers::pi / 180;
    std::vector<double> angles;
    for (int k = 0; k < 8; ++k) angles.push_back(k * angle);
    const ToolPath path(turning_keys(angles));
    for (double time = 0.5; time < 2.95; time += 0.013)
      EXPECT_NEAR(turning_rate(path, time, time + 0.01), 2 * angle, tolerance * 2 * angle) << time;
  }
}

TEST(ToolPath, stops_turning_at_keys_that_stop_and_at_the_ends) {
  std::vector<InstrumentKey> keys = turning_keys({0, 0.3, 0.6, 0.9});
  keys[1].stops = true;
  const ToolPath path(keys);
  const double h = 1e-6;  // |rate'| <= 12 * 0.3 / 0.5^2 of a cubic
  for (const double time : {0.0, 0.5, 1.5 - h}) {
    EXPECT_LT(turning_rate(path, time, time + h), h * 15) << time;
  }
  EXPECT_LT(turning_rate(path, 0.5 - h, 0.5), h * 15);
  EXPECT_GT(turning_rate(path, 1, 1 + h), 0.5);  // of 0.6
}

TEST(ToolPath, has_a_continuous_turning_rate) {
  std::mt19937 random(10);
  const std::vector<InstrumentKey> keys = random_keys(random, 10);
  const ToolPath path(keys);
  const double h = 1e-6;
  for (const InstrumentKey& key : keys) {
    const Quat before = path.at(key.time - h).rotation, at = path.at(key.time).rotation,
               after = path.at(key.time + h).rotation;
    const Vec3 rates = ((at * before.conjugate()).vec() - (after * at.conjugate()).vec()) / h;
    // As of positions, of quaternions that are at most sqrt(2) apart.
    EXPECT_LT(rates.norm(), h * 12 * 1.5 / (0.05 * 0.05)) << key.time;
  }
}

TEST(ToolPath, turns_forwards_to_its_keys_and_rests_between_equal_ones) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> angles = {0};
    for (int k = 0; k < 6; ++k)
      angles.push_back(angles.back() + (k == 3 ? 0 : 0.9 * std::numbers::pi * unit(random)));
    const ToolPath path(turning_keys(angles));
    for (double time = 0; time < 3; time += 0.007) {
      const Vec3 x = path.at(time).rotation * Vec3::UnitX(),
                 next = path.at(time + 0.007).rotation * Vec3::UnitX();
      EXPECT_GE(x.cross(next).z(), -1e-15) << time;  // roundings
    }
    EXPECT_LT(turning_rate(path, 1.6, 1.9), 1e-14);
  }
}

TEST(ToolPath, of_two_keys_turns_from_rest_to_rest) {
  std::mt19937 random(12);
  const std::vector<InstrumentKey> keys = random_keys(random, 2);
  const ToolPath path(keys);
  const Eigen::Vector4d q0 = path.at(keys[0].time).rotation.coeffs(),
                        q1 = path.at(keys[1].time).rotation.coeffs();
  for (double s = 0; s < 1; s += 0.01) {
    const double time = keys[0].time + s * (keys[1].time - keys[0].time);
    const Eigen::Vector4d q = q0 + s * s * (3 - 2 * s) * (q1 - q0);
    EXPECT_LT((path.at(time).rotation.coeffs() - q.normalized()).norm(), 1e-14) << s;
  }
}

TEST(ToolPath, rotations_take_the_short_way) {
  const std::vector<InstrumentKey> keys = {{.time = 0, .direction = Vec3(0, 0.1, -1)},
                                           {.time = 1, .direction = Vec3(0, -0.1, -1)}};
  const ToolPath path(keys);
  const Vec3 z = path.at(0.5).rotation * Vec3::UnitZ();
  EXPECT_LT((z - Vec3::UnitZ()).norm(),
            1e-15);  // the middle of two mirrored directions, by symmetry
}

TEST(ToolPath, between_equal_orientations_keeps_the_orientation) {
  const std::vector<InstrumentKey> keys = {
      {.time = 0, .direction = Vec3(0.3, 0.2, -1)},
      {.time = 1, .position = Vec3(1, 0, 0), .direction = Vec3(0.3, 0.2, -1)}};
  const ToolPath path(keys);
  EXPECT_LT((path.at(0.37).rotation.coeffs() - path.at(0).rotation.coeffs()).norm(), 1e-15);
}

TEST(ToolRotation, puts_z_against_the_direction_and_x_towards_forward) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 100; ++k) {
    const Vec3 direction(unit(random), unit(random), unit(random)),
        forward(unit(random), unit(random), unit(random));
    const Mat3 R = tool_rotation(direction, forward).toRotationMatrix();
    EXPECT_LT((R.col(2) + direction.normalized()).norm(), 1e-14);
    const Vec3 across = forward - R.col(2) * R.col(2).dot(forward);
    EXPECT_LT((R.col(0) - across.normalized()).norm(),
              1e-13);  // `across` may be ten times shorter than forward
    EXPECT_GT(R.determinant(), 0);
  }
}

TEST(ToolPath, travel_is_the_length_of_a_straight_way) {
  const std::vector<InstrumentKey> keys = {{.time = 0},
                                           {.time = 2, .position = Vec3(0, 0.03, 0.04)}};
  const ToolPath path(keys);
  const Box box{Vec3(-0.01, 0, 0), Vec3(0.02, 0.01, 0.1)};
  EXPECT_NEAR(path.travel(0, 2, box), 0.05, 1e-16);
  EXPECT_EQ(path.travel(2, 5, box), 0);
}

// A turn by the angle a about the tip moves a point at `reach` along chords, which are at most the
// arc and at least the whole chord.
TEST(ToolPath, travel_counts_the_turn_of_the_shaft) {
  const double a = 0.5, reach = 0.02;
  const std::vector<InstrumentKey> keys = {
      {.time = 0, .direction = Vec3(0, 0, -1)},
      {.time = 1, .direction = Vec3(0, std::sin(a), -std::cos(a))}};
  const ToolPath path(keys);
  const Box shaft{Vec3::Zero(), Vec3(0, 0, reach)}, tip{Vec3::Zero(), Vec3::Zero()};
  EXPECT_LE(path.travel(0, 1, shaft), reach * a);
  EXPECT_GE(path.travel(0, 1, shaft), 2 * reach * std::sin(a / 2));
  EXPECT_EQ(path.travel(0, 1, tip), 0);
}

TEST(DisplacementPath, rests_to_the_bit_between_equal_keys) {
  for (const double value : {0.7, 0.3, 5.0, -1e-3}) {
    const Vec3 held(value, 0.1, 2);
    const DisplacementPath path({{.time = 0, .displacement = Vec3::Zero()},
                                 {.time = 0.1, .displacement = held},
                                 {.time = 3, .displacement = held},
                                 {.time = 3.3, .displacement = Vec3::Zero()}});
    for (int k = 3; k < 90; ++k) EXPECT_EQ(path.travel(k / 30., (k + 1) / 30.), 0) << value;
    EXPECT_GT(path.travel(3, 3.1), 0);
  }
}

TEST(DisplacementPath, follows_the_same_rule_as_a_tool) {
  std::mt19937 random(9);
  std::vector<InstrumentKey> keys = random_keys(random, 6);
  keys[3].stops = true;
  std::vector<SupportKey> support;
  for (const InstrumentKey& key : keys)
    support.push_back({.time = key.time, .displacement = key.position, .stops = key.stops});
  const ToolPath tool(keys);
  const DisplacementPath path(support);
  for (double time = 0; time < keys.back().time + 0.5; time += 0.017)
    EXPECT_EQ(path.at(time), tool.at(time).translation);
}

}  // namespace
}  // namespace trocar
