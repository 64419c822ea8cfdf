// A soft block on a rigid sphere, through the whole frame: what a contact may do with energy, and
// what Coulomb's law says of bodies that deform.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/energy_ledger.h"
#include "engine_motion.h"
#include "engine_started.h"
#include "larger_or_nan.h"

namespace trocar {
namespace {

constexpr double height = 0.03;

// Of mass.
double centre(const Simulation& s, int j) {
  double sum = 0, mass = 0;
  for (std::size_t i = 0; i < s.mass.size(); ++i) {
    sum += s.mass[i] * (s.mesh.X[i][j] + s.state.u[3 * i + static_cast<std::size_t>(j)]);
    mass += s.mass[i];
  }
  return sum / mass;
}

// 40 x 40 x 30 mm above a sphere whose top is `drop` below it.
std::unique_ptr<Started> make_block(double sphere_radius, double drop, const Vec3& gravity,
                                    double friction, double mass_damping) {
  const auto number = [](double x) { return std::to_string(x); };
  auto block = built(
      "[time]\nduration = 10\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\n"
      "low = [-0.02, -0.02, 0]\nhigh = [0.02, 0.02, 0.03]\ncells = [6, 6, 5]\nelements = "
      "\"hex8\"\n"
      "[tissue.material]\nmodel = \"neo-hookean\"\nyoung_modulus = 6000\npoisson_ratio = 0.45\n"
      "density = 1060\n[solver]\nmass_damping = " +
      number(mass_damping) + "\ngravity = [" + number(gravity.x()) + ", 0, " + number(gravity.z()) +
      "]\n[contact]\nfriction = " + number(friction) +
      "\n[[instrument]]\nkind = \"probe\"\nradius = " + number(sphere_radius) +
      "\nlength = " + number(3 * sphere_radius) + "\npath = [{ time = 0, position = [0, 0, " +
      number(-drop) + "], direction = [0, 0, 1] }]\n");
  open_energy_ledger(*block->s);
  return block;
}

// Found once a frame at one point a triangle, the ball threw this block back with twenty times its
// energy.
TEST(ContactOfABlock, takes_energy_from_one_that_falls_onto_a_ball_and_gives_none) {
  for (const double friction : {0.0, 0.3}) {
    const auto block = make_block(0.03, 5e-3, Vec3(0, 0, -g), friction, 0);
    double impact = 0, largest_error = 0, least_J = 1;
    for (int frame = 0; frame < 30; ++frame) {
      run_frame(*block->s, block->outputs);
      const FrameRow& row = block->s->log.rows.back();
      impact = larger_or_nan(impact, row.energy.kinetic);
      largest_error = larger_or_nan(largest_error, std::abs(row.energy_error));
      least_J = std::min(least_J, row.least_J);
      EXPECT_LE(row.works.contact, 0) << frame;
    }
    EXPECT_LT(block->s->energy->memory.works.contact, -0.05 * impact);
    EXPECT_LT(largest_error, 0.02 * impact);
    EXPECT_GT(least_J, 0.7);
  }
}

// A sphere of 30 m is flat to 0.01 mm under the block.
TEST(ContactOfABlock, lets_it_slide_down_an_incline_as_coulombs_law_says) {
  const double sine = 0.6, cosine = 0.8, friction = 0.5, alpha = 60;
  const auto block = make_block(30, 0, g * Vec3(sine, 0, -cosine), 10, alpha);
  for (int frame = 0; frame < 30; ++frame) run_frame(*block->s, block->outputs);  // held, to rest
  block->s->contact->options.friction = friction;
  const double start = centre(*block->s, 0), t = 1, a = g * (sine - friction * cosine);
  for (int frame = 0; frame < 60; ++frame) run_frame(*block->s, block->outputs);
  // x'' = a - alpha x'; the shear of 1.5 mm in which it was held goes over into way.
  const double way = a / alpha * (t - (1 - std::exp(-alpha * t)) / alpha);
  std::printf("slid by %g m, reference %g\n", centre(*block->s, 0) - start, way);
  EXPECT_NEAR(centre(*block->s, 0) - start, way, 1.5e-3);
}

TEST(ContactOfABlock, holds_it_on_a_flatter_incline) {
  const auto block = make_block(30, 0, g * Vec3(0.28, 0, -0.96), 0.5, 60);
  for (int frame = 0; frame < 30; ++frame) run_frame(*block->s, block->outputs);
  const double start = centre(*block->s, 0);
  const std::int64_t first = block->s->state.step;
  for (int frame = 0; frame < 180; ++frame) run_frame(*block->s, block->outputs);
  const double drift = (centre(*block->s, 0) - start) / height;
  const double steps = static_cast<double>(block->s->state.step - first);
  std::printf("drift %.2g of the height in %.0f steps\n", drift, steps);
  // With a friction that had to slip in order to hold it slid by g sin(angle) dt / 0.2 t: 12 mm.
  EXPECT_LT(std::abs(drift), 1e-7);
  // A sphere as flat as that takes none of the step.
  EXPECT_LT(steps, 4000);
  EXPECT_LT(block->s->log.rows.back().energy.kinetic, 1e-6);
}

}  // namespace
}  // namespace trocar
