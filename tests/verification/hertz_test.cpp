// V22, a rigid sphere on a bonded elastic layer through the contact of collision/, against Hertz's
// formula with Dimitriadis' terms of the finite thickness. Linear material, no friction.
#include <numbers>

#include "base/communicator.h"
#include "collision/contact_solve.h"
#include "collision/detector.h"
#include "mesh/facets.h"
#include "verification_dynamics.h"
#include "verification_figure.h"
#include "verification_layer.h"
#include "verification_statics.h"

using namespace trocar;

using std::numbers::pi;

constexpr double sphere_radius = .01;

// A quarter of a layer that ends `width` away; cells grow from `h0` at the indenter.
struct Layer {
  double thickness = 0, width = .1, h0 = 4e-4;
  int n = 24, n_z = 24;
};

// The same map with twice as many cells.
static Layer finer(Layer layer) {
  layer.h0 /= 2;
  layer.n *= 2;
  layer.n_z *= 2;
  return layer;
}

static double graded(double s, double length, double h0, int n) {
  const double c = std::min(1.0, h0 * n / length);
  return length * (c * s + (1 - c) * std::pow(s, 4));
}

static Body make_layer(const Variant& variant, const Layer& layer) {
  return make_box_body(
      variant,
      {.size = {1, 1, 1},
       .n = {layer.n, layer.n, layer.n_z},
       .material = {MaterialModel::linear, layer_E, layer_nu, 1000},
       .fixed =
           [](const Vec3& s) {
             if (s.z() < 1e-9) return FixedMask{7};
             return static_cast<FixedMask>((s.x() < 1e-9 ? 1 : 0) | (s.y() < 1e-9 ? 2 : 0));
           },
       .map =
           [&layer](const Vec3& s) {
             return Vec3(graded(s.x(), layer.width, layer.h0, layer.n),
                         graded(s.y(), layer.width, layer.h0, layer.n),
                         -graded(1 - s.z(), layer.thickness, layer.h0, layer.n_z));
           }});
}

// Contacts of the top; the mirror planes are no surface.
struct Indentation {
  ContactDetector detector;
  std::vector<ToolMotion> tool = std::vector<ToolMotion>(1);
  std::vector<double> mass;
  ContactSet set;

  void detect(const Body& body) {
    std::vector<Vec3> x = body.mesh.X;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += Vec3::Map(&body.state.u[3 * i]);
    std::vector<Contact> contacts;
    const std::vector<double> margin = {1e-3};
    detector.detect(x, std::vector<Pose>{tool[0].pose}, margin, contacts);
    std::erase_if(contacts, [&](const Contact& c) {
      return std::any_of(c.node.begin(), c.node.end(),
                         [&](std::int32_t i) { return body.mesh.X[i].z() < -1e-9; });
    });
    set = prepare_contacts({contacts}, std::vector<std::int32_t>(mass.size(), 0), body.part,
                           {.mass = mass, .held = body.model.fixed});
  }
  // Before relax_step, whose prediction it makes.
  void add_force(const Relaxer& relaxer, std::int64_t number, Body& body) {
    const double c = relaxer.damping, dt = relaxer.step;
    if (dt == 0) return;
    const double keep = (2 - c * dt) / (2 + c * dt), gain = 2 * dt / (2 + c * dt);
    for (std::size_t k = 0; k < set.node.size(); ++k) {
      const auto i = static_cast<std::size_t>(set.node[k]);
      set.x_start[k] = set.x_end[k] = body.mesh.X[i] + Vec3::Map(&body.state.u[3 * i]);
      for (std::size_t j = 0; j < 3; ++j)
        if (relaxer.by_mass[3 * i + j] > 0)
          set.x_end[k][static_cast<Eigen::Index>(j)] +=
              dt *
              (keep * body.state.v[3 * i + j] + gain * body.scratch.force[3 * i + j] / mass[i]);
    }
    const ContactStep step = {.tools = tool, .number = number, .dt = dt, .response = dt * gain};
    look_again(detector, step, set);
    solve_contacts(detector, step, {.friction = 0, .release_speed = 1e9}, set);
    for (std::size_t k = 0; k < set.node.size(); ++k)
      Vec3::Map(&body.scratch.force[3 * static_cast<std::size_t>(set.node[k])]) += set.force[k];
  }
  double force() const {
    double sum = 0;
    for (const Vec3& f : set.force) sum -= f.z();
    return 4 * sum;
  }
};

static ToolShape sphere() {
  return {.pieces = {{.points = {Vec3(0, 0, sphere_radius)}, .radius = sphere_radius}}};
}

