// All instruction sets against the scalar kernels, and lanes against each other.
#include "solver/simd.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "solver_body.h"

using namespace trocar;

// Puts the choice back.
struct WithSimd {
  explicit WithSimd(const std::string& name) { select_simd(name); }
  ~WithSimd() { select_simd("auto"); }
  WithSimd(const WithSimd&) = delete;
  WithSimd& operator=(const WithSimd&) = delete;
};

static std::vector<std::string> supported() {
  std::vector<std::string> names;
  for (int i = 0; i < n_simd; ++i)
    if (is_supported(static_cast<Simd>(i))) names.emplace_back(name_of(static_cast<Simd>(i)));
  return names;
}

static Mesh mesh_for(Formulation formulation) {
  if (shape_of(formulation) == ElementType::tri3) return make_rectangle(.03, .02, 7, 6);
  const bool is_hex = shape_of(formulation) == ElementType::hex8;
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.03, .02, .02), {3, is_hex ? 3 : 2, 3},
                       is_hex ? BoxElements::hex8 : BoxElements::tet4_kuhn);
  jitter(mesh, .2, 1);
  return mesh;
}

// Half a unit in the last place of 1, what one operation is off by.
static double rounding_of(const Body& body) {
  return body.model.options.precision == Precision::in_single ? 6e-8 : 1.1e-16;
}

// Calls body(formulation, material model) for all that go together.
template <class Check>
static void for_each_kind(const Check& check) {
  for (const Formulation formulation : all_formulations())
    for (const MaterialModel model : all_models()) {
      if (!is_possible(formulation, model)) continue;
      SCOPED_TRACE(std::string(name_of(formulation)) + " material " +
                   std::to_string(static_cast<int>(model)));
      check(formulation, model);
    }
}

// Runs `check` on each kind in both precisions, displaced at random by up to a tenth of an edge.
template <class Check>
static void for_each_body(const Check& check) {
  for_each_kind([&](Formulation formulation, MaterialModel model) {
    for (const Precision precision : precisions) {
      Body body =
          make_body(mesh_for(formulation), {.materials = {material_of(model, 1000, 9000)},
                                            .solver = with(formulation, {.precision = precision})});
      shake(body.state.u, 5e-4, 11);
      check(body);
    }
  });
}

// A strain of 1e-40 makes stresses that single precision holds only as subnormal numbers.
TEST(SinglePrecision, takes_subnormal_numbers_as_zero_and_leaves_double_precision_alone) {
  for (const Precision precision : {Precision::in_double, Precision::in_single}) {
    Body body = make_body(irregular_elements()[1], {.solver = {.precision = precision}});
    displace(body, [](const Vec3& X) { return Vec3(1e-40 * X.y(), 0, 0); });
    EXPECT_EQ(largest(force(body)) == 0, precision == Precision::in_single);
    volatile double small = 1e-300;
    small = small * 1e-15;
    EXPECT_GT(small, 0);
  }
}

TEST(Simd, every_instruction_set_gives_the_scalar_forces_energies_and_watch_to_rounding) {
  for_each_body([](Body& body) {
    const double eps = rounding_of(body);
    const WithSimd scalar("scalar");
    const std::vector<double> f = force(body);
    const double W = stored_energy(body);
    const Watch w = look(body);
    for (const std::string& name : supported()) {
      select_simd(name);
      force(body);
      // A hundred roundings, up to 24 elements a node.
      EXPECT_LE(largest_difference(body.scratch.force, f), 270 * eps * largest(f)) << name;
      EXPECT_NEAR(stored_energy(body), W, 1000 * eps * W) << name;
      const Watch other = look(body);
      EXPECT_NEAR(other.stable_step, w.stable_step, 1000 * eps * w.stable_step) << name;
      EXPECT_NEAR(other.least_J, w.least_J, 1000 * eps) << name;
      EXPECT_EQ(other.least_J_element, w.least_J_element) << name;
    }
  });
}

