// Tissue on tissue, through the whole frame: what rests, slides and collides, and a body that a cut
// has parted and something presses together again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "collision/tissue_pairs.h"
#include "engine/energy_ledger.h"
#include "engine/frame_report.h"
#include "engine_motion.h"
#include "engine_started.h"
#include "mesh/generate.h"
#include "mesh_joined.h"
#include "mesh_write.h"

namespace trocar {
namespace {

std::string with_tissue(double friction) {
  return "[contact]\ntissue = true\nfriction = " + std::to_string(friction) + "\n";
}

std::unique_ptr<Started> two_bodies(const Mesh& first, const Mesh& second,
                                    const std::string& tables) {
  const TestFolder folder;
  write_mesh(joined(first, second), folder.file("two.vtu"));
  auto started = built("[time]\nduration = 10\nframe_rate = 60\n[tissue]\nmesh = \"" +
                       folder.file("two.vtu") + "\"\n" + tables);
  return started;
}

void run_frames(Started& started, int n) {
  for (int frame = 0; frame < n; ++frame) run_frame(*started.s, started.outputs);
}

// Of the mass of the nodes that lie beyond `from` along axis j, or not (the file's order of nodes
// is not kept); field: (n_nodes * 3).
Vec3 mean(const Simulation& s, int j, double from, bool is_beyond,
          const std::vector<double>& field) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < s.mass.size(); ++i) {
    if ((s.mesh.X[i][j] > from) != is_beyond) continue;
    sum += s.mass[i] * Vec3::Map(&field[3 * i]);
    mass += s.mass[i];
  }
  return sum / mass;
}

// A block of 30 x 30 x 15 mm on one of 70 x 50 x 15 mm that is held below; turned gravity makes it
// lie on an incline.
struct OnIncline {
  Mesh lower = make_box({-0.025, -0.025, 0}, {0.045, 0.025, 0.015}, {12, 9, 3}, BoxElements::hex8);
  Mesh upper =
      make_box({-0.015, -0.015, 0.015}, {0.015, 0.015, 0.03}, {5, 5, 3}, BoxElements::tet4_five);
  std::unique_ptr<Started> started;

  OnIncline(const Vec3& gravity, double friction, double mass_damping) {
    started = two_bodies(
        lower, upper,
        "[[region]]\nname = \"floor\"\nlow = [-1, -1, -0.001]\nhigh = [1, 1, 0.001]\n"
        "[[support]]\nregion = \"floor\"\n[tissue.material]\nyoung_modulus = 6000\n"
        "poisson_ratio = 0.4\ndensity = 1060\n[solver]\nmass_damping = " +
            std::to_string(mass_damping) + "\ngravity = [" + std::to_string(gravity.x()) + ", 0, " +
            std::to_string(gravity.z()) + "]\n" + with_tissue(friction));
    open_energy_ledger(*started->s);
  }
  double centre(int j) const { return mean(*started->s, 2, 0.01505, true, started->s->state.u)[j]; }
};

TEST(ContactOfTissue, holds_a_block_on_a_block_on_an_incline) {
  const OnIncline block(g * Vec3(0.28, 0, -0.96), 0.5, 60);
  run_frames(*block.started, 30);
  const double x = block.centre(0), z = block.centre(2);
  const std::int64_t first = block.started->s->state.step;
  run_frames(*block.started, 120);
  const double steps = static_cast<double>(block.started->s->state.step - first);
  std::printf("drift %.2g and %.2g mm in %.0f steps\n", 1e3 * (block.centre(0) - x),
              1e3 * (block.centre(2) - z), steps);
  EXPECT_NEAR(block.centre(0), x, 0.02e-3);
  EXPECT_NEAR(block.centre(2), z, 0.02e-3);
  EXPECT_LT(block.started->s->log.rows.back().energy.kinetic, 1e-8);
  EXPECT_LT(std::abs(block.started->s->log.rows.back().energy_error), 1e-6);
}

TEST(ContactOfTissue, lets_a_block_slide_down_a_block_as_coulombs_law_says) {
  const double sine = 0.6, cosine = 0.8, friction = 0.5, alpha = 60;
  const OnIncline block(g * Vec3(sine, 0, -cosine), 10, alpha);
  run_frames(*block.started, 30);  // held, to rest
  block.started->s->contact->options.friction = friction;
  const double start = block.centre(0), t = 0.5, a = g * (sine - friction * cosine);
  run_frames(*block.started, 30);
  // x'' = a - alpha x'; the shear in which both were held goes over into way.
  const double way = a / alpha * (t - (1 - std::exp(-alpha * t)) / alpha);
  std::printf("slid by %g m, reference %g\n", block.centre(0) - start, way);
  EXPECT_NEAR(block.centre(0) - start, way, 1.5e-3);
}

