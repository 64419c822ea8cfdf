// V2, patch tests: an affine displacement of a block of distorted elements leaves the interior in
// equilibrium and has the energy of the homogeneous deformation; where the boundary alone is moved,
// the interior follows.
#include "larger_or_nan.h"
#include "mesh/edit.h"
#include "mesh_split.h"
#include "verification_dynamics.h"
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

static Mat3 patch_gradient() {
  Mat3 A;
  A << .1, .3, -.1, .05, -.1, .2, .15, -.1, .05;
  return A;
}

// At rest, with mass damping [1/s].
static Body patch_at_rest(Formulation formulation, Precision precision, double mass_damping = 0) {
  const bool is_hex = shape_of(formulation) == ElementType::hex8;
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(.06, .06, .06), {6, 6, 6},
                       is_hex ? BoxElements::hex8 : BoxElements::tet4_kuhn);
  jitter(mesh, .25, 7);
  return make_body(
      mesh, {.materials = {{MaterialModel::neo_hookean, 3000, .49, 1000}},
             .solver = with(formulation, {.mass_damping = mass_damping, .precision = precision})});
}

static Body patch(Formulation formulation, Precision precision) {
  Body body = patch_at_rest(formulation, precision);
  displace(body, [](const Vec3& X) { return Vec3(patch_gradient() * X); });
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

// The boundary goes to A X within 0.1 s, the rest follows by its own motion; largest distance of
// inner nodes from A X at the end, over the side.
static double miss_of_dynamic_patch(Formulation formulation) {
  constexpr double width = .06, ramp = .1;
  Body body = patch_at_rest(formulation, Precision::in_double, 200);
  std::vector<PrescribedNode> boundary;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    if (!is_inside(body.mesh.X[i], width)) boundary.push_back({.node = i});
  // Waves between clamped faces have omega > pi sqrt(3) c_s / width = 91 / s, less than alpha / 2:
  // they die down faster than exp(-s t), s = alpha/2 - sqrt(alpha^2/4 - omega^2) = 58 / s.
  while (body.state.time < ramp + .6) {
    const double dt = .85 * watch(body.model, body.part, body.state).stable_step;
    for (int k = 0; k < 20; ++k) {
      const double t = std::min(1., (body.state.time + dt) / ramp);
      for (PrescribedNode& node : boundary)
        node.u_next = t * t * (3 - 2 * t) * patch_gradient() * body.mesh.X[node.node];
      force(body);
      integrate(body.model, body.scratch, boundary, dt, body.state);
    }
  }
  double most = 0;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    most = larger_or_nan(
        most, (Vec3::Map(&body.state.u[3 * i]) - patch_gradient() * body.mesh.X[i]).norm() / width);
  return most;
}

TEST(PatchTest, interior_nodes_follow_a_boundary_that_moves) {
  for (const Formulation formulation : solid_formulations())
    // numerics V2.
    check_figure({"V2 Finite-strain patch",
                  "greatest error of displacement after a ramp, over the side",
                  mesh_of(formulation, Precision::in_double), miss_of_dynamic_patch(formulation), 0,
                  1e-9, "linear field"});
}

// MacNeal and Harder (Finite Elements in Analysis and Design 1, 1985), the unit cube of seven
// hexahedra with a distorted one inside.
static Mesh macneal_harder_cube(bool is_of_tets) {
  Mesh mesh;
  mesh.X = {{0, 0, 0},          {1, 0, 0},          {1, 1, 0},          {0, 1, 0},
            {0, 0, 1},          {1, 0, 1},          {1, 1, 1},          {0, 1, 1},
            {.249, .342, .192}, {.826, .288, .288}, {.850, .649, .263}, {.273, .750, .230},
            {.320, .186, .643}, {.677, .305, .683}, {.788, .693, .644}, {.165, .745, .702}};
  using Corners = std::vector<std::int32_t>;
  for (const Corners& corners :
       {Corners{8, 9, 10, 11, 12, 13, 14, 15}, Corners{0, 1, 2, 3, 8, 9, 10, 11},
        Corners{12, 13, 14, 15, 4, 5, 6, 7}, Corners{0, 1, 9, 8, 4, 5, 13, 12},
        Corners{1, 2, 10, 9, 5, 6, 14, 13}, Corners{2, 3, 11, 10, 6, 7, 15, 14},
        Corners{3, 0, 8, 11, 7, 4, 12, 15}})
    add_element(mesh, ElementType::hex8, corners);
  if (!is_of_tets) return mesh;
  MeshEdit edit;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) edit.splits.push_back(split_of(mesh, e));
  apply_edit(edit, mesh);
  return mesh;
}

TEST(PatchTest, stresses_of_macneal_and_harders_cube_are_the_exact_ones) {
  // All strains 1e-3, E = 1e6, nu = .25: lambda = mu = 4e5.
  constexpr double direct = 4e5 * 3e-3 + 2 * 4e5 * 1e-3, shear = 4e5 * 1e-3;
  const Mat3 A = 5e-4 * (Mat3::Identity() + Mat3::Ones());
  for (const Formulation formulation : solid_formulations()) {
    if (!is_possible(formulation, MaterialModel::linear)) continue;
    const bool is_of_tets = shape_of(formulation) != ElementType::hex8;
    Body body = make_body(
        macneal_harder_cube(is_of_tets),
        {.materials = {{MaterialModel::linear, 1e6, .25, 1}}, .solver = with(formulation)});
    std::vector<PrescribedNode> boundary;
    for (std::int32_t i = 0; i < 8; ++i)
      boundary.push_back({.node = i, .u_next = A * body.mesh.X[i]});
    settle(body, {.prescribed = boundary, .tolerance = 1e-12});
    // On the face x = 1 of area 1.
    const Vec3 f = reaction_of(body, [](const Vec3& X) { return X.x() == 1; });
    const std::string mesh = std::string(name_of(formulation)) +
                             (is_of_tets ? ", 7 hexahedra in tetrahedra" : ", 7 hexahedra");
    const auto check = [&](const char* quantity, double number, double reference) {
      // What relaxation leaves of the forces.
      check_figure(
          {"V2 MacNeal and Harder's cube", quantity, mesh, number, reference, 1e-9, "closed form"});
    };
    check("force on the face x = 1 [N], along x", f.x(), direct);
    check("the same along y", f.y(), shear);
    check("the same along z", f.z(), shear);
    check("energy [J]", stored_energy(body), .5 * (3 * direct * 1e-3 + 3 * shear * 1e-3));
    double most = 0;
    for (std::int32_t i = 8; i < 16; ++i)
      most = larger_or_nan(most, (Vec3::Map(&body.state.u[3 * i]) - A * body.mesh.X[i]).norm());
    check("greatest error of an inner node over the strain", most / 1e-3, 0);
  }
}
