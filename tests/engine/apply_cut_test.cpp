// What a cut of a simulated body keeps, and what becomes of a piece that it frees.
#include "engine/apply_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/body_positions.h"
#include "engine/frame_watch.h"
#include "engine_blocks.h"
#include "engine_scene.h"
#include "engine_split.h"
#include "engine_started.h"
#include "largest.h"
#include "mesh/connected_nodes.h"
#include "mesh/quality.h"
#include "mesh_fixtures.h"
#include "solver/frequency.h"
#include "solver/history.h"
#include "solver/step.h"
#include "solver/viscous_step.h"

namespace trocar {
namespace {

// A blade through the middle, 18 degrees off the level and more than the block wide, in 0.1 s.
const std::string level_blade =
    "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.05\npath = [\n"
    "{ time = 0.02, position = [-0.03, 0.025, 0.006], direction = [0, 1, 0], "
    "forward = [1, 0, 0.3] },\n"
    "{ time = 0.12, position = [0.03, 0.025, 0.024], direction = [0, 1, 0], "
    "forward = [1, 0, 0.3] } ]\n";

const std::string hanging =
    "[solver]\ngravity = [0, 0, -9.81]\n[[support]]\nregion = \"z+\"\nfix = \"xyz\"\n"
    "[checkpoint]\nevery = 0\n";

// Centre of mass of the nodes that hang together with node `root`.
Vec3 centre_of(const Simulation& s, const std::vector<std::int32_t>& piece, std::int32_t root) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (piece[i] != root) continue;
    const Vec3 u(s.state.u[3 * i], s.state.u[3 * i + 1], s.state.u[3 * i + 2]);
    sum += s.mass[i] * (s.mesh.X[i] + u);
    mass += s.mass[i];
  }
  return sum / mass;
}

TEST(FreedPiece, falls_like_a_body_of_its_own_and_is_counted) {
  for (const char* elements : {"tet4-kuhn", "hex8"}) {
    const auto started = built(short_block(elements, hanging + level_blade));
    Simulation& s = *started->s;
    Outputs outputs;
    while (s.frame < 14) run_frame(s, outputs);
    ASSERT_EQ(s.n_pieces, 2) << elements;
    ASSERT_EQ(s.cuts[0].strokes.size(), 1U);
    EXPECT_EQ(s.cuts[0].strokes[0].n_pieces, 2);
    EXPECT_EQ(s.log.rows.front().n_pieces, 1);
    EXPECT_EQ(s.log.rows.back().n_pieces, 2);
    // What falls off leaves no wound that grows as it falls.
    EXPECT_EQ(s.log.rows.back().wound_width, 0);
    EXPECT_EQ(std::count_if(s.log.events.begin(), s.log.events.end(),
                            [](const std::string& e) { return e.find("piece") != e.npos; }),
              1);
    // Node 0 is at the lower side. No force but its weight: z(t) = z0 + v t - g t^2 / 2, where two
    // frames give z0 and v.
    const std::vector<std::int32_t> piece = connected_nodes(s.mesh);
    std::vector<Vec3> centre;
    for (int k = 0; k <= 5; ++k) {
      centre.push_back(centre_of(s, piece, piece[0]));
      run_frame(s, outputs);
    }
    const double T = 0.01;  // of a frame
    for (int k = 2; k <= 5; ++k) {
      const Vec3 expected = centre[0] + k * (centre[1] - centre[0]) -
                            0.5 * 9.81 * T * T * k * (k - 1) * Vec3::UnitZ();
      // Central differences are exact for constant acceleration and a constant step; the step
      // changes a little from frame to frame: v is off by g times half the change, below 1e-6 s.
      EXPECT_LT((centre[std::size_t(k)] - expected).norm(), 1e-5 * T * k) << elements << k;
    }
    // And it is clear of the other one: 0.1 s after it came free 5 cm below.
    while (s.frame < 25) run_frame(s, outputs);
    EXPECT_LT(centre_of(s, piece, piece[0]).z(), centre[0].z() - 0.02);
  }
}

