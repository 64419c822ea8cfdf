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

// Runs `check` on each mesh with each material, displaced at random by up to a tenth of an edge.
template <class Check>
static void for_each_body(const Check& check) {
  for (const Mesh& mesh : meshes())
    for (const MaterialModel model : all_models()) {
      Body body = make_body(mesh, {.materials = {material_of(model, 1000, 9000)}});
      shake(body.state.u, 5e-4, 11);
      check(body);
    }
}

TEST(Simd, every_instruction_set_gives_the_scalar_forces_energies_and_watch_to_rounding) {
  for_each_body([](Body& body) {
    const WithSimd scalar("scalar");
    const std::vector<double> f = force(body);
    const double W = stored_energy(body);
    const Watch w = watch(body.model, body.part, body.state);
    for (const std::string& name : supported()) {
      select_simd(name);
      force(body);
      for (std::size_t k = 0; k < f.size(); ++k)  // a hundred roundings, up to 24 elements a node
        EXPECT_NEAR(body.scratch.force[k], f[k], 3e-14 * largest(f)) << name;
      EXPECT_NEAR(stored_energy(body), W, 1e-13 * W) << name;
      const Watch other = watch(body.model, body.part, body.state);
      EXPECT_NEAR(other.stable_step, w.stable_step, 1e-13 * w.stable_step) << name;
      EXPECT_NEAR(other.least_J, w.least_J, 1e-13) << name;
      EXPECT_EQ(other.least_J_element, w.least_J_element) << name;
    }
  });
}

// The same element in each lane of several blocks: an accident of vectorisation would show.
TEST(Simd, an_elements_force_does_not_depend_on_its_lane_or_block) {
  for (const Mesh& single : irregular_elements())
    for (const MaterialModel model : all_models()) {
      Mesh mesh;
      const int n = static_cast<int>(single.X.size());
      for (int copy = 0; copy < 21; ++copy) {
        std::vector<std::int32_t> corner;
        for (int a = 0; a < n; ++a) corner.push_back(copy * n + a);
        mesh.X.insert(mesh.X.end(), single.X.begin(), single.X.end());
        add_element(mesh, single.element_type[0], corner);
      }
      Body body = make_body(mesh, {.materials = {material_of(model, 1000, 9000)}});
      Noise noise(2);
      for (int k = 0; k < 3 * n; ++k) {
        const double u = 1e-3 * noise();
        for (int copy = 0; copy < 21; ++copy) body.state.u[3 * n * copy + k] = u;
      }
      for (const std::string& name : supported()) {
        const WithSimd choice(name);
        const std::vector<double> f = force(body);
        for (std::size_t k = 0; k < f.size(); ++k) EXPECT_EQ(f[k], f[k % (3 * n)]) << name;
      }
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
