// Tissue that is set in motion within a frame, at 30 frames a second: by a support that sets out,
// or by other tissue that hits it.
#include "engine/pair_look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/energy_ledger.h"
#include "engine/frame_report.h"
#include "engine_motion.h"
#include "engine_started.h"
#include "mesh/generate.h"
#include "mesh_joined.h"
#include "mesh_write.h"

namespace trocar {
namespace {

constexpr double rho = 1000;

std::unique_ptr<Started> bodies(const Mesh& mesh, const std::string& tables) {
  const TestFolder folder;
  write_mesh(mesh, folder.file("bodies.vtu"));
  return built("[time]\nduration = 10\nframe_rate = 30\n[tissue]\nmesh = \"" +
               folder.file("bodies.vtu") +
               "\"\n[tissue.material]\nyoung_modulus = 20000\npoisson_ratio = 0.3\ndensity = 1000\n"
               "[contact]\ntissue = true\nfriction = 0\n" +
               tables);
}

// Of the nodes that lie between `low` and `high` in z where nothing has moved.
struct Layer {
  double low = 0, high = 0;

  bool holds(const Simulation& s, std::size_t i) const {
    return s.mesh.X[i].z() > low - 1e-6 && s.mesh.X[i].z() < high + 1e-6;
  }
  double mean_height(const Simulation& s) const {
    double sum = 0, mass = 0;
    for (std::size_t i = 0; i < s.mass.size(); ++i) {
      if (!holds(s, i)) continue;
      sum += s.mass[i] * (s.mesh.X[i].z() + s.state.u[3 * i + 2]);
      mass += s.mass[i];
    }
    return sum / mass;
  }
};

class DrivenBlock : public testing::TestWithParam<std::tuple<BoxElements, double, double>> {};

// A block 3 mm over a plate that is free: it can only push the plate before it.
TEST_P(DrivenBlock, does_not_pass_a_plate_that_it_meets_in_the_frame_in_which_it_sets_out) {
  const auto [elements, speed, thickness] = GetParam();
  const double bottom = thickness + 0.003, top = bottom + 0.01, way = 0.03;
  const Mesh plate = make_box({-0.02, -0.02, 0}, {0.02, 0.02, thickness}, {16, 16, 1}, elements);
  const Mesh block =
      make_box({-0.0103, -0.0098, bottom}, {0.0097, 0.0102, top}, {8, 8, 4}, elements);
  const auto started =
      bodies(joined(plate, block),
             "[[region]]\nname = \"block\"\nlow = [-1, -1, " + std::to_string(bottom - 1e-4) +
                 "]\nhigh = [1, 1, 1]\n[[support]]\nregion = \"block\"\npath = [{ time = 0.1, "
                 "displacement = [0, 0, 0] }, { time = " +
                 std::to_string(0.1 + way / speed) + ", displacement = [0, 0, -0.03] }]\n");
  Simulation& s = *started->s;
  const Layer of_plate{0, thickness}, of_block{bottom, top};
  while (s.state.time < 0.1 + way / speed) run_frame(s, started->outputs);
  const double between = of_block.mean_height(s) - 0.5 * (top - bottom) - of_plate.mean_height(s);
  std::printf("%g m/s, plate of %g mm: its middle is %.2f mm below the block\n", speed,
              1e3 * thickness, 1e3 * between);
  EXPECT_GT(between, 0.4 * thickness);  // touching: half of its thickness, less what bends up
}

INSTANTIATE_TEST_SUITE_P(
    ContactOfFastTissue, DrivenBlock,
    testing::Combine(testing::Values(BoxElements::hex8, BoxElements::tet4_five),
                     testing::Values(0.5, 1.25, 3.0), testing::Values(0.002, 0.005)));

// Three plates in a row, of which one flies at 2 m/s: the second rests until it is hit, and meets
// the third within the same frame.
TEST(ContactOfFastTissue, keeps_the_order_of_plates_that_throw_each_other) {
  const auto plate = [](double low) {
    return make_box({-0.01, -0.01, low}, {0.01, 0.01, low + 0.004}, {5, 5, 2}, BoxElements::hex8);
  };
  const auto started = bodies(joined(joined(plate(0), plate(0.012)), plate(0.024)), "");
  Simulation& s = *started->s;
  const Layer last{0, 0.004}, middle{0.012, 0.016}, first{0.024, 0.028};
  for (std::size_t i = 0; i < s.mass.size(); ++i)
    if (first.holds(s, i)) s.state.v[3 * i + 2] = -2;
  const double before = momentum(s).z(), kinetic = 0.5 * rho * 0.02 * 0.02 * 0.004 * 2 * 2;
  open_energy_ledger(s);
  for (int frame = 0; frame < 3; ++frame) {
    run_frame(s, started->outputs);
    EXPECT_NEAR(momentum(s).z(), before, 1e-12 * std::abs(before));
    EXPECT_LE(s.log.rows.back().works.contact, 1e-12);
    EXPECT_LT(s.log.rows.back().energy.sum(), kinetic);
  }
  std::printf("heights %g, %g, %g mm\n", 1e3 * first.mean_height(s), 1e3 * middle.mean_height(s),
              1e3 * last.mean_height(s));
  EXPECT_GT(first.mean_height(s), middle.mean_height(s) + 0.003);
  EXPECT_GT(middle.mean_height(s), last.mean_height(s) + 0.003);
}

// Two blocks of cells of 5 mm, the upper one's lowest middle node so deep in the lower one as a
// step has found.
std::unique_ptr<Started> overlapping(double depth, Simulation*& s) {
  const auto block = [](double low) {
    return make_box({-0.01, -0.01, low}, {0.01, 0.01, low + 0.012}, {4, 4, 3}, BoxElements::hex8);
  };
  auto started = bodies(joined(block(0), block(0.012 - depth)), "");
  s = started->s.get();
  refresh_surface(*s);
  const auto node_at = [&](const Vec3& x) {
    for (std::int32_t i = s->mesh.n_nodes(); i-- > 0;)
      if ((s->mesh.X[i] - x).norm() < 1e-9) return i;
    return -1;
  };
  const double top = 0.012;
  ContactSet& set = s->contact->set;
  set = {};
  set.node = {node_at({0, 0, top - depth}), node_at({0, 0, top}), node_at({0.005, 0, top}),
              node_at({0, 0.005, top})};
  set.owned = {0};
  set.tissue = {{.place = {0, 1, 2, 3}}};
  set.found_by = {0, -1, -1, -1};
  return started;
}

TEST(SunkTissue, is_told_with_its_place_where_it_lies_in_other_tissue) {
  Simulation* s = nullptr;
  const auto n_told = [&] {
    watch_sunk_tissue(*s, 0.5);
    return s->log.events.size();
  };
  auto started = overlapping(-0.003, s);
  const double reach = s->contact_reach;
  EXPECT_EQ(n_told(), 0U);  // outside
  started = overlapping(0.9 * reach, s);
  EXPECT_EQ(n_told(), 0U);  // comes out
  started = overlapping(0.006, s);
  ASSERT_GT(0.006, reach);
  s->contact->set.found_by[0] = -1;
  EXPECT_EQ(n_told(), 0U);  // no step has found it
  s->contact->set.found_by[0] = 0;
  s->log.new_edits.resize(1);
  EXPECT_EQ(n_told(), 0U);  // pairs of a surface that is no more
  s->log.new_edits.clear();
  ASSERT_EQ(n_told(), 1U);
  EXPECT_NE(s->log.events[0].find("(0, 0, 0.006) m lies 6 mm deep"), std::string::npos)
      << s->log.events[0];
  EXPECT_EQ(s->log.events[0].find("0.500 s"), 0U);
  EXPECT_EQ(n_told(), 1U);  // once
}

}  // namespace
}  // namespace trocar
