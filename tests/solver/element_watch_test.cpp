// The look at elements that leaves out what cannot matter, against the one at all of them.
#include "solver/element_watch.h"

#include <gtest/gtest.h>

#include "solver/tangent_excess.h"
#include "solver_stiffness.h"

using namespace trocar;

namespace {

Body irregular_cube(Formulation formulation, MaterialModel model, Precision precision) {
  SolverOptions options = with(formulation);
  options.precision = precision;
  const ElementType shape = shape_of(formulation);
  Mesh mesh =
      shape == ElementType::tri3
          ? make_rectangle(.02, .02, 6, 6)
          : make_box(Vec3(0, 0, 0), Vec3(.02, .02, .02), {4, 4, 4},
                     shape == ElementType::hex8 ? BoxElements::hex8 : BoxElements::tet4_kuhn);
  jitter(mesh, .1, 5);
  return make_body(mesh, {.materials = {material_of(model, 1000, 9000)}, .solver = options});
}

// Stretches one end, so that growth differs from element to element.
void deform(Body& body, double strain, std::uint64_t seed) {
  displace(body, [&](const Vec3& X) {
    return Vec3(strain * X.x() * X.x() / .02, -.4 * strain * X.x() * X.y() / .02, 0);
  });
  shake(body.state.u, 1e-4, seed);
  if (body.mesh.dimension() == 2)
    for (std::size_t k = 2; k < body.state.u.size(); k += 3) body.state.u[k] = 0;
}

// All that a look finds, from all elements.
LeastOfElements by_all(const Body& body, std::span<const double> earlier) {
  std::vector<double> growth(body.part.element_global.size());
  const Watch w = watch(body.model, body.part, body.state, growth);
  LeastOfElements least{.step = {w.stable_step, w.stable_element},
                        .J = {w.least_J, w.least_J_element}};
  for (std::size_t k = 0; k < growth.size(); ++k)
    least.growth = std::max(least.growth, growth[k] / earlier[k]);
  return least;
}

void expect_same_least(const LeastOfElements& a, const LeastOfElements& b) {
  EXPECT_EQ(a.step.value, b.step.value);
  EXPECT_EQ(a.step.number, b.step.number);
  EXPECT_EQ(a.J.value, b.J.value);
  EXPECT_EQ(a.J.number, b.J.number);
  EXPECT_EQ(a.growth, b.growth);
}

TEST(ElementWatch, that_leaves_elements_out_finds_what_a_look_at_all_finds) {
  for (const Formulation formulation : all_formulations())
    for (const MaterialModel model : all_models())
      for (const Precision precision : {Precision::in_double, Precision::in_single}) {
        if (!is_possible(formulation, model)) continue;
        Body body = irregular_cube(formulation, model, precision);
        std::vector<double> earlier(body.part.element_global.size());
        deform(body, .1, 1);
        watch(body.model, body.part, body.state, earlier);
        for (const double strain : {-.3, -.05, 0., .02, .1, .2, .4}) {
          deform(body, strain, 2);
          for (const std::int32_t begin_with : {-1, 0, 40, 1000}) {
            ElementWatch elements(body.part, {.earlier = earlier});
            if (begin_with >= 0) elements.begin_with(body.model, body.state, begin_with);
            watch_elements(body.model, body.state, elements);
            expect_same_least(elements.found(), by_all(body, earlier));
          }
        }
      }
}

TEST(ElementWatch, sees_inverted_and_broken_elements_among_sound_ones) {
  Body body = irregular_cube(Formulation::tet4, MaterialModel::neo_hookean, Precision::in_double);
  const std::vector<double> earlier(body.part.element_global.size(), 1.0);
  for (const double far : {.05, 1e200, std::numeric_limits<double>::quiet_NaN()}) {
    deform(body, .2, 3);
    body.state.u[3 * 40] = far;
    ElementWatch elements(body.part, {.earlier = earlier});
    elements.begin_with(body.model, body.state, 0);
    watch_elements(body.model, body.state, elements);
    const Watch w = watch(body.model, body.part, body.state);
    EXPECT_EQ(elements.result().stable_step, w.stable_step);
    EXPECT_EQ(elements.result().least_J, w.least_J);
    EXPECT_EQ(elements.result().least_J_element, w.least_J_element);
    EXPECT_LT(w.least_J, 0);
  }
}

TEST(ElementWatch, of_forces_on_any_threads_is_that_of_elements_alone) {
  Body body =
      irregular_cube(Formulation::hex8_one_point, MaterialModel::neo_hookean, Precision::in_double);
  deform(body, .2, 4);
  const std::vector<double> earlier(body.part.element_global.size(), 1.0);
  const LeastOfElements all = by_all(body, earlier);
  const std::vector<double> force_alone = force(body);
  for (const int n_threads : {1, 2, 3}) {
    set_thread_count(n_threads);
    ElementWatch elements(body.part, {.earlier = earlier});
    Neighbours none;
    find_force(body.model, none, body.state, body.scratch, &elements);
    expect_same_least(elements.found(), all);
    EXPECT_EQ(body.scratch.force, force_alone);
  }
  set_thread_count(1);
}

// y of symmetric_eigenvalues.h is cos(acos(c) / 3).
TEST(TangentExcess, bounds_the_roots_of_the_stretches_from_both_sides) {
  for (int k = -1000; k <= 1000; ++k) {
    const double c = k / 1000., y = std::cos(std::acos(c) / 3);
    EXPECT_GE(root_at_most(c), y) << c;
    EXPECT_LT(root_at_most(c), y + .065) << c;
    EXPECT_LE(.75 + .25 * c, y + 1e-15) << c;
  }
}

// Otherwise nothing would be spared.
TEST(TangentExcess, exceeds_the_bound_of_moderate_strains_by_few_per_cent) {
  Noise noise(7);
  for (int k = 0; k < 300; ++k) {
    Tensor<double> H;
    for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = .05 * noise();
    const double values[] = {9000, 1000};
    // Values of a block's first lane.
    std::array<double, 2 * block_lanes<double>> block{};
    block[0] = values[0];
    block[block_lanes<double>] = values[1];
    const BlockValues<double> value{block.data()};
    const double bound = MaterialNeoHookean::stiffening(H, value);
    EXPECT_GT(excess_of_I1bar(H, values[0], values[1], bound), 0);
    EXPECT_EQ(excess_of_I1bar(H, values[0], values[1], 1.05 * bound), 0) << bound;
  }
}

}  // namespace
