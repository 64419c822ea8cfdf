// What supports bear: weight, tension, and all that moves the body.
#include "engine/support_forces.h"

#include <gtest/gtest.h>

#include <bit>
#include <numeric>

#include "engine/equilibrium.h"
#include "engine_split.h"
#include "engine_started.h"

namespace trocar {
namespace {

// 2 x 2 x 5 cm, linear with E = 6 kPa and nu = 0.
const std::string linear_bar = R"(
[time]
duration = 1
frame_rate = 100
[tissue.shape]
kind = "box"
high = [0.02, 0.02, 0.05]
cells = [2, 2, 5]
[tissue.material]
model = "linear"
young_modulus = 6000
poisson_ratio = 0
density = 1000
[[output]]
kind = "metrics"
file = "m.csv"
)";
const std::string down = "[solver]\ngravity = [0, 0, -9.81]\n";

const std::vector<Vec3>& forces_of(const Started& started) {
  return started.s->log.rows.back().support_forces;
}

TEST(SupportForces, bear_the_weight_of_a_body_at_rest) {
  for (const std::string support :
       {"[[support]]\nregion = \"z-\"\n",
        "[[support]]\nregion = \"z-\"\npath = [{ time = 0, displacement = [0, 0, 0] }]\n"}) {
    const auto bar =
        built("[start]\nstate = \"equilibrium\"\ntolerance = 1e-9\n" + linear_bar + down + support);
    start_in_equilibrium(bar->loaded, *bar->s);
    run_frame(*bar->s, bar->outputs);
    const double weight = 1000 * 2e-5 * 9.81;
    EXPECT_LT((forces_of(*bar)[0] - Vec3(0, 0, -weight)).norm(), 1e-7 * weight) << support;
  }
}

TEST(SupportForces, of_a_stretched_bar_are_its_tension_at_both_ends) {
  const auto bar = built("[start]\nstate = \"equilibrium\"\ntolerance = 1e-9\n" + linear_bar +
                         "[[support]]\nregion = \"z-\"\n[[support]]\nregion = \"z+\"\n"
                         "path = [{ time = 0, displacement = [0, 0, 0.001] }]\n");
  start_in_equilibrium(bar->loaded, *bar->s);
  run_frame(*bar->s, bar->outputs);
  const double tension = 6000 * 4e-4 * 0.001 / 0.05;
  EXPECT_LT((forces_of(*bar)[0] - Vec3(0, 0, tension)).norm(), 1e-6 * tension);
  EXPECT_LT((forces_of(*bar)[1] + Vec3(0, 0, tension)).norm(), 1e-6 * tension);
}

Vec3 momentum_of_scaled(const Simulation& s) {
  Vec3 sum = Vec3::Zero();
  for (std::int64_t i = 0; i < s.model.n_owned; ++i)
    sum += s.model.mass[i] * Vec3::Map(&s.state.v[3 * i]);
  return sum;
}

// Supports that share edges, one of them moving and one of two components; also where masses are
// scaled.
TEST(SupportForces, and_weight_are_all_that_changes_the_momentum) {
  for (const std::string scaling : {"", "mass_scaling_step = \"4 ms\"\n"}) {
    const auto bar = built(linear_bar + down + scaling + R"(
[[support]]
region = "z-"
[[support]]
region = "x-"
fix = "xz"
[[support]]
region = "y+"
path = [{ time = 0, displacement = [0, 0, 0] }, { time = 0.5, displacement = [0.002, 0.001, 0] }]
)");
    for (int frame = 0; frame < 3; ++frame) run_frame(*bar->s, bar->outputs);
    const Vec3 before = momentum_of_scaled(*bar->s);
    const double dt = bar->s->log.rows.back().dt;
    run_frame(*bar->s, bar->outputs);
    ASSERT_EQ(bar->s->log.rows.back().dt, dt);
    Vec3 force(0, 0, -1000 * 2e-5 * 9.81);
    for (const Vec3& on_support : forces_of(*bar)) {
      EXPECT_GT(on_support.norm(), 1e-3);
      force -= on_support;
    }
    EXPECT_LT((momentum_of_scaled(*bar->s) - before - force * 0.01).norm(), 1e-12 * force.norm());
    EXPECT_EQ(bar->s->added_mass.has_value(), !scaling.empty());
  }
}

TEST(SupportForces, of_a_component_that_several_fix_go_to_the_first) {
  const auto bar = built(linear_bar +
                         "[[support]]\nregion = \"z-\"\nfix = \"x\"\n"
                         "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"z-\"\n");
  const SupportForces& forces = bar->s->energy->support_forces;
  std::vector<int> n(3);
  for (const SupportedComponent& at : forces.of_rank) ++n[at.support];
  EXPECT_EQ(n, (std::vector<int>{9, 3 * 18 - 3, 2 * 9 - 2 * 3}));
  EXPECT_EQ(support_names(bar->s->scene.supports), (std::vector<std::string>{"z-", "x-", "z-_2"}));
  const std::vector<SceneSupport> alike = {
      {.region = "a"}, {.region = "a"}, {.region = "a_2"}, {.region = "a"}};
  EXPECT_EQ(support_names(alike), (std::vector<std::string>{"a", "a_3", "a_2", "a_4"}));
}

TEST(SupportForces, have_the_nodes_that_a_cut_makes) {
  const auto bar =
      built(linear_bar + "[[support]]\nregion = \"x-\"\n", {"tissue.shape.elements='tet4-kuhn'"});
  Simulation& s = *bar->s;
  GlobalState global = gather_state(s);
  CutFigures figures;
  CutRecord record;
  const std::size_t before = s.energy->support_forces.of_rank.size();
  apply_cut(s, cut_across(s, global, figures), global, record);
  std::size_t n_fixed = 0;
  for (const FixedMask mask : s.fixed) n_fixed += mask == 7 ? 3 : 0;
  EXPECT_GT(n_fixed, before);
  EXPECT_EQ(s.energy->support_forces.of_rank.size(), n_fixed);
}

// A node on an edge is supported in what both of its ends are.
TEST(SupportForces, have_the_nodes_that_a_cut_puts_on_edges) {
  const auto plate = built(plate_of("tet4-five") + plate_in_use);
  Simulation& s = *plate->s;
  const std::vector<FixedMask> before = s.fixed;
  const MeshEdit split = split_plate(s).split;
  int n_full = 0, n_rollers = 0;
  for (std::size_t k = 0; k < split.inserted.size(); ++k) {
    const auto [a, b] = split.inserted[k].end;
    const FixedMask mask = s.fixed[before.size() + k];
    EXPECT_EQ(mask, before[a] & before[b]);
    n_full += mask == 7 ? 1 : 0;
    n_rollers += mask == 4 ? 1 : 0;
  }
  EXPECT_GT(n_full, 0);
  EXPECT_GT(n_rollers, 0);
  std::size_t n_fixed = 0;
  for (const FixedMask mask : s.fixed) n_fixed += static_cast<std::size_t>(std::popcount(mask));
  EXPECT_EQ(s.energy->support_forces.of_rank.size(), n_fixed);
}

TEST(SupportForces, and_weight_are_all_that_changes_the_momentum_of_a_split_plate) {
  const auto plate = built(plate_of("tet4-five") +
                               "[[support]]\nregion = \"x+\"\n[[support]]\nregion = \"x-\"\n"
                               "fix = \"z\"\n[[output]]\nkind = \"metrics\"\nfile = \"m.csv\"\n",
                           {"solver.mass_damping=0"});
  Simulation& s = *plate->s;
  ASSERT_GT(split_plate(s).n_inserted, 300);
  const double mass = std::accumulate(s.mass.begin(), s.mass.end(), 0.0);
  int n_compared = 0;
  for (int k = 0; k < 10; ++k) {
    const Vec3 before = momentum_of_scaled(s);
    const double dt = k > 0 ? s.log.rows.back().dt : 0;
    run_frame(s, plate->outputs);
    if (s.log.rows.back().dt != dt) continue;  // velocities are of half a step before
    ++n_compared;
    const Vec3 force = Vec3(0, 0, -0.3 * mass) - forces_of(*plate)[0] - forces_of(*plate)[1];
    EXPECT_GT(forces_of(*plate)[1].norm(), 0);
    EXPECT_LT((momentum_of_scaled(s) - before - force / 50).norm(), 1e-10 * force.norm());
  }
  EXPECT_GT(n_compared, 1);
}

}  // namespace
}  // namespace trocar
