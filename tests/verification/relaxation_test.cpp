// V29: a bent bar relaxes to the force of its elastic twin with the moduli that are left.
#include "verification_dynamics.h"
#include "verification_figure.h"

using namespace trocar;

namespace {

const Vec3 size(.06, .01, .01);
constexpr double bar_mu = 11500, bar_K = 25000, tau = .005;

bool is_end(const Vec3& X) {
  return X.x() > size.x() - 1e-9;
}

// Clamped at both ends, one 5 mm to the side of the other, as a slender beam would lie.
Body bent_bar(const Variant& variant, const std::array<int, 3>& n, const Material& material) {
  Body body = make_box_body(
      variant, {.size = size, .n = n, .material = material, .fixed = [](const Vec3& X) {
                  return FixedMask(X.x() < 1e-9 || is_end(X) ? 7 : 0);
                }});
  body.model.options.mass_damping = 60;  // that of the slowest mode when all has relaxed
  displace(body, [](const Vec3& X) {
    const double s = X.x() / size.x();
    return Vec3(0, 0, .005 * s * s * (3 - 2 * s));
  });
  return body;
}

double end_force(const Body& body) {
  return reaction_of(body, is_end).z();
}

double static_force(const Variant& variant, const std::array<int, 3>& n, const Material& material) {
  Body body = bent_bar(variant, n, material);
  settle(body, {.ramp_iterations = 0, .tolerance = 1e-6});
  return end_force(body);
}

double force_after(double time, const Variant& variant, const std::array<int, 3>& n,
                   const Material& material) {
  Body body = bent_bar(variant, n, material);
  advance(body, time, .8);
  force(body);
  return end_force(body);
}

Material bar_of(double share, double time) {
  Material material = material_of(MaterialModel::neo_hookean, bar_mu, bar_K);
  if (share > 0) material.prony = {{share, time}};
  return material;
}

void check_relaxed_force(const Variant& variant, const std::array<int, 3>& n, double share) {
  const double twin = static_force(
      variant, n, material_of(MaterialModel::neo_hookean, (1 - share) * bar_mu, bar_K));
  const std::string mesh = mesh_name(variant, n);
  const std::string what = "bent bar, share " + std::to_string(share).substr(0, 3);
  // What creeps has time constants up to tau / (1 - share) = .05 s: exp(-16) = 1e-7 is left of it,
  // of the motion exp(-24); the rest is where statics and watching stop.
  check_figure({"V29 Viscoelastic", what + ", force after 0.8 s [N]", mesh,
                force_after(.8, variant, n, bar_of(share, tau)), twin, 1e-4, "elastic twin"});
  check_figure({"V29 Viscoelastic", what + ", force in equilibrium [N]", mesh,
                static_force(variant, n, bar_of(share, tau)), twin, 1e-5, "elastic twin"});
}

}  // namespace

TEST(V29Viscoelastic, a_bent_bar_relaxes_to_its_elastic_twin) {
  for (const double share : {.5, .9}) {
    for (const Variant& variant : {hex_one_point, hex_enhanced, hex_full, tet_nodal_pressure})
      check_relaxed_force(variant, {12, 2, 2}, share);
    for (const Variant& variant : {hex_one_point, hex_enhanced})
      check_relaxed_force(variant, {12, 2, 1}, share);
  }
}

// 1.8e-5 of the stress have relaxed.
TEST(V29Viscoelastic, a_bent_bar_that_has_no_time_to_relax_is_elastic) {
  for (const Variant& variant : {hex_one_point, hex_enhanced, hex_full})
    check_figure({"V29 Viscoelastic", "bent bar, share 0.9, force after 2e-5 time constants [N]",
                  mesh_name(variant, {12, 2, 1}),
                  force_after(.5, variant, {12, 2, 1}, bar_of(.9, .5 / 2e-5)),
                  static_force(variant, {12, 2, 1}, bar_of(0, tau)), 1e-4, "elastic bar"});
}
