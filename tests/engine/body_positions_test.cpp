#include "engine/body_positions.h"

#include <gtest/gtest.h>

#include <random>

#include "engine_started.h"
#include "mesh/element_boxes.h"

namespace trocar {
namespace {

Box random_box(std::mt19937& random) {
  std::uniform_real_distribution<double> place(0, 0.04);
  const Vec3 middle(place(random), place(random), place(random)), half = Vec3::Constant(3e-3);
  return {middle - half, middle + half};
}

// A resumed run and ranks that were parted anew have new boxes.
TEST(BodyPositions, find_the_same_elements_with_boxes_of_any_age) {
  const auto started = built(
      "[time]\nduration = 1\n[tissue.shape]\nkind = \"box\"\nelements = \"tet4-kuhn\"\n"
      "high = [0.04, 0.04, 0.04]\ncells = [8, 8, 8]\n");
  Simulation& s = *started->s;
  s.boxes = make_element_boxes(s.mesh, s.mesh.X);
  for (std::size_t i = 0; i < s.part.node_global.size(); ++i) {
    const Vec3& X = s.mesh.X[s.part.node_global[i]];
    s.state.u[3 * i] = 0.05 * X.z() * X.y() / 0.04;
  }
  const CutGroup alone(s, {0});
  std::mt19937 random(1);
  int n_other = 0;  // that the boxes alone would find
  for (int k = 0; k < 50; ++k) {
    const Box box = random_box(random);
    const ElementBoxes older = s.boxes;
    double way = begin_positions(s);
    ASSERT_GT(way, 0);
    const std::vector<std::int32_t> by_older = elements_near(box, way, s.boxes),
                                    found = BodyPositions(s, alone, way).elements_near(box);
    s.boxes = {};
    way = begin_positions(s);
    EXPECT_EQ(BodyPositions(s, alone, way).elements_near(box), found);
    n_other += elements_near(box, way, s.boxes) != by_older ? 1 : 0;
    s.boxes = older;
  }
  EXPECT_GT(n_other, 25);
}

}  // namespace
}  // namespace trocar
