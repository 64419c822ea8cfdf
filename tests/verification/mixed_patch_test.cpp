// V2 for meshes of hexahedra and tetrahedra: quads with a hexahedron on one side and two triangles
// on the other share their nodes. What that costs of the patch test.
//
// A linear field has the same gradient in all elements, so strain, stress and energy are exact. The
// forces of a quad of area A under traction t are A t / 4 at each corner from the hexahedron, A t /
// 3 at the ends of the diagonal and A t / 6 at the others from the triangles: what is left is the
// self-equilibrated pattern A t / 12 (+, -, +, -). Diagonals in one direction cancel it between the
// quads around a node inside a plane interface; at its rim, and around scattered cells, it stays.
#include "larger_or_nan.h"
#include "mesh/edit.h"
#include "mesh/hex_split.h"
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

namespace {

constexpr double side = .06;
constexpr int n_cells = 6;

Mat3 gradient() {
  Mat3 A;
  A << .1, .3, -.1, .05, -.1, .2, .15, -.1, .05;
  return A;
}

// A cube whose cells for which `is_tet` (by number) are tetrahedra; its surface is held where the
// linear field puts it, the interior starts there.
template <class IsTet>
Body mixed_patch(const IsTet& is_tet) {
  Mesh mesh =
      make_box(Vec3::Zero(), Vec3::Constant(side), {n_cells, n_cells, n_cells}, BoxElements::hex8);
  MeshEdit edit;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    if (is_tet(e)) edit.splits.push_back({.element = e, .corner = hex_tet_nodes(mesh, e)});
  apply_edit(edit, mesh);
  BodyOptions options{.materials = {{MaterialModel::neo_hookean, 3000, .4, 1000}}};
  for (const Vec3& X : mesh.X)
    options.fixed.push_back(is_inside(X, side) ? FixedMask{0} : FixedMask{7});
  Body body = make_body(std::move(mesh), options);
  displace(body, [](const Vec3& X) { return Vec3(gradient() * X); });
  return body;
}

double greatest_interior_force(Body& body) {
  const std::vector<double>& f = force(body);
  double most = 0;
  for (std::int32_t i = 0; i < body.model.n_owned; ++i)
    if (is_inside(body.mesh.X[i], side)) most = larger_or_nan(most, Vec3::Map(&f[3 * i]).norm());
  return most;
}

bool is_in_lower_half(std::int32_t e) {
  return e < n_cells * n_cells * n_cells / 2;  // cells are numbered layer by layer
}

bool is_scattered(std::int32_t e) {
  return e * 2654435761U >> 30 == 0;  // a quarter of them
}

}  // namespace

TEST(MixedPatch, energy_of_a_linear_field_is_that_of_hexahedra_alone) {
  Body hexahedra = mixed_patch([](std::int32_t) { return false; });
  for (const auto& is_tet : {is_in_lower_half, is_scattered}) {
    Body body = mixed_patch(is_tet);
    EXPECT_GT(body.mesh.n_elements(), 400);
    EXPECT_NEAR(stored_energy(body) / stored_energy(hexahedra), 1, 1e-13);  // rounding
  }
}

TEST(MixedPatch, a_plane_interface_inside_is_in_equilibrium) {
  Body body = mixed_patch(is_in_lower_half);
  // Traction of about 3 kPa on quads of 1 cm^2: rounding of 0.3 N.
  EXPECT_LT(greatest_interior_force(body), 1e-13);
}

TEST(MixedPatch,
     scattered_cells_are_off_the_linear_field_by_less_than_a_sixth_of_strain_times_edge) {
  Body body = mixed_patch(is_scattered);
  settle(body, {.tolerance = 1e-8});
  double most = 0, sum = 0;
  int n = 0;
  const double h = side / n_cells, strain = gradient().norm();
  for (std::int32_t i = 0; i < body.model.n_owned; ++i) {
    const Vec3& X = body.mesh.X[i];
    if (!is_inside(X, side)) continue;
    const double error = (Vec3::Map(&body.state.u[3 * i]) - gradient() * X).norm() / (strain * h);
    most = larger_or_nan(most, error);
    sum += error * error;
    ++n;
  }
  // Up to some such quads at a node, each A t / 12 against a stiffness of about E h: of the order
  // of 1/12 of strain times edge.
  check_figure({"V2 Mixed patch, a quarter of the cells as tetrahedra",
                "greatest error of displacement over strain times edge", "hex8 and tet4 6 x 6 x 6",
                most, 0, 1.0 / 6, "equilibrium"});
  check_figure({"V2 Mixed patch, a quarter of the cells as tetrahedra",
                "mean error of displacement over strain times edge", "hex8 and tet4 6 x 6 x 6",
                std::sqrt(sum / n), 0, 1.0 / 12, "equilibrium"});
}
