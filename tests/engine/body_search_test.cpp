#include "engine/body_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/frame_watch.h"
#include "engine/part_search.h"
#include "engine_started.h"

namespace trocar {
namespace {

// Stretches the layers of the block above the middle by `strain` along z.
void stretch_upper_half(Simulation& s, double strain) {
  double low = 1e300, high = -1e300;
  for (const Vec3& X : s.mesh.X) low = std::min(low, X.z()), high = std::max(high, X.z());
  const double middle = (low + high) / 2;
  for (std::size_t i = 0; i < s.mesh.X.size(); ++i)
    s.state.u[3 * i + 2] = strain * std::max(0.0, s.mesh.X[i].z() - middle);
}

// One that starts where the fastest mode was before, in the half at rest, would not see that one of
// the other half has become faster.
TEST(BodySearch, never_gives_a_longer_step_than_a_search_of_the_body_as_it_is) {
  for (const std::string elements : {"hex8", "tet4-kuhn"}) {
    const auto run = block_of(elements);
    Simulation& s = *run->s;
    const double at_rest = s.watch.stable_step;
    int n_searches = 0;
    for (int k = 1; k <= 40; ++k) {
      stretch_upper_half(s, 0.01 * k);
      s.state.step += 10;
      watch_state(s);
      n_searches += s.look.at_step == s.state.step ? 1 : 0;
      const double whole = search_step(s, search_amplitude(s.model, s.edge_length), Communicator());
      EXPECT_LT(s.watch.stable_step / whole, frequency_margin) << elements << ' ' << k;
      EXPECT_GT(s.watch.stable_step / whole, 1 / std::sqrt(most_growth) / frequency_margin);
    }
    EXPECT_LT(s.watch.stable_step, 0.75 * at_rest);
    EXPECT_GT(n_searches, 2);
    EXPECT_LT(n_searches, 30);
  }
}

// Stretches some cells in the middle of the block by `strain` along z.
void stretch_middle(Simulation& s, double strain) {
  Box box;
  for (const Vec3& X : s.mesh.X) box.add(X);
  const Vec3 middle = box.middle();
  for (std::size_t i = 0; i < s.mesh.X.size(); ++i) {
    const Vec3 r = s.mesh.X[i] - middle;
    const double far = r.squaredNorm() / (4 * s.edge_length * s.edge_length);
    s.state.u[3 * i + 2] = strain * std::exp(-far) * r.z();
  }
  s.scratch.has_force = false;
}

TEST(BodySearch, searches_the_part_alone_that_has_stiffened_and_gives_no_longer_step) {
  for (const auto& [elements, n] : {std::pair("hex8", 24), std::pair("tet4-kuhn", 30)}) {
    const auto run = block_of(elements, n);
    Simulation& s = *run->s;
    const std::int64_t of_body = s.log.searches.n_of_body;
    double least = 1;
    for (int k = 1; k <= 20; ++k) {
      stretch_middle(s, 0.05 * (k <= 15 ? k : 30 - k));
      s.state.step += 10;
      watch_state(s);
      const double whole = search_step(s, search_amplitude(s.model, s.edge_length), Communicator());
      EXPECT_LT(s.watch.stable_step / whole, frequency_margin) << elements << ' ' << k;
      const double least_share = k <= 15 ? 1 / std::sqrt(most_growth_of_part) : 0.88;  // it softens
      EXPECT_GT(s.watch.stable_step / whole, least_share / frequency_margin)
          << elements << ' ' << k;
      least = std::min(least, whole / s.look.step);
    }
    EXPECT_LT(least, 0.99) << "the body has become no faster";
    EXPECT_GT(s.log.searches.n_of_parts, 6) << elements;
    EXPECT_EQ(s.log.searches.n_of_body, of_body) << elements;
  }
}

// A part is not asked whether the rest has softened.
TEST(BodySearch, searches_the_body_in_place_of_a_part_long_after) {
  const auto run = block_of("hex8", 16);
  Simulation& s = *run->s;
  s.state.step = s.look.at_step + most_steps_of_parts + 1;
  stretch_middle(s, 0.3);
  watch_state(s);
  EXPECT_EQ(s.log.searches.n_of_parts, 0);
  EXPECT_EQ(s.look.at_step, s.state.step);
}

TEST(BodySearch, takes_the_growth_of_elements_for_that_of_the_body_between_two_searches) {
  const auto run = block_of("tet4-kuhn");
  Simulation& s = *run->s;
  const double searched = s.look.step;
  stretch_upper_half(s, 0.01);
  s.state.step = 10;
  watch_state(s);
  EXPECT_EQ(s.look.at_step, 0);
  std::vector<double> stiffening(s.part.element_global.size());
  watch(s.model, s.part, s.state, stiffening);  // of a body that was at rest, where all are 1
  const double growth = std::ranges::max(stiffening);
  EXPECT_GT(growth, 1.005);
  EXPECT_EQ(s.watch.stable_step, searched / std::sqrt(growth));
  // Long after, what may have softened is looked for.
  stretch_upper_half(s, 0.005);
  s.state.step = most_steps_of_search;
  watch_state(s);
  EXPECT_EQ(s.look.at_step, most_steps_of_search);
  EXPECT_EQ(s.watch.stable_step,
            search_step(s, search_amplitude(s.model, s.edge_length), Communicator()));
}

}  // namespace
}  // namespace trocar
