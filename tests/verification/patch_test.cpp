// V2, finite-strain patch test: an affine displacement of a block of distorted elements leaves the
// interior in equilibrium and has the energy of the homogeneous deformation.
#include <gtest/gtest.h>

#include "solver_body.h"

using namespace trocar;

static Body patch(BoxElements elements) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.06, .06, .06), {6, 6, 6}, elements);
  jitter(mesh, .25, 7);
  Body body = make_body(mesh, {.materials = {{MaterialModel::neo_hookean, 3000, .49, 1000}}});
  Mat3 A;
  A << .1, .3, -.1, .05, -.1, .2, .15, -.1, .05;
  displace(body, [&](const Vec3& X) { return Vec3(A * X); });
  return body;
}

static bool is_interior(const Vec3& X) {
  return (X.array() > 1e-9).all() && (X.array() < .06 - 1e-9).all();
}

TEST(PatchTest, interior_nodes_of_distorted_hexahedra_and_tetrahedra_are_in_equilibrium) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    Body body = patch(elements);
    const std::vector<double>& f = force(body);
    double interior = 0, boundary = 0;
    for (std::int32_t i = 0; i < body.model.n_owned; ++i) {
      const double norm = Vec3::Map(&f[3 * i]).norm();
      double& most = is_interior(body.mesh.X[i]) ? interior : boundary;
      most = std::max(most, norm);
    }
    EXPECT_LT(interior, 1e-12 * boundary);  // roundings of up to 24 elements at a node
  }
}

TEST(PatchTest, energy_is_the_exact_one_whatever_the_mesh) {
  for (const BoxElements elements : {BoxElements::hex8, BoxElements::tet4_kuhn}) {
    const Body body = patch(elements);
    EXPECT_NEAR(stored_energy(body), .042324204, 6e-10);  // refs.json, printed digits
  }
}
