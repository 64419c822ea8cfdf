// V2, finite-strain patch test: an affine displacement of a block of distorted elements leaves the
// interior in equilibrium and has the energy of the homogeneous deformation.
#include "larger_or_nan.h"
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

static Body patch(Formulation formulation, Precision precision) {
  const bool is_hex = shape_of(formulation) == ElementType::hex8;
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.06, .06, .06), {6, 6, 6},
                       is_hex ? BoxElements::hex8 : BoxElements::tet4_kuhn);
  jitter(mesh, .25, 7);
  Body body = make_body(mesh, {.materials = {{MaterialModel::neo_hookean, 3000, .49, 1000}},
                               .solver = with(formulation, {.precision = precision})});
  Mat3 A;
  A << .1, .3, -.1, .05, -.1, .2, .15, -.1, .05;
  displace(body, [&](const Vec3& X) { return Vec3(A * X); });
  return body;
}

static std::vector<Formulation> solid_formulations() {
  std::vector<Formulation> solid;
  for (const Formulation f : all_formulations())
    if (shape_of(f) != ElementType::tri3) solid.push_back(f);
  return solid;
}

static std::string mesh_of(Formulation formulation, Precision precision) {
  return std::string(name_of(formulation)) + " " + name_of(precision) + " 6 x 6 x 6";
}

TEST(PatchTest, interior_nodes_of_distorted_elements_are_in_equilibrium) {
  for (const Formulation formulation : solid_formulations())
    for (const Precision precision : precisions) {
      Body body = patch(formulation, precision);
      const std::vector<double>& f = force(body);
      double interior = 0, boundary = 0;
      for (std::int32_t i = 0; i < body.model.n_owned; ++i) {
        const double norm = Vec3::Map(&f[3 * i]).norm();
        double& most = is_inside(body.mesh.X[i], .06) ? interior : boundary;
        most = larger_or_nan(most, norm);
      }
      // numerics V2: rounding.
      check_figure({"V2 Finite-strain patch", "greatest interior over greatest boundary force",
                    mesh_of(formulation, precision), interior / boundary, 0,
                    precision == Precision::in_double ? 1e-13 : 6e-6, "equilibrium"});
    }
}

TEST(PatchTest, energy_is_the_exact_one_whatever_the_element) {
  for (const Formulation formulation : solid_formulations())
    for (const Precision precision : precisions) {
      Body body = patch(formulation, precision);
      // refs.json, printed digits: half a unit of the ninth.
      check_figure({"V2 Finite-strain patch", "energy [J]", mesh_of(formulation, precision),
                    stored_energy(body), .042324204,
                    precision == Precision::in_double ? 6e-10 / .0423 : 1e-5, "closed form"});
    }
}
