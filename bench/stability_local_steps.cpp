// Bodies with a few small elements that take steps of their own (solver/multirate).
#include "solver_multirate.h"
#include "stability_body.h"

namespace trocar {

namespace {

struct Uneven {
  const char* name;
  Mesh mesh;
};

std::vector<Uneven> uneven_bodies() {
  return {{"hex8 with a thin layer", with_thin_layer(BoxElements::hex8)},
          {"tet4 with a thin layer", with_thin_layer(BoxElements::tet4_kuhn)},
          {"tet4 with a sliver", with_sliver(BoxElements::tet4_kuhn)}};
}

Refined make_refined(const Mesh& mesh, Precision precision) {
  return Refined(mesh, {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}},
                        .solver = {.precision = precision}});
}

// Means over a twentieth of the steps: what is stored is not quite the energy of the steps' force.
double energy_change(Refined& body, double dt, int n) {
  const int window = n / 20;
  double first = 0, last = 0;
  for (int k = 0; k < n; ++k) {
    const bool is_first = k < window, is_last = k >= n - window;
    if (!is_first && !is_last) {
      refined_step(body, dt);
      continue;
    }
    (is_first ? first : last) += refined_step_and_measure(body, dt);
  }
  return is_finite(body.body) ? last / first - 1 : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<StabilityRow> local_time_steps(double scale) {
  std::vector<StabilityRow> rows;
  for (const Uneven& uneven : uneven_bodies()) {
    Refined exact = make_refined(uneven.mesh, Precision::in_double);
    const double single_rate = limit_of(exact.body);
    const double limit = stated_limit(exact, [](Body& body) { return limit_of(body); });
    for (const Precision precision : precisions) {
      Refined body = make_refined(uneven.mesh, precision);
      for (std::size_t i = 0; i < uneven.mesh.X.size(); ++i)
        body.body.state.v[3 * i + 2] = .05 * std::cos(M_PI / .03 * uneven.mesh.X[i].y());
      shake(body.body.state.v, .01, 9);
      const int n = count(1e5, std::max(scale, .1));
      const double change = energy_change(body, .85 * limit, n);
      rows.push_back(
          {text("%s, %s, local steps: %d a step, which is %.1f times as long", uneven.name,
                name_of(precision), body.plan.n_substeps, limit / single_rate),
           text("large vibration and noise at 0.85 of the limit: energy within 1 %% "
                "after %d steps",
                n),
           text("%+.3f %%", 100 * change), std::abs(change) < .01});
    }
  }
  return rows;
}

}  // namespace trocar
