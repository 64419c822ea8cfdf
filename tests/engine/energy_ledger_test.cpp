// The balance of energies with relaxation: against its closed form, and that it closes.
#include "engine/energy_ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/checkpoint.h"
#include "engine_started.h"
#include "larger_or_nan.h"
#include "scene_parts.h"

namespace trocar {
namespace {

// Work of the relaxing part of the stress in simple shear by x(t) / 0.01 of 1e-6 m^3, linear with
// mu = 1 kPa: stress - mu gamma = mu (h - g gamma), h' = g gamma' - h / tau.
double viscous_work(const DisplacementPath& path, double until, double g, double tau) {
  constexpr double dt = 1e-6;
  double h = 0, gamma = 0, work = 0;
  for (double t = dt; t < until + dt / 2; t += dt) {
    const double next = path.at(t).x() / 0.01, decay = std::exp(-dt / tau);
    const double h_next = decay * h + g * (1 - decay) * tau / dt * (next - gamma);
    work -= 1e-3 * ((h + h_next) / 2 - g * (gamma + next) / 2) * (next - gamma);
    h = h_next;
    gamma = next;
  }
  return work;
}

// A cube of 1 cm, sheared by its upper side.
std::string shear_text(const std::string& elements) {
  return R"(
[time]
duration = 1
frame_rate = 100
[tissue.shape]
kind = "box"
high = [0.01, 0.01, 0.01]
cells = [1, 1, 1]
elements = ")" +
         elements + R"("
[tissue.material]
model = "linear"
young_modulus = 2500
poisson_ratio = 0.25
prony = [{ share = 0.4, time = 0.04 }]
[solver]
step_factor = 0.05
[[support]]
region = "z-"
[[support]]
region = "z+"
path = [{ time = 0.00, displacement = [0.000, 0, 0] }, { time = 0.05, displacement = [0.001, 0, 0] },
        { time = 0.10, displacement = [0.001, 0, 0] }, { time = 0.15, displacement = [0.000, 0, 0] }]
)" + metrics_table;
}

TEST(EnergyLedger, kinetic_energy_is_that_of_the_lumped_masses) {
  const auto started = built(shear_text("hex8"));
  Simulation& s = *started->s;
  for (std::size_t k = 0; k < s.state.v.size(); k += 3) s.state.v[k] = 2;
  std::vector<double> kinetic, gravity;
  add_nodal_energies(s, kinetic, gravity);
  const double mass = s.materials[0].density * 1e-6;  // of 1 cm^3
  EXPECT_NEAR(std::accumulate(kinetic.begin(), kinetic.end(), 0.0), 0.5 * mass * 4, 1e-15);
}

TEST(EnergyLedger, viscous_work_of_simple_shear_is_the_closed_form) {
  const DisplacementPath path({{.time = 0, .displacement = Vec3::Zero()},
                               {.time = 0.05, .displacement = Vec3(1e-3, 0, 0)},
                               {.time = 0.1, .displacement = Vec3(1e-3, 0, 0)},
                               {.time = 0.15, .displacement = Vec3::Zero()}});
  for (const std::string elements : {"hex8", "tet4-five"}) {
    const auto started = built(shear_text(elements));
    for (int frame = 0; frame < 16; ++frame) run_frame(*started->s, started->outputs);
    const double stored = 0.5 * 1e-3 * 0.1 * 0.1;  // where most
    for (const FrameRow& row : started->s->log.rows)
      EXPECT_NEAR(row.works.viscous, viscous_work(path, row.time, 0.4, 0.04), 1e-3 * stored)
          << elements << " " << row.time;
    const EnergyWorks& works = started->s->log.rows.back().works;
    EXPECT_LT(works.viscous, -0.2 * stored);
    EXPECT_NEAR(works.holds, -works.viscous, 1e-3 * stored);
  }
}

struct FallingBody {
  std::string shape, material, solver;
};

const std::string box =
    "[tissue.shape]\nkind = \"box\"\nhigh = [0.02, 0.02, 0.03]\n"
    "cells = [3, 3, 4]\nelements = ";
const std::string sheet =
    "[tissue.shape]\nkind = \"triangular-rectangle\"\n"
    "high = [0.02, 0.03, 0]\ncells = [5, 7, 1]\n";

// Largest error of a body that falls into its supports, over the largest energy.
double error_of_fall(const FallingBody& kind, double step_factor) {
  const auto started =
      built("[time]\nduration = 1\nframe_rate = 100\n" + kind.shape +
                "[tissue.material]\nyoung_modulus = 4000\npoisson_ratio = 0.4\n" + kind.material +
                "prony = [ { share = 0.3, time = 0.02 }, { share = 0.2, time = 0.2 } ]\n"
                "[solver]\ngravity = [0, -9.81, 0]\n" +
                kind.solver + "[[support]]\nregion = \"y+\"\n" + metrics_table,
            {"solver.step_factor=" + std::to_string(step_factor)});
  double error = 0, most = 0;
  for (int frame = 0; frame < 30; ++frame) {
    run_frame(*started->s, started->outputs);
    const FrameRow& row = started->s->log.rows.back();
    error = larger_or_nan(error, std::abs(row.energy_error));
    most = std::max({most, row.energy.kinetic, row.energy.strain});
  }
  EXPECT_GT(std::abs(started->s->log.rows.back().works.viscous), 0.03 * most);
  return error / most;
}

// Up to the scheme's own error, which falls with the square of the step, and is rounding for linear
// tissue; in single precision not
// below its rounding.
TEST(EnergyLedger, closes_with_viscosity) {
  constexpr double rounding = 1e-14;
  for (const FallingBody& kind :
       {FallingBody{box + "\"hex8\"\n", "", ""},
        FallingBody{box + "\"hex8\"\n", "", "hexahedron = \"full\"\n"},
        FallingBody{box + "\"tet4-kuhn\"\n", "model = \"linear\"\n", ""},
        FallingBody{box + "\"tet4-kuhn\"\n", "", "tetrahedron = \"nodal-pressure\"\n"},
        FallingBody{sheet, "", ""}, FallingBody{sheet, "", "triangle = \"plane-stress\"\n"}}) {
    const double error = error_of_fall(kind, 0.8), smaller = error_of_fall(kind, 0.2);
    std::printf("%.2g of the energy, with a quarter of the step %.2g\n", error, smaller);
    EXPECT_LT(error, 5e-4) << kind.shape << kind.solver;
    EXPECT_LT(smaller, std::max(error / 8, rounding)) << kind.shape << kind.solver;
  }
  EXPECT_LT(error_of_fall({box + "\"hex8\"\n", "", "precision = \"single\"\n"}, 0.2), 1e-3);
}

// A bar of one layer of cells, bent by its end and then held until nine tenths of its shear modulus
// have relaxed: most of its energy is that of hourglass modes.
double bent_bar_error(const std::string& hexahedron, double step_factor) {
  const auto started = built(
      "[time]\nduration = 1\nframe_rate = 100\n[tissue.shape]\nkind = \"box\"\n"
      "elements = \"hex8\"\nhigh = [0.06, 0.01, 0.01]\ncells = [8, 2, 1]\n"
      "[tissue.material]\nyoung_modulus = 30000\npoisson_ratio = 0.3\n"
      "prony = [ { share = 0.9, time = 0.03 } ]\n[solver]\nhexahedron = \"" +
          hexahedron + "\"\n[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n" +
          "path = [{ time = 0, displacement = [0, 0, 0] },"
          " { time = 0.1, displacement = [0, 0, 0.005] }]\n" +
          metrics_table,
      {"solver.step_factor=" + std::to_string(step_factor)});
  double error = 0;
  for (int frame = 0; frame < 30; ++frame) {
    run_frame(*started->s, started->outputs);
    error = larger_or_nan(error, std::abs(started->s->log.rows.back().energy_error));
  }
  const FrameRow& row = started->s->log.rows.back();
  EXPECT_GT(row.energy.hourglass, 0.3 * row.energy.strain);
  EXPECT_GT(std::abs(row.works.viscous), 0.04 * row.works.holds);  // missing without it
  return error / row.works.holds;
}

TEST(EnergyLedger, closes_with_relaxing_hourglass_forces) {
  for (const std::string hexahedron : {"one-point", "enhanced"}) {
    const double error = bent_bar_error(hexahedron, 0.8), smaller = bent_bar_error(hexahedron, 0.2);
    std::printf("%s: %.2g of the work, with a quarter of the step %.2g\n", hexahedron.c_str(),
                error, smaller);
    EXPECT_LT(error, 1e-3);
    EXPECT_LT(smaller, error / 8);
  }
}

// The first step is a half one: free fall's energy would be short by m (g dt)^2 / 8 from then on.
TEST(EnergyLedger, closes_from_the_first_step_on) {
  for (const std::string support : {"", "[[support]]\nregion = \"y+\"\n"})
    for (const std::string scaled : {"", "mass_scaling_step = \"0.6 ms\"\n"}) {
      const auto started =
          built("[time]\nduration = 1\nframe_rate = 1000\n" + box + "\"hex8\"\n" +
                "[tissue.material]\nyoung_modulus = 4000\npoisson_ratio = 0.4\n[solver]\n" +
                "gravity = [0, -9.81, 0]\n" + scaled + support + metrics_table);
      double error = 0, most = 0;
      for (int frame = 0; frame < 5; ++frame) {
        run_frame(*started->s, started->outputs);
        const FrameRow& row = started->s->log.rows.back();
        error = larger_or_nan(error, std::abs(row.energy_error));
        most = std::max(most, row.energy.kinetic);
      }
      std::printf("%.2g of the energy\n", error / most);
      EXPECT_LT(error, 1e-4 * most) << support << scaled;
    }
}

// Metrics that are asked for when a run goes on from a checkpoint.
TEST(EnergyLedger, closes_where_it_is_opened_in_motion) {
  for (const std::string more :
       {"[solver]\n", "[solver]\ntetrahedron = \"nodal-pressure\"\n",
        "prony = [ { share = 0.3, time = 0.02 }, { share = 0.2, time = 0.2 } ]\n[solver]\n"}) {
    const std::string text =
        "[time]\nduration = 1\nframe_rate = 100\n" + box + "\"tet4-kuhn\"\n" +
        "[tissue.material]\nyoung_modulus = 4000\npoisson_ratio = 0.4\n" + more +
        "step_factor = 0.2\ngravity = [0, -9.81, 0]\n[[support]]\nregion = \"y+\"\n";
    const auto first = built(text), next = built(text + metrics_table);
    while (first->s->frame < 6) run_frame(*first->s, first->outputs);
    restore_checkpoint(take_checkpoint(*first->s), *next->s);
    double error = 0, most = 0;
    while (next->s->frame < 30) {
      run_frame(*next->s, next->outputs);
      const FrameRow& row = next->s->log.rows.back();
      error = larger_or_nan(error, std::abs(row.energy_error));
      most = std::max({most, row.energy.kinetic, row.energy.strain});
    }
    std::printf("%.2g of the energy\n", error / most);
    EXPECT_LT(error, 3e-5 * most) << more;
    EXPECT_EQ(next->s->energy->memory.first_frame, 6);
  }
}

TEST(EnergyLedger, tells_when_and_how_much_the_balance_misses) {
  std::vector<FrameRow> rows(3);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].time = 0.1 * static_cast<double>(k + 1);
    rows[k].energy.strain = 2.0 * static_cast<double>(k + 1);
    rows[k].works.contact = -8;
  }
  rows[0].energy_error = 0.1;
  rows[1].energy_error = -0.9;
  rows[2].energy_error = -1.2;
  const auto started = built("[time]\nduration = 1\n" + sheet + "[[support]]\nregion = \"x-\"\n");
  Simulation& s = *started->s;
  open_energy_ledger(s);
  s.log.rows = rows;
  const BalanceError error = balance_error(s);
  EXPECT_EQ(error.largest, 1.2);
  EXPECT_DOUBLE_EQ(error.share, 1.2 / 8);
  EXPECT_DOUBLE_EQ(error.time, 0.2);

  note_balance(s);
  ASSERT_EQ(s.log.events.size(), 1U);
  EXPECT_NE(s.log.events[0].find("15 % of what was turned over"), std::string::npos);
  EXPECT_NE(s.log.events[0].find("since 0.2 s"), std::string::npos);
  s.log.rows.pop_back();  // 0.9 of 8 J
  s.log.rows[1].energy_error = 0.3;
  note_balance(s);
  EXPECT_EQ(s.log.events.size(), 1U);
}

