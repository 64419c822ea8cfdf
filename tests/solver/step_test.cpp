// Forces and steps of whole bodies.
#include "solver/step.h"

#include <gtest/gtest.h>

#include "solver_stiffness.h"

using namespace trocar;

static Mesh block(BoxElements elements) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.03, .02, .02), {3, 3, 3}, elements);
  jitter(mesh, .2, 1);
  return mesh;
}

static Vec3 momentum(const Body& body) {
  Vec3 p = Vec3::Zero();
  for (std::int32_t i = 0; i < body.model.n_owned; ++i)
    p += body.model.mass[i] * Vec3::Map(&body.state.v[3 * i]);
  return p;
}

TEST(Step, a_free_body_keeps_its_momentum) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    Body body = make_body(block(elements));
    shake(body.state.u, 1e-3, 1);
    shake(body.state.v, .1, 2);
    const Vec3 before = momentum(body);
    double scale = 0;  // what rounding acts on: sum of |m v|
    for (std::int32_t i = 0; i < body.model.n_owned; ++i) scale += body.model.mass[i] * .3;
    const double dt = 0.4 * least_element_step(body);
    for (int k = 0; k < 500; ++k) step(body, dt);
    EXPECT_LT((momentum(body) - before).norm(), 500 * 1e-16 * scale);
  }
}

TEST(Step, a_falling_body_follows_the_exact_parabola_of_the_scheme) {
  const Vec3 g(1, -2, -9.81);
  Body body = make_body(block(BoxElements::tet4_kuhn), {.solver = {.gravity = g}});
  displace(body, [](const Vec3&) { return Vec3(0, 0, .1); });
  const double dt = 0.5 * least_element_step(body);
  for (int k = 0; k < 200; ++k) step(body, dt);
  // Central differences are exact for a parabola: u = u0 + g t^2 / 2.
  const double t = 200 * dt;
  EXPECT_NEAR(body.state.time, t, 1e-12 * t);
  for (std::int32_t i = 0; i < body.model.n_owned; ++i) {
    const Vec3 u = Vec3::Map(&body.state.u[3 * i]);
    EXPECT_LT((u - Vec3(0, 0, .1) - g * t * t / 2).norm(), 1e-12);
  }
}

TEST(Step, the_fall_of_a_damped_body_follows_the_recursion_with_varying_steps) {
  const double alpha = 3, g = -9.81;
  Body body = make_body(block(BoxElements::hex8),
                        {.solver = {.mass_damping = alpha, .gravity = Vec3(0, 0, g)}});
  double u = 0, v = 0, last = 0;
  for (const double dt : {1e-4, 2e-4, 1.5e-4, 1e-5, 3e-4}) {
    step(body, dt);
    const double dt_m = (last + dt) / 2;
    v = ((2 - alpha * dt_m) * v + 2 * dt_m * g) / (2 + alpha * dt_m);
    u += dt * v;
    last = dt;
    EXPECT_NEAR(body.state.u[2], u, 1e-14 * std::abs(u));
    EXPECT_NEAR(body.state.v[2], v, 1e-14 * std::abs(v));
  }
}

// m (v+ - v-) / dt + alpha m v = f with v = (v+ + v-) / 2, times v: what the kinetic energy lacks
// of the work of f is the damping's.
TEST(Step, kinetic_energy_changes_by_the_work_of_the_forces_less_what_damping_takes) {
  Body body = make_body(block(BoxElements::tet4_kuhn),
                        {.solver = {.mass_damping = 40, .gravity = Vec3(1, 2, -9.81)}});
  keep_works(body.model, body.scratch);
  shake(body.state.u, 1e-3, 5);
  shake(body.state.v, 0.1, 6);
  const auto kinetic = [&] {
    double sum = 0;
    for (std::size_t k = 0; k < body.state.v.size(); ++k)
      sum += 0.5 * body.model.mass[k / 3] * body.state.v[k] * body.state.v[k];
    return sum;
  };
  const double dt = 0.3 * least_element_step(body), start = kinetic();
  double work = 0;
  for (int n = 0; n < 20; ++n) {
    const std::vector<double> before = body.state.v, f = force(body);
    const double dt_m = (body.state.last_dt + dt) / 2;
    step(body, dt);
    for (std::size_t k = 0; k < f.size(); ++k)
      work += dt_m * f[k] * (before[k] + body.state.v[k]) / 2;
  }
  const double taken = sum(find_damping_work(body.model, body.scratch));
  EXPECT_GT(taken, 0.01 * start);
  EXPECT_NEAR(kinetic(), start + work - taken, 1e-13 * start);  // some thousand roundings
}

