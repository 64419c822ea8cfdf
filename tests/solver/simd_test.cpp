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

static std::vector<Mesh> meshes() {
  Mesh hex = make_box(Vec3(0, 0, 0), Vec3(.03, .02, .02), {3, 3, 3}, BoxElements::hex8);
  Mesh tet = make_box(Vec3(0, 0, 0), Vec3(.03, .02, .02), {3, 2, 3}, BoxElements::tet4_kuhn);
  jitter(hex, .2, 1);
  jitter(tet, .2, 1);
  return {hex, tet, make_rectangle(.03, .02, 7, 6)};
}

constexpr Precision precisions[] = {Precision::in_double, Precision::in_single};

// Half a unit in the last place of 1, what one operation is off by.
static double rounding(const Body& body) {
  return body.model.options.precision == Precision::in_single ? 6e-8 : 1.1e-16;
}

// Runs `check` on each mesh with each material in both precisions, displaced at random by up to a
// tenth of an edge.
template <class Check>
static void for_each_body(const Check& check) {
  for (const Mesh& mesh : meshes())
    for (const MaterialModel model : all_models())
      for (const Precision precision : precisions) {
        Body body = make_body(mesh, {.materials = {material_of(model, 1000, 9000)},
                                     .solver = {.precision = precision}});
        shake(body.state.u, 5e-4, 11);
        check(body);
      }
}

TEST(Simd, every_instruction_set_gives_the_scalar_forces_energies_and_watch_to_rounding) {
  for_each_body([](Body& body) {
    const double eps = rounding(body);
    const WithSimd scalar("scalar");
    const std::vector<double> f = force(body);
    const double W = stored_energy(body);
    const Watch w = watch(body.model, body.part, body.state);
    for (const std::string& name : supported()) {
      select_simd(name);
      force(body);
      for (std::size_t k = 0; k < f.size(); ++k)  // a hundred roundings, up to 24 elements a node
        EXPECT_NEAR(body.scratch.force[k], f[k], 270 * eps * largest(f)) << name;
      EXPECT_NEAR(stored_energy(body), W, 1000 * eps * W) << name;
      const Watch other = watch(body.model, body.part, body.state);
      EXPECT_NEAR(other.stable_step, w.stable_step, 1000 * eps * w.stable_step) << name;
      EXPECT_NEAR(other.least_J, w.least_J, 1000 * eps) << name;
      EXPECT_EQ(other.least_J_element, w.least_J_element) << name;
    }
  });
}

TEST(Simd, single_precision_is_as_close_to_double_as_its_digits_allow) {
  for (const Mesh& mesh : meshes())
    for (const MaterialModel model : all_models()) {
      Body exact = make_body(mesh, {.materials = {material_of(model, 1000, 9000)}});
      shake(exact.state.u, 5e-4, 11);
      Body body = make_body(mesh, {.materials = {material_of(model, 1000, 9000)},
                                   .solver = {.precision = Precision::in_single}});
      body.state = exact.state;
      const std::vector<double> f = force(exact);
      force(body);
      for (std::size_t k = 0; k < f.size(); ++k)  // some ten roundings of the stress survive
        EXPECT_NEAR(body.scratch.force[k], f[k], 30 * 6e-8 * largest(f));
      EXPECT_NEAR(stored_energy(body) / stored_energy(exact), 1, 100 * 6e-8);
      EXPECT_NEAR(watch(body.model, body.part, body.state).stable_step /
                      watch(exact.model, exact.part, exact.state).stable_step,
                  1, 100 * 6e-8);
    }
}

TEST(Simd, single_precision_does_not_mind_a_body_that_has_moved_ten_metres) {
  for (const Mesh& mesh : meshes()) {
    Body body = make_body(mesh, {.solver = {.precision = Precision::in_single}});
    shake(body.state.u, 1e-6, 12);
    const std::vector<double> f = force(body);
    for (std::size_t k = 0; k < body.state.u.size(); k += 3) body.state.u[k] += 10;
    force(body);
    // u is rounded to 1e-15 m of 1e-6 m.
    for (std::size_t k = 0; k < f.size(); ++k)
      EXPECT_NEAR(body.scratch.force[k], f[k], 1e-7 * largest(f));
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
  for (const Mesh& single : irregular_elements())
    for (const MaterialModel model : all_models())
      for (const Precision precision : precisions) {
        Body body = make_body(copies_of(single, 35), {.materials = {material_of(model, 1000, 9000)},
                                                      .solver = {.precision = precision}});
        check_copies(body, static_cast<int>(single.X.size()));
      }
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