TEST(FreedPiece, can_be_grasped) {
  const std::string grasper =
      "[[instrument]]\nkind = \"grasper\"\ngrip_radius = 0.008\npath = [\n"
      "{ time = 0, position = [0, 0, -0.003], direction = [0, 0, 1], forward = [0, 1, 0] },\n"
      "{ time = 0.05, position = [0, 0, -0.003], direction = [0, 0, 1], forward = [0, 1, 0], "
      "action = \"close\" } ]\n";
  const auto started = built(short_block("hex8", hanging + level_blade + grasper));
  Simulation& s = *started->s;
  Outputs outputs;
  while (s.frame < 40) run_frame(s, outputs);
  ASSERT_EQ(s.n_pieces, 2);
  ASSERT_FALSE(s.holds.holds.empty());
  const std::vector<std::int32_t> piece = connected_nodes(s.mesh);
  for (const Hold& hold : s.holds.holds) EXPECT_EQ(piece[hold.node], piece[0]);
  // Free, it would be 0.5 g (0.28 s)^2 = 38 cm lower.
  EXPECT_GT(centre_of(s, piece, piece[0]).z(), -0.01);
}

// A support that leaves tissue free to slide does not hold a bit of it: a blade that goes back and
// forth parted one tetrahedron off.
TEST(FreedPiece, is_no_chip_that_slides_on_a_support) {
  const auto at = [](double time, double x) {
    return "{ time = " + std::to_string(time) + ", position = [" + std::to_string(x) +
           ", 0.0013, -0.005], direction = [0, 0, -1], forward = [1, 0, 0] },\n";
  };
  const auto started = built(
      "[time]\nduration = 1\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\n"
      "elements = \"tet4-five\"\nlow = [-0.03, -0.02, 0]\nhigh = [0.03, 0.02, 0.02]\n"
      "cells = [15, 10, 5]\n[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0.4\n"
      "[solver]\nmass_damping = 20\n[[support]]\nregion = \"z-\"\nfix = \"z\"\n"
      "[checkpoint]\nevery = 0\n[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.035\n"
      "path = [\n" +
      at(0, -0.045) + at(0.36666667, 0.01) + at(0.51333333, -0.012) + at(0.68666667, 0.014) +
      at(0.79333333, -0.002) + at(1.1066667, 0.045) + "]\n");
  Simulation& s = *started->s;
  while (s.frame < 70) run_frame(s, started->outputs);
  EXPECT_EQ(s.n_pieces, 2);
}

struct MassAndMomenta {
  double mass = 0;
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
};

MassAndMomenta momenta_of(const Simulation& s) {
  MassAndMomenta m;
  for (std::size_t i = 0; i < s.mass.size(); ++i) {
    const Vec3 u(s.state.u[3 * i], s.state.u[3 * i + 1], s.state.u[3 * i + 2]);
    const Vec3 v(s.state.v[3 * i], s.state.v[3 * i + 1], s.state.v[3 * i + 2]);
    m.mass += s.mass[i];
    m.momentum += s.mass[i] * v;
    m.angular += s.mass[i] * (s.mesh.X[i] + u).cross(v);
  }
  return m;
}

// Velocities that no rigid motion has.
void set_in_motion(Simulation& s) {
  for (std::size_t i = 0; i < s.mass.size(); ++i) {
    const Vec3& X = s.mesh.X[i];
    const Vec3 v = Vec3(1, 2, -1) + Vec3(300 * X.y() * X.x(), -40 * X.z(), 500 * X.x() * X.x());
    for (std::size_t k = 0; k < 3; ++k) s.state.v[3 * i + k] = v[static_cast<Eigen::Index>(k)];
  }
}

// One cut by a blade that sweeps the whole block at once; returns its record.
CutRecord cut_at_once(Simulation& s) {
  GlobalState global = gather_state(s);
  CutFigures figures;
  const MeshEdit edit = cut_across(s, global, figures);
  CutRecord record;
  apply_cut(s, edit, global, record);
  record.figures.n_converted = figures.n_converted;
  return record;
}

