// Steps near the limit, many steps, and materials near the incompressible limit.
#include "larger_or_nan.h"
#include "stability_body.h"

namespace trocar {

std::vector<StabilityRow> steps_around_the_limit(double scale) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both)
    for (const double factor : {.5, .9, .99, .999, 1.01, 1.05}) {
      Body body = make_body(block(elements, 4, .15),
                            {.materials = {{MaterialModel::neo_hookean, 3000, .49, 1000}}});
      const double limit = limit_of(body);
      shake(body.state.v, 1e-9, 3);
      const double start = kinetic(body);
      double most = 0;
      const int n = factor < 1 ? count(20000, scale) : 400;
      int diverged = 0;
      for (int k = 0; k < n && diverged == 0; ++k) {
        step(body, factor * limit);
        most = larger_or_nan(most, kinetic(body));
        if (most > 1e4 * start) diverged = k + 1;
      }
      StabilityRow row{
          text("%s, step %.3f of the limit, velocity noise", name_of(elements), factor)};
      if (factor < 1) {
        row.promise = text("v^2 grows less than 4-fold in %d steps", n);
        row.measured = text("%.2f-fold", most / start);
        row.is_kept = diverged == 0 && most < 4 * start;
      } else {
        row.promise = "unstable within 400 steps: the limit is sharp";
        row.measured = diverged > 0 ? text("1e4-fold after %d steps", diverged) : "stable";
        row.is_kept = diverged > 0;
      }
      rows.push_back(row);
    }
  return rows;
}

// A large vibration with noise in all modes of a block whose highest frequency is the sharp limit.
// Central differences have a third-order resonance where omega dt / 2 = sin(pi / 3): a cubic term
// of the strain energy feeds such a mode. Steps below 0.866 of the limit keep every mode out of it.
std::vector<StabilityRow> third_order_resonance(double scale) {
  std::vector<StabilityRow> rows;
  Body exact = make_body(block(BoxElements::hex8, 2, .1),
                         {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}}});
  const double limit = limit_of(exact, 1e-5);
  for (const Precision precision : precisions)
    for (const double factor : {.70711, .84, .86603}) {
      Body body = make_body(block(BoxElements::hex8, 2, .1),
                            {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}},
                             .solver = {.precision = precision}});
      const double dt = factor * limit;
      for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
        body.state.v[3 * i] = .03 * std::cos(M_PI / (2 * edge) * body.mesh.X[i].y());
      shake(body.state.v, .01, 9);
      const int n = count(300000, std::max(scale, .1));
      int diverged = 0;
      for (int k = 0; k < n && diverged == 0; ++k) {
        step(body, dt);
        if (!(std::abs(body.state.v[0]) < 10)) diverged = k + 1;
      }
      const bool is_resonant = factor > .85;
      rows.push_back({text("hex8, %s, step %.5f of the limit, large vibration and noise",
                           name_of(precision), factor),
                      is_resonant ? "sin(pi/3): diverges, which is why steps stay below"
                                  : text("finite after %d steps", n),
                      diverged > 0 ? text("diverges after %d steps", diverged) : "finite",
                      (diverged > 0) == is_resonant});
    }
  return rows;
}

// A shear wave's energy and the step in units of h / c_d, whatever Poisson's ratio.
std::vector<StabilityRow> nearly_incompressible(double scale) {
  std::vector<StabilityRow> rows;
  for (const double nu : {.45, .49, .499, .4999, .49999})
    for (const Precision precision : precisions) {
      const Material material{MaterialModel::neo_hookean, 3000, nu, 1000};
      Body body = make_body(block(BoxElements::hex8, 6, 0),
                            {.materials = {material}, .solver = {.precision = precision}});
      const double c_d = std::sqrt((bulk_modulus(material) + 4. / 3 * lame_mu(material)) / 1000);
      const double limit = limit_of(body), courant = limit * c_d / edge;
      const double k = M_PI / .06;
      for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
        body.state.v[3 * i] = .05 * std::cos(k * body.mesh.X[i].y());
      const int n = count(20000, scale);
      const double grown = energy_growth(body, .9 * limit, n);
      rows.push_back({text("hex8, %s, poisson_ratio %g", name_of(precision), nu),
                      text("energy within 1 %% over %d steps; step 0.84 to 0.91 h/c_d", n),
                      text("%+.2f %%, %.3f h/c_d", 100 * grown, courant),
                      grown < .01 && courant > .84 && courant < .91});
    }
  return rows;
}