// A blade leaves a light corner of a pulled sheet, which springs back. With 0.85 of the stable step
// a mode of four steps fed on it, and 253 % of the energy turned over came out of nothing.
TEST(EnergyLedger, adds_up_where_a_cut_sheet_in_plane_stress_springs_back) {
  for (const std::string modulus : {"4.5 kPa", "5.5 kPa", "6 kPa"}) {
    const auto started = built(R"(
[time]
duration = 0.6
frame_rate = 50
[tissue]
thickness = "2 mm"
[tissue.shape]
kind = "triangular-rectangle"
high = ["60 mm", "40 mm", 0]
cells = [19, 13, 1]
[tissue.material]
young_modulus = ")" + modulus + R"("
poisson_ratio = 0.4
density = 1000
[solver]
triangle = "plane-stress"
mass_damping = 60
gravity = [0, -9.81, 0]
[[support]]
region = "y-"
[[region]]
name = "top"
low = [-1, "33 mm", -1]
high = [1, 1, 1]
[[load]]
region = "top"
force = [0.004, 0.006, 0]
path = [{ time = 0, factor = 0 }, { time = 0.1, factor = 1 }]
[[instrument]]
kind = "scalpel"
path = [
  { time = 0, position = ["-8 mm", "22 mm", "-5 mm"], forward = [1, 0, 0] },
  { time = 0.3, position = ["38 mm", "21 mm", "-5 mm"], forward = [1, 0, 0] },
  { time = 0.6, position = ["40 mm", "60 mm", "-5 mm"], forward = [0, 1, 0] },
]
[[instrument]]
kind = "grasper"
grip_radius = "7 mm"
path = [
  { time = 0, position = ["15 mm", "60 mm", 0], direction = [0, -1, 0], forward = [1, 0, 0] },
  { time = 0.1, position = ["15 mm", "37 mm", 0], direction = [0, -1, 0], forward = [1, 0, 0] },
  { time = 0.31, position = ["15 mm", "37 mm", 0], direction = [0, -1, 0], forward = [1, 0, 0], action = "close" },
  { time = 0.8, position = ["15 mm", "41 mm", 0], direction = [0, -1, 0], forward = [1, 0, 0] },
]
)");
    Simulation& s = *started->s;
    open_energy_ledger(s);
    while (s.frame < s.scene.time.n_frames()) run_frame(s, started->outputs);
    EXPECT_EQ(s.n_pieces, 2) << modulus;
    EXPECT_LT(balance_error(s).share, 0.02) << modulus;
  }
}