// Relaxes while the sphere comes down to `depth`.
static double indent(const Layer& layer, double depth) {
  constexpr int ramp = 1000;
  Body body = make_layer(hex_one_point, layer);
  Communicator alone;
  Relaxer relaxer = make_relaxer(body.model, {});
  Indentation contact{.detector = ContactDetector({sphere()}), .mass = relaxer.mass};
  contact.detector.set_surface(boundary_surface(body.mesh));
  while (relaxer.result.iterations < 100000) {
    const auto k = relaxer.result.iterations;
    contact.tool[0].pose.translation.z() = -depth * std::min(1.0, double(k) / ramp);
    if (k % 50 == 0) contact.detect(body);
    force(body);
    contact.add_force(relaxer, k, body);
    relax_step(body.model, body.scratch, alone, relaxer, body.state);
    if (k > ramp && k % 20 == 0 && relaxer.result.residual < 1e-4) break;
  }
  EXPECT_LT(relaxer.result.residual, 1.01e-4);
  std::printf("relaxed in %lld iterations, %zu contacts\n",
              static_cast<long long>(relaxer.result.iterations), contact.set.items.size());
  return contact.force();
}

// Of a paraboloid of curvature 1 / radius.
static double layer_force(double depth, double thickness) {
  const double x = std::sqrt(sphere_radius * depth) / thickness, a3 = alpha0 * alpha0 * alpha0;
  return 4. / 3 * plane_strain_E * std::sqrt(sphere_radius) * std::pow(depth, 1.5) *
         (1 - 2 * alpha0 / pi * x + 4 * alpha0 * alpha0 / (pi * pi) * x * x -
          8 / std::pow(pi, 3) * (a3 + 4 * pi * pi / 15 * beta0) * x * x * x +
          16 * alpha0 / std::pow(pi, 4) * (a3 + 3 * pi * pi / 5 * beta0) * x * x * x * x);
}

// What a half space opposes to a sphere, over what it opposes to that paraboloid (Sneddon 1965):
//   d = a/2 log((R + a)/(R - a)),  F = E* [ (a^2 + R^2)/2 log((R + a)/(R - a)) - a R ].
static double sphere_over_paraboloid(double depth) {
  double low = 0, high = .99 * sphere_radius;
  const auto logarithm = [](double a) {
    return std::log((sphere_radius + a) / (sphere_radius - a));
  };
  for (int k = 0; k < 60; ++k) {
    const double a = (low + high) / 2;
    (a / 2 * logarithm(a) < depth ? low : high) = a;
  }
  const double F =
      plane_strain_E *
      ((low * low + sphere_radius * sphere_radius) / 2 * logarithm(low) - low * sphere_radius);
  return F / layer_force(depth, 1e6);
}

TEST(V22Hertz, the_formula_is_that_of_the_table_for_a_thick_layer) {
  EXPECT_NEAR(layer_force(1e-3, 1e6), .0166457569, 1e-9);  // sqrt(R d) / h = 3e-9 is left
}

// Cells of an eighth of the contact's radius, and of a quarter.
static void check_indentation(double thickness, double depth) {
  const double a = std::sqrt(sphere_radius * depth);
  const Layer coarse{.thickness = thickness, .h0 = a / 4, .n = 14, .n_z = thickness > .02 ? 12 : 8};
  const Layer fine = finer(coarse);
  const double F_coarse = indent(coarse, depth), F = indent(fine, depth);
  const double exact = layer_force(depth, thickness) * sphere_over_paraboloid(depth);
  // The pressure ends like the root of the distance: where the contact ends is known to a cell, so
  // that the order is 3/2. The formula itself is that of small slopes: walls of the contact lean by
  // up to a/R, the square of which counts, d/R.
  const double tolerance = two_mesh_tolerance(F_coarse, F, exact, 1.5) + depth / sphere_radius;
  std::printf("half as fine: %.8g; tolerance %.3g\n", F_coarse, tolerance);
  check_figure({"V22 Sphere on a bonded layer",
                "force, h = " + std::to_string(thickness).substr(0, 4) +
                    " m, d = " + std::to_string(depth * 1e3).substr(0, 4) + " mm [N]",
                mesh_name(hex_one_point, {fine.n, fine.n, fine.n_z}) + ", graded", F, exact,
                tolerance, "Dimitriadis et al. 2002, Sneddon 1965",
                order_between(F_coarse - exact, F - exact)});
}

TEST(V22Hertz, a_rigid_sphere_feels_the_layer_of_the_formula) {
  for (const double thickness : {.05, .01})
    for (const double depth : {1e-3, 1e-4}) check_indentation(thickness, depth);
}