TEST(Simd, single_precision_is_as_close_to_double_as_its_digits_allow) {
  for_each_kind([](Formulation formulation, MaterialModel model) {
    const BodyOptions options{.materials = {material_of(model, 1000, 9000)},
                              .solver = with(formulation)};
    BodyOptions single = options;
    single.solver.precision = Precision::in_single;
    Body exact = make_body(mesh_for(formulation), options);
    shake(exact.state.u, 5e-4, 11);
    Body body = make_body(mesh_for(formulation), single);
    body.state = exact.state;
    const std::vector<double> f = force(exact);
    force(body);
    // Some ten roundings of the stress survive.
    EXPECT_LE(largest_difference(body.scratch.force, f), 30 * 6e-8 * largest(f));
    EXPECT_NEAR(stored_energy(body) / stored_energy(exact), 1, 100 * 6e-8);
    EXPECT_NEAR(look(body).stable_step / look(exact).stable_step, 1, 100 * 6e-8);
  });
}

TEST(Simd, single_precision_does_not_mind_a_body_that_has_moved_ten_metres) {
  for (const Formulation formulation : all_formulations()) {
    Body body = make_body(mesh_for(formulation),
                          {.solver = with(formulation, {.precision = Precision::in_single})});
    shake(body.state.u, 1e-6, 12);
    const std::vector<double> f = force(body);
    for (std::size_t k = 0; k < body.state.u.size(); k += 3) body.state.u[k] += 10;
    force(body);
    // u is rounded to 1e-15 m of 1e-6 m.
    EXPECT_LE(largest_difference(body.scratch.force, f), 1e-7 * largest(f));
  }
}

// Copies of a small mesh beside each other, in each lane of several blocks.
static Mesh copies_of(const Mesh& single, int n_copies) {
  Mesh mesh;
  const int n = static_cast<int>(single.X.size());
  for (int copy = 0; copy < n_copies; ++copy) {
    std::vector<std::int32_t> corner;
    for (int a = 0; a < n; ++a) corner.push_back(copy * n + a);
    mesh.X.insert(mesh.X.end(), single.X.begin(), single.X.end());
    add_element(mesh, single.element_type[0], corner);
  }
  return mesh;
}

// An accident of vectorisation would show.
static void check_copies(Body& body, int n) {
  Noise noise(2);
  for (std::size_t k = 0; k < body.state.u.size(); ++k)
    body.state.u[k] =
        k < static_cast<std::size_t>(3 * n) ? 1e-3 * noise() : body.state.u[k - 3 * n];
  for (const std::string& name : supported()) {
    const WithSimd choice(name);
    const std::vector<double> f = force(body);
    for (std::size_t k = 0; k < f.size(); ++k) EXPECT_EQ(f[k], f[k % (3 * n)]) << name;
  }
}

TEST(Simd, an_elements_force_does_not_depend_on_its_lane_or_block) {
  for_each_kind([](Formulation formulation, MaterialModel model) {
    const Mesh single = irregular_elements()[static_cast<std::size_t>(shape_of(formulation))];
    for (const Precision precision : precisions) {
      Body body =
          make_body(copies_of(single, 35), {.materials = {material_of(model, 1000, 9000)},
                                            .solver = with(formulation, {.precision = precision})});
      check_copies(body, static_cast<int>(single.X.size()));
    }
  });
}

TEST(SelectSimd, picks_what_it_is_told_and_auto_picks_the_widest) {
  for (const std::string& name : supported()) {
    const WithSimd choice(name);
    EXPECT_EQ(simd_name(), name);
  }
  EXPECT_EQ(simd_name(), supported().back());
}

TEST(SelectSimd, refuses_an_unknown_name_and_keeps_its_choice) {
  const std::string before = simd_name();
  EXPECT_THROW(select_simd("neon"), InputError);
  EXPECT_EQ(simd_name(), before);
}