// The step after an edit comes from a search around it and from what was known: a search of the
// whole body from nothing may only find a longer one, up to what either may stop short of.
TEST(ApplyCut, does_not_miss_a_mode_that_is_faster_after_the_edit) {
  for (const char* elements : {"tet4-kuhn", "tet4-five", "hex8"}) {
    const auto started = built(short_block(elements, hanging + level_blade));
    Simulation& s = *started->s;
    Outputs outputs;
    std::int64_t n_edits = 0;
    while (s.frame < 14) {
      run_frame(s, outputs);
      if (s.cuts[0].strokes.empty() || s.cuts[0].strokes[0].n_edits == n_edits) continue;
      n_edits = s.cuts[0].strokes[0].n_edits;
      const double step = s.watch.stable_step;
      s.look.is_done = false;
      watch_state(s);
      EXPECT_LT(step / s.watch.stable_step, frequency_margin) << elements << s.frame;
    }
    EXPECT_GE(n_edits, 3);
  }
}

TEST(ApplyCut, keeps_mass_and_both_momenta_where_hexahedra_are_converted) {
  const auto started = built(short_block("hex8", ""));
  Simulation& s = *started->s;
  set_in_motion(s);
  const MassAndMomenta before = momenta_of(s);
  const CutRecord record = cut_at_once(s);
  const MassAndMomenta after = momenta_of(s);
  EXPECT_GT(record.figures.n_converted, 0);
  EXPECT_EQ(s.n_pieces, 2);
  // Rounding of some hundred terms; velocities are of 2 m/s, positions of 0.03 m.
  EXPECT_NEAR(after.mass, before.mass, 1e-14 * before.mass);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-13 * before.mass * 2);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-13 * before.mass * 2 * 0.03);
}

// Strain energy is restored by moving nodes: boxes that they left behind would hide them from the
// next blade of the frame.
TEST(ApplyCut, leaves_the_elements_boxes_where_the_nodes_are) {
  for (const char* elements : {"hex8", "tet4-kuhn"}) {
    const auto started = built(short_block(elements, ""));
    Simulation& s = *started->s;
    for (std::size_t i = 0; i < s.mass.size(); ++i) {
      const double phase = 210 * (s.mesh.X[i].x() + s.mesh.X[i].z());
      const Vec3 u = 6e-4 * Vec3(std::sin(phase), 2 * std::cos(phase), std::sin(2 * phase));
      for (std::size_t k = 0; k < 3; ++k) s.state.u[3 * i + k] = u[static_cast<Eigen::Index>(k)];
    }
    s.boxes = {};
    begin_positions(s);
    EXPECT_EQ(largest_way(gather_state(s).x, s.boxes), 0);
    cut_at_once(s);
    ASSERT_EQ(s.n_pieces, 2);
    ASSERT_FALSE(s.boxes.is_empty());
    EXPECT_EQ(largest_way(gather_state(s).x, s.boxes), 0) << elements;
  }
}

void step_once(Simulation& s, double dt) {
  find_force(s.model, s.neighbours, s.state, s.scratch);
  integrate(s.model, s.scratch, {}, dt, s.state);
}

// Velocities are of half a step before the positions: who forgets how long that step was takes the
// next one's change of velocity over half of its time.
TEST(ApplyCut, that_changes_nothing_leaves_the_motion_to_go_on) {
  const auto plain = built(short_block("hex8", "")), edited = built(short_block("hex8", ""));
  for (Started* started : {plain.get(), edited.get()}) {
    set_in_motion(*started->s);
    for (int k = 0; k < 5; ++k) step_once(*started->s, 1e-4);
  }
  Simulation& s = *edited->s;
  MeshEdit edit;  // node 0 moves to where it is
  edit.moves = {{.node = 0, .X = s.mesh.X[0], .host = 0, .weight = {}}};
  const std::span<const std::int32_t> host = s.mesh.corners(0);
  edit.moves[0].weight[std::size_t(std::find(host.begin(), host.end(), 0) - host.begin())] = 1;
  GlobalState global = gather_state(s);
  CutRecord record;
  apply_cut(s, edit, global, record);
  for (Started* started : {plain.get(), edited.get()}) step_once(*started->s, 1e-4);
  // Of 2 m/s; momenta are restored: rounding.
  EXPECT_LE(largest_difference(s.state.v, plain->s->state.v), 1e-13 * 2);
  EXPECT_EQ(s.state.time, plain->s->state.time);
}