TEST(Step, supported_components_stay_and_the_others_move) {
  const Mesh mesh = block(BoxElements::tet4_kuhn);
  std::vector<FixedMask> fixed(mesh.X.size(), 0);
  for (std::size_t i = 0; i < fixed.size(); ++i) fixed[i] = static_cast<FixedMask>(i % 8);
  Body body = make_body(mesh, {.solver = {.gravity = Vec3(3, 4, -9.81)}, .fixed = fixed});
  shake(body.state.u, 1e-3, 1);
  const std::vector<double> before = body.state.u;
  for (int k = 0; k < 50; ++k) step(body, 0.4 * least_element_step(body));
  for (std::size_t k = 0; k < before.size(); ++k) {
    if ((fixed[k / 3] >> (k % 3) & 1) != 0)
      EXPECT_EQ(body.state.u[k], before[k]);
    else
      EXPECT_NE(body.state.u[k], before[k]);
  }
}

TEST(Step, a_prescribed_node_arrives_exactly_and_its_reaction_is_what_was_missing) {
  const double alpha = 2;
  Body body = make_body(block(BoxElements::tet4_kuhn),
                        {.solver = {.mass_damping = alpha, .gravity = Vec3(0, 0, -9.81)}});
  shake(body.state.u, 1e-3, 1);
  shake(body.state.v, .1, 2);
  step(body, 1e-4);
  const State old = body.state;
  const std::vector<double> f = force(body);
  const double dt = 2e-4, dt_m = 1.5e-4;
  std::vector<PrescribedNode> held = {{.node = 5, .u_next = Vec3(1e-3, 2e-3, -1e-3)}};
  integrate(body.model, body.scratch, held, dt, body.state);
  for (int j = 0; j < 3; ++j) {
    EXPECT_EQ(body.state.u[15 + j], held[0].u_next[j]);
    // Newton for the node, with the centred velocity in the damping.
    const double v = old.v[15 + j], v_next = (held[0].u_next[j] - old.u[15 + j]) / dt;
    const double m = body.model.mass[5];
    const double R = m * (v_next - v) / dt_m + alpha * m * (v_next + v) / 2 - f[15 + j];
    EXPECT_NEAR(held[0].reaction[j], R, 1e-12 * std::abs(R));
  }
}

TEST(Step, a_holder_that_follows_the_free_motion_needs_no_force) {
  Body free = make_body(block(BoxElements::hex8)), held = make_body(block(BoxElements::hex8));
  shake(free.state.v, .1, 2);
  held.state = free.state;
  std::vector<PrescribedNode> node = {{.node = 9}};
  for (int k = 0; k < 20; ++k) {
    step(free, 1e-4);
    node[0].u_next = Vec3::Map(&free.state.u[27]);
    compute_force(held.model, held.state, held.scratch);
    integrate(held.model, held.scratch, node, 1e-4, held.state);
    // u_next carries eps |u|, which the reaction sees as m eps |u| / dt^2.
    EXPECT_LT(node[0].reaction.norm(), held.model.mass[9] * 1e-15 * 1e-3 / 1e-8);
  }
}