// Without Poisson's effect a bar is a spring of its theory: the waves that run from the impact to
// both ends and back take the time 2 L / c, then the bars have exchanged their velocities and are
// free (Graff, Wave Motion in Elastic Solids, 2.4). Returns by which share of them they miss that.
double miss_of_bars(int n) {
  constexpr double length = 0.06, speed = 0.05, E = 6000, rho = 1000;
  const auto bars =
      two_bodies(make_box({0, 0, 0}, {length, 0.01, 0.01}, {n, 3, 3}, BoxElements::hex8),
                 make_box({length + 1e-4, 0, 0}, {2 * length + 1e-4, 0.01, 0.01}, {n, 3, 3},
                          BoxElements::hex8),
                 "[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0\ndensity = 1000\n" +
                     with_tissue(0));
  Simulation& s = *bars->s;
  for (std::size_t i = 0; i < s.mass.size(); ++i)
    s.state.v[3 * i] = s.mesh.X[i].x() < length + 1e-5 ? speed : -speed;
  open_energy_ledger(s);
  const double kinetic = 0.5 * 2 * length * 1e-4 * rho * speed * speed;
  const auto velocity = [&](bool is_second) {
    return mean(s, 0, length + 1e-5, is_second, s.state.v);
  };
  const int n_frames = static_cast<int>(60 * (2 * length / std::sqrt(E / rho) + 0.04));
  for (int frame = 0; frame < n_frames; ++frame) {
    run_frames(*bars, 1);
    EXPECT_LT((velocity(false) + velocity(true)).norm(), 1e-12 * speed);  // of equal masses
    EXPECT_LE(s.log.rows.back().works.contact, 1e-12);
    EXPECT_LT(std::abs(s.log.rows.back().energy_error), 1e-3 * kinetic);
  }
  std::printf("%d cells: %.4f of the velocity\n", n, velocity(true).x() / speed);
  return std::abs(velocity(true).x() / speed - 1);
}

// What misses is the speed of the touching nodes, half a cell of each bar, and waves shorter than
// the cells resolve.
TEST(ContactOfTissue, lets_equal_bars_exchange_their_velocities) {
  const double coarse = miss_of_bars(24), fine = miss_of_bars(48);
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(fine, 0.7 * coarse);
}

// Strain energy of a block that is held below and pressed by 3 mm from above, parted across its
// height, or whole with its nodes moved as the cut moves them. Without Poisson's effect it is
// strained alike everywhere, so that nothing pulls the lips apart: a patch test.
double energy_of_pressed(bool is_parted) {
  const auto block = built(
      "[time]\nduration = 10\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nlow = [-0.02, "
      "-0.02, 0]\nhigh = [0.02, 0.02, 0.03]\ncells = [8, 8, 6]\nelements = \"tet4-five\"\n"
      "[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0\n[solver]\nmass_damping = 60\n"
      "[[support]]\nregion = \"z-\"\n[[support]]\nregion = \"z+\"\npath = [{ time = 0, "
      "displacement = [0, 0, 0] }, { time = 0.4, displacement = [0, 0, -0.003] }]\n" +
      with_tissue(10));
  Simulation& s = *block->s;
  open_energy_ledger(s);
  GlobalState global = gather_state(s);
  CutFigures figures;
  MeshEdit edit = cut_across(s, global, figures);
  if (!is_parted) edit = {.moves = edit.moves, .density = edit.density};
  CutRecord record;
  apply_cut(s, edit, global, record);
  refresh_surface(s);
  EXPECT_EQ(s.n_pieces, is_parted ? 2 : 1);
  run_frames(*block, 60);
  return s.log.rows.back().energy.strain;
}

TEST(ContactOfTissue, lets_a_parted_block_answer_like_a_whole_one) {
  const double whole = energy_of_pressed(false), parted = energy_of_pressed(true);
  std::printf("strain energy %.6g, whole %.6g J\n", parted, whole);
  EXPECT_NEAR(parted, whole, 0.01 * whole);
}