std::vector<StabilityRow> free_fall(double scale) {
  std::vector<StabilityRow> rows;
  for (const Precision precision : precisions) {
    const double g = 9.81;
    Body body = make_body(block(BoxElements::hex8, 3, .2),
                          {.materials = {{MaterialModel::neo_hookean, 3000, .49, 1000}},
                           .solver = {.gravity = Vec3(0, 0, -g), .precision = precision}});
    const double dt = .9 * least_element_step(body), duration = 10 * scale;
    const int n = static_cast<int>(duration / dt);
    for (int k = 0; k < n; ++k) step(body, dt);
    // Leapfrog from rest with v(1/2) = dt/2 g falls g t^2 / 2 exactly.
    const double fall = .5 * g * body.state.time * body.state.time;
    double strain = 0;
    for (std::size_t i = 1; i < body.mesh.X.size(); ++i)
      for (int j = 0; j < 3; ++j)
        strain = larger_or_nan(strain, std::abs(body.state.u[3 * i + j] - body.state.u[j]) / edge);
    rows.push_back({text("hex8, %s, falls for %.1f s (%.0f m)", name_of(precision), duration, fall),
                    "the exact parabola to 1e-9; strain below 1e-5",
                    text("%.1e, strain %.1e", std::abs(body.state.u[2] / -fall - 1), strain),
                    std::abs(body.state.u[2] / -fall - 1) < 1e-9 && strain < 1e-5});
  }
  return rows;
}

// A large vibration of `steps` steps, at the default step or above it.
static StabilityRow vibration(Precision precision, double factor, int steps) {
  Body body = make_body(block(BoxElements::hex8, 2, .1),
                        {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}},
                         .solver = {.precision = precision}});
  const double k = M_PI / (2 * edge);
  for (std::size_t i = 0; i < body.mesh.X.size(); ++i)
    body.state.v[3 * i] = .03 * std::cos(k * body.mesh.X[i].y());
  const double dt = factor * limit_of(body), mv = .03 * sum(body.model.mass);
  const Vec3 before = momentum_of(body);
  const int window = steps / 20;
  double first = 0, last = 0;
  int n_first = 0, n_last = 0;
  for (int s = 0; s < steps; ++s) {
    if (s % 64 != 1) {
      step(body, dt);
      continue;
    }
    const double energy = step_and_measure(body, dt);
    if (s < window) first += energy, ++n_first;
    if (s >= steps - window) last += energy, ++n_last;
  }
  const double drift = (momentum_of(body) - before).norm() / mv;
  const double change = last / n_last / (first / n_first) - 1;
  const bool is_single = precision == Precision::in_single;
  const double most = is_single ? .005 : .002;
  // In single the corner forces of an element add up to a rounding error: a random walk of
  // 6e-8 f dt a step, 3e3 times that after 1e7 steps, f dt / (m v) about 0.3.
  const double most_drift = is_single ? 2e-5 : 1e-6;
  return {text("hex8, %s, free vibration at %g of the limit, %d steps", name_of(precision), factor,
               steps),
          text("energy within %.1f %%, momentum within %.0e", 100 * most, most_drift),
          text("%+.4f %%, %.1e", 100 * change, drift),
          is_finite(body) && std::abs(change) < most && drift < most_drift};
}

std::vector<StabilityRow> long_vibration(double scale) {
  std::vector<StabilityRow> rows;
  for (const Precision precision : precisions)
    rows.push_back(vibration(precision, .9, count(1e6, scale)));
  for (const Precision precision : precisions)
    rows.push_back(vibration(precision, .85, count(1e7, scale)));
  return rows;
}

}  // namespace trocar