TEST(Step, a_support_on_a_prescribed_node_wins_and_bears_the_force) {
  const Mesh mesh = block(BoxElements::tet4_kuhn);
  std::vector<FixedMask> fixed(mesh.X.size(), 0);
  fixed[3] = 2;
  Body body = make_body(mesh, {.fixed = fixed});
  std::vector<PrescribedNode> node = {{.node = 3, .u_next = Vec3(1e-4, 1e-4, 1e-4)}};
  compute_force(body.model, body.state, body.scratch);
  integrate(body.model, body.scratch, node, 1e-4, body.state);
  EXPECT_EQ(body.state.u[9], 1e-4);
  EXPECT_EQ(body.state.u[10], 0);
  EXPECT_EQ(node[0].reaction[1], 0);
}

static double growth(Body& body, double dt, int n_steps) {
  shake(body.state.v, 1e-9, 3);  // small enough to stay linear while it grows
  const double before = largest(body.state.v);
  for (int k = 0; k < n_steps; ++k) step(body, dt);
  return largest(body.state.v) / before;
}

TEST(Step, is_stable_just_below_the_bound_and_unstable_just_above_the_true_limit) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    Body body = make_body(block(elements));
    const double bound = least_element_step(body), limit = true_limit(body, 1e-7);
    std::printf("bound / true limit of a distorted block: %.3f\n", bound / limit);
    EXPECT_LT(bound, limit);
    // Free vibration exchanges energy between nodes of different mass, but does not grow.
    EXPECT_LT(growth(body, .95 * bound, 2000), 10);
    // At 1.05 of the limit the fastest mode grows by 1.87 a step (x + sqrt(x^2 - 1))^2.
    Body other = make_body(block(elements));
    EXPECT_GT(growth(other, 1.05 * limit, 30), 1e3);
  }
}

// Forces on a few nodes, and one that is led: all others may move at once.
static void check_waiting_nodes(const Mesh& mesh, Precision precision) {
  Body body = make_body(mesh, {.solver = {.mass_damping = 3, .precision = precision}});
  shake(body.state.u, 1e-4, 3);
  shake(body.state.v, .1, 4);
  Body at_once = body;
  std::vector<PrescribedNode> led = {{.node = 17}}, led_at_once = led;
  WaitingNodes waiting{.node = {40, 3, 17, 40, body.model.n_owned - 1}};
  mark_waiting(at_once.model, waiting);
  EXPECT_EQ(waiting.node, (std::vector<std::int32_t>{3, 17, 40, body.model.n_owned - 1}));
  const auto push = [&](const Body& of, std::span<PrescribedNode> nodes, Scratch& scratch) {
    scratch.force[3 * 3 + 1] += 1e-3 * (1 + of.state.u[3 * 3 + 1]);
    scratch.force[3 * 40] -= 2e-3;
    nodes[0].u_next = Vec3(1e-4, 2e-4, 3e-4) * static_cast<double>(of.state.step);
  };
  Neighbours none;
  for (int k = 0; k < 5; ++k) {
    const double dt = 1e-5 * (1 + k);
    find_force(body.model, none, body.state, body.scratch);
    push(body, led, body.scratch);
    integrate(body.model, body.scratch, led, dt, body.state);
    step_others(at_once.model, none, waiting, dt, at_once.state, at_once.scratch);
    push(at_once, led_at_once, at_once.scratch);
    step_waiting(at_once.model, waiting, led_at_once, dt, at_once.state, at_once.scratch);
    ASSERT_EQ(at_once.state.u, body.state.u);
    ASSERT_EQ(at_once.state.v, body.state.v);
    ASSERT_EQ(led_at_once[0].reaction, led[0].reaction);
  }
  EXPECT_EQ(at_once.state.time, body.state.time);
  EXPECT_NE(led[0].reaction, Vec3(0, 0, 0));
}

TEST(Step, nodes_that_wait_for_other_forces_leave_the_bits_as_they_are) {
  for (const Precision precision : precisions)
    for (const int n_threads : {1, 2}) {
      set_thread_count(n_threads);
      check_waiting_nodes(block(BoxElements::hex8), precision);
      check_waiting_nodes(block(BoxElements::tet4_kuhn), precision);
      check_waiting_nodes(
          make_box(Vec3(0, 0, 0), Vec3(.1, .1, .1), {20, 18, 18}, BoxElements::hex8), precision);
    }
  set_thread_count(1);
}
