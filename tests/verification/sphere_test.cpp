// V17, inflation of a thick sphere of radii 1 and 2 by its inner radius: an eighth of it between
// three mirror planes, against the closed form of the incompressible neo-Hookean sphere.
#include <map>
#include <numbers>

#include "verification_dynamics.h"
#include "verification_figure.h"
#include "verification_statics.h"

using namespace trocar;

constexpr double inner_radius = 1, outer_radius = 2;

// Positions on the surface of the cube [0, n]^3 away from the origin, as nodes of a layer.
struct Octant {
  int n = 0;
  std::vector<std::array<int, 3>> point;
  std::vector<std::array<std::int32_t, 4>> quad;
};

static Octant make_octant(int n) {
  Octant octant{.n = n};
  std::map<std::array<int, 3>, std::int32_t> number;
  const auto node = [&](int axis, int i, int j) {
    std::array<int, 3> p{};
    p[axis] = n, p[(axis + 1) % 3] = i, p[(axis + 2) % 3] = j;
    const auto [at, is_new] = number.try_emplace(p, std::int32_t(octant.point.size()));
    if (is_new) octant.point.push_back(p);
    return at->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        octant.quad.push_back({node(axis, i, j), node(axis, i + 1, j), node(axis, i + 1, j + 1),
                               node(axis, i, j + 1)});
  return octant;
}

// Angles of equal size along the edges of the cube; mirror planes are met exactly.
static Vec3 direction(const std::array<int, 3>& p, int n) {
  Vec3 d;
  for (int j = 0; j < 3; ++j) d[j] = p[j] == n ? 1 : std::tan(std::numbers::pi / 4 * p[j] / n);
  return d.normalized();
}

// A prism over a triangle whose corners ascend: neighbours split the quad between them alike.
static void add_prism(Mesh& mesh, std::array<std::int32_t, 3> t, std::int32_t layer) {
  std::sort(t.begin(), t.end());
  const auto [a, b, c] = t;
  const std::array<std::int32_t, 4> tets[] = {
      {a, b, c, c + layer}, {a, b, c + layer, b + layer}, {a, b + layer, c + layer, a + layer}};
  for (std::array<std::int32_t, 4> tet : tets) {
    const Vec3 e = mesh.X[tet[1]] - mesh.X[tet[0]], f = mesh.X[tet[2]] - mesh.X[tet[0]];
    if (e.cross(f).dot(mesh.X[tet[3]] - mesh.X[tet[0]]) < 0) std::swap(tet[2], tet[3]);
    add_element(mesh, ElementType::tet4, tet);
  }
}

// n cells along an arc of 45 degrees, n_layers through the wall.
static Mesh eighth_sphere(int n, int n_layers, bool is_hex) {
  const Octant octant = make_octant(n);
  const auto layer = static_cast<std::int32_t>(octant.point.size());
  Mesh mesh;
  mesh.region_name = {""};
  for (int k = 0; k <= n_layers; ++k)
    for (const std::array<int, 3>& p : octant.point)
      mesh.X.emplace_back((inner_radius + (outer_radius - inner_radius) * k / n_layers) *
                          direction(p, n));
  for (int k = 0; k < n_layers; ++k)
    for (const auto& [a, b, c, d] : octant.quad) {
      const std::int32_t low = k * layer, high = low + layer;
      if (is_hex) {
        const std::int32_t hex[] = {a + low,  b + low,  c + low,  d + low,
                                    a + high, b + high, c + high, d + high};
        add_element(mesh, ElementType::hex8, hex);
      } else {
        add_prism(mesh, {a + low, b + low, c + low}, layer);
        add_prism(mesh, {a + low, c + low, d + low}, layer);
      }
    }
  return mesh;
}

// p / mu of the incompressible sphere whose inner radius grows by the factor la.
static double exact_pressure(double la) {
  const double lb = std::cbrt(1 + (la * la * la - 1) * std::pow(inner_radius / outer_radius, 3));
  const auto term = [](double l) { return 2 / l + 1 / (2 * l * l * l * l); };
  return term(lb) - term(la);
}

// From the virtual work of a radial motion of the inner surface: sum f.x = p 3 V of the octant's
// cavity, V = pi/6 (la inner_radius)^3.
static double inner_pressure(const Body& body, double la) {
  double work = 0;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    if (body.mesh.X[i].norm() < inner_radius * (1 + 1e-9))
      work -= la * body.mesh.X[i].dot(Vec3::Map(&body.scratch.force[3 * i]));
  return work / (3 * std::numbers::pi / 6 * std::pow(la * inner_radius, 3));
}

static double pressure(const Variant& variant, int n, double la) {
  Mesh mesh = eighth_sphere(n, n, shape_of(variant.formulation) == ElementType::hex8);
  BodyOptions options{.materials = {material_of(MaterialModel::neo_hookean, 1, 1000, 1)},
                      .solver = solver_options(variant)};
  std::vector<PrescribedNode> inner;
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    unsigned mask = 0;
    for (int j = 0; j < 3; ++j)
      if (mesh.X[i][j] < 1e-9) mask |= 1U << j;
    options.fixed.push_back(static_cast<FixedMask>(mask));
    if (mesh.X[i].norm() < inner_radius * (1 + 1e-9))
      inner.push_back({.node = i, .u_next = (la - 1) * mesh.X[i]});
  }
  Body body = make_body(std::move(mesh), options);
  settle(body, {.prescribed = inner, .ramp_iterations = 1000, .tolerance = 1e-5});
  return inner_pressure(body, la);
}

// K / mu = 1000 makes .1 % of the pressure: the closed form is that of K = infinity.
static void check_pressure(const Variant& variant, int n, double la) {
  const double exact = exact_pressure(la);
  const double coarse = pressure(variant, n / 2, la), fine = pressure(variant, n, la);
  check_figure({"V17 Thick sphere",
                "pressure / mu at a stretch of " + std::to_string(la).substr(0, 4),
                std::string(variant.name) + " 3 x " + std::to_string(n) + " x " +
                    std::to_string(n) + " x " + std::to_string(n),
                fine, exact, two_mesh_tolerance(coarse, fine, exact) + .001, "closed form",
                order_between(coarse - exact, fine - exact)});
}

TEST(V17ThickSphere, the_closed_form_is_that_of_the_table) {
  for (const auto& [la, p] : {std::pair{1.1, .2871548459}, std::pair{1.25, .5518685420},
                              std::pair{1.5, .7554331187}, std::pair{2., .8069266031}})
    EXPECT_NEAR(exact_pressure(la), p, 1e-10);  // printed digits
}

TEST(V17ThickSphere, pressure_of_hexahedra_converges_to_the_closed_form_before_and_after_its_peak) {
  for (const Variant& variant : {hex_one_point, hex_enhanced})
    for (const double la : {1.1, 1.25, 1.5, 2.}) check_pressure(variant, 8, la);
}

TEST(V17ThickSphere, pressure_of_tetrahedra_converges_with_and_without_a_share_of_their_own) {
  Variant without_share = tet_nodal_pressure;
  without_share.own_volume_stiffness = 0;
  without_share.name = "tet4-nodal-pressure, no own share";
  const int n = is_report() ? 8 : 4;
  for (const double la : {1.25, 1.5}) {
    check_pressure(tet_nodal_pressure, n, la);
    check_pressure(without_share, n, la);
  }
}