// In single precision the strain of a body at rest is rounding, which the kinetic energy is next
// to.
TEST(EnergyLedger, takes_rounding_at_rest_for_no_error) {
  const auto started = built(
      "[time]\nduration = 0.2\n[tissue.shape]\nkind = \"box\"\nhigh = [0.04, 0.04, 0.04]\n"
      "cells = [4, 4, 4]\n[tissue.material]\nmodel = \"transversely-isotropic\"\n"
      "eta = 2000\nfibre = [1, 0.3, 0]\n[solver]\nprecision = \"single\"\n[[support]]\nregion = "
      "\"z-\"\n");
  Simulation& s = *started->s;
  open_energy_ledger(s);
  while (s.frame < 6) run_frame(s, started->outputs);
  note_balance(s);
  EXPECT_EQ(balance_error(s).share, 0);
  EXPECT_TRUE(s.log.events.empty());
}

// Strains of a free fall are rounding, and so is what of them is hourglass energy.
TEST(EnergyLedger, says_nothing_of_hourglass_energy_in_free_fall) {
  const auto started = built(
      "[time]\nduration = 0.5\n[tissue.shape]\nkind = \"box\"\ncells = [3, 4, 5]\n[solver]\n"
      "gravity = [0.3, 1.1, -9.7]\n" +
      metrics_table);
  Simulation& s = *started->s;
  while (s.frame < 14) run_frame(s, started->outputs);
  EXPECT_GT(s.log.rows.back().energy.kinetic, 1);
  EXPECT_EQ(s.log.events, std::vector<std::string>());
  EXPECT_EQ(s.energy->memory.largest_hourglass_share, 0);
}

}  // namespace
}  // namespace trocar