// How many nodes of a strip's surface lie deeper than a tenth of its thickness in other parts of
// it, once its ends have been laid onto each other and its arms hang down side by side.
int n_deep_in_folded_strip(bool has_contact) {
  const auto strip = built(
      "[time]\nduration = 10\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nlow = [-0.06, "
      "-0.015, 0]\nhigh = [0.06, 0.015, 0.003]\ncells = [32, 8, 1]\nelements = \"hex8\"\n"
      "[tissue.material]\nyoung_modulus = 20000\npoisson_ratio = 0.4\n[solver]\nmass_damping = 20"
      "\ngravity = [0, 0, -2]\n[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n"
      "path = [{ time = 0, displacement = [0, 0, 0] }, { time = 0.5, displacement = [-0.03, 0, "
      "0.04] }, { time = 1.2, displacement = [-0.11, 0, 0.025] }, { time = 1.8, displacement = "
      "[-0.11, 0, 0.0005] }]\n[contact]\ntissue = true\n",
      {has_contact ? "contact.tissue=true" : "contact.tissue=false"});
  Simulation& s = *strip->s;
  run_frames(*strip, 130);
  refresh_surface(s);
  const SurfaceTree tree(s.surface.triangle, s.view.x);
  std::vector<TissuePair> pairs;
  find_tissue_pairs(tree, s.view.x, 0.003, pairs);
  std::set<std::int32_t> deep;
  for (const TissuePair& pair : pairs) {
    const auto x = [&](std::int32_t i) { return s.view.x[i]; };
    const Triangle triangle = {x(pair.corner[0]), x(pair.corner[1]), x(pair.corner[2])};
    if (touch_tissue(x(pair.node), triangle).height < -0.0003) deep.insert(pair.node);
  }
  return static_cast<int>(deep.size());
}

TEST(ContactOfTissue, keeps_the_arms_of_a_folded_strip_apart) {
  EXPECT_EQ(n_deep_in_folded_strip(true), 0);
  EXPECT_GT(n_deep_in_folded_strip(false), 20);
}

// A body that a support moves as a whole presses as a platen: its force was lost, since contact
// moves none of its nodes.
TEST(ContactOfTissue, bears_on_what_supports_hold) {
  constexpr double width = 0.03, height = 0.01, gap = 1e-4;
  const auto blocks = two_bodies(
      make_box({0, 0, 0}, {width, width, height}, {5, 5, 3}, BoxElements::hex8),
      make_box({0, 0, height + gap}, {width, width, 2 * height}, {4, 4, 2}, BoxElements::hex8),
      "[[region]]\nname = \"floor\"\nlow = [-1, -1, -0.001]\nhigh = [1, 1, 0.001]\n"
      "[[support]]\nregion = \"floor\"\n[[region]]\nname = \"upper\"\nlow = [-1, -1, "
      "0.01005]\nhigh = [1, 1, 1]\n[[support]]\nregion = \"upper\"\n"
      "path = [{ time = 0, displacement = [0, 0, 0] }, { time = 0.3, displacement = "
      "[0, 0, -0.0015] }]\n[tissue.material]\nyoung_modulus = 6000\n[solver]\n"
      "mass_damping = 40\n" +
          with_tissue(0));
  Simulation& s = *blocks->s;
  open_energy_ledger(s);
  run_frames(*blocks, 40);
  const FrameRow& row = s.log.rows.back();
  const double floor = row.support_forces[0].z(), platen = row.support_forces[1].z();
  std::printf("floor %.4f N, platen %.4f N\n", floor, platen);
  EXPECT_GT(platen, 0.3);
  EXPECT_NEAR(floor, -platen, 1e-3 * platen);
  EXPECT_LT(std::abs(row.energy_error), 1e-3 * row.energy.strain);
  EXPECT_NEAR(row.works.holds, row.energy.strain, 0.3 * row.energy.strain);  // damping takes some
}

TEST(ContactOfTissue, is_refused_for_plane_bodies_and_for_bodies_that_sleep) {
  const std::string plane =
      "[time]\nduration = 1\n[tissue.shape]\nkind = \"rectangle\"\nhigh = [0.07, 0.04, 0]\n"
      "cells = [7, 4, 1]\n[tissue.material]\nyoung_modulus = 6000\n";
  EXPECT_TRUE(contains(error_of([&] { built(plane + with_tissue(0)); }), "contact.tissue"));
  const std::string block =
      "[time]\nduration = 1\n[tissue.shape]\nkind = \"box\"\n[tissue.material]\nyoung_modulus = "
      "6000\n[solver]\nsleep = 0.001\n";
  EXPECT_TRUE(contains(error_of([&] { built(block + with_tissue(0)); }), "contact.tissue"));
}

}  // namespace
}  // namespace trocar