// Viscous numbers of each element over its volume, the mean of its points.
std::vector<std::vector<double>> history_per_volume(const Simulation& s) {
  const std::size_t width = history_of_point(1);
  std::vector<std::vector<double>> value;
  const std::vector<double> copy =
      copy_history(s.model, s.part, s.state);  // element, count of points, of hourglass, numbers
  for (std::size_t at = 0; at < copy.size(); at += 3 + std::size_t(copy[at + 1] + copy[at + 2])) {
    const auto e = static_cast<std::int32_t>(copy[at]);
    value.emplace_back(width, 0.0);
    for (std::size_t k = 0; k < std::size_t(copy[at + 1]); ++k)
      value.back()[k % width] +=
          copy[at + 3 + k] / element_volume(s.mesh, e, s.mesh.X) / (copy[at + 1] / double(width));
  }
  return value;
}

TEST(ApplyCut, keeps_the_viscous_stress_of_converted_hexahedra) {
  for (const char* hexahedron : {"one-point", "full"}) {
    const auto started = built(
        short_block("hex8", "prony = [ { share = 0.4, time = 0.5 } ]\n[solver]\nhexahedron = \"" +
                                std::string(hexahedron) + "\"\n"));
    Simulation& s = *started->s;
    for (std::size_t i = 0; i < s.mass.size(); ++i) {  // one stretch everywhere
      s.state.u[3 * i] = 0.1 * s.mesh.X[i].x();
      s.state.u[3 * i + 2] = 0.05 * s.mesh.X[i].x();
    }
    compute_force(s.model, s.state, s.scratch);
    const auto before = history_per_volume(s);
    ASSERT_GT(largest(before[0]), 1);  // [Pa]
    EXPECT_GT(cut_at_once(s).figures.n_converted, 0);
    const auto after = history_per_volume(s);
    EXPECT_GT(after.size(), before.size());
    for (const auto& element : after)  // rounding
      EXPECT_LE(largest_difference(element, before[0]), 1e-12 * largest(before[0])) << hexahedron;
  }
}

TEST(ApplyCut, keeps_the_viscous_stress_of_split_tetrahedra_and_all_momenta) {
  const auto started = built(plate_of("tet4-five", viscous));
  Simulation& s = *started->s;
  for (std::size_t i = 0; i < s.mass.size(); ++i) {  // one stretch everywhere
    s.state.u[3 * i] = 0.02 * s.mesh.X[i].x();
    s.state.u[3 * i + 2] = 0.01 * s.mesh.X[i].x();
  }
  compute_force(s.model, s.state, s.scratch);
  const auto before = history_per_volume(s);
  ASSERT_GT(largest(before[0]), 1);  // [Pa]
  set_in_motion(s);
  const MassAndMomenta motion = momenta_of(s);
  EXPECT_GT(split_plate(s).n_inserted, 300);
  const auto after = history_per_volume(s);
  EXPECT_GT(after.size(), 2 * before.size());
  for (const auto& element : after)  // rounding
    EXPECT_LE(largest_difference(element, before[0]), 1e-12 * largest(before[0]));
  const MassAndMomenta now = momenta_of(s);
  EXPECT_NEAR(now.mass, motion.mass, 1e-13 * motion.mass);
  EXPECT_LT((now.momentum - motion.momentum).norm(), 1e-12 * motion.mass * 2);
  EXPECT_LT((now.angular - motion.angular).norm(), 1e-12 * motion.mass * 2 * 0.03);
}

}  // namespace
}  // namespace trocar
