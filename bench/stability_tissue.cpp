// Tissue that is crushed, inverted, shaken or badly meshed.
#include "solver/relax.h"
#include "stability_body.h"

namespace trocar {

static double centre_of(const Body& body) {
  double moment = 0;
  for (std::int32_t i = 0; i < body.mesh.n_nodes(); ++i)
    moment += body.model.mass[i] * (body.mesh.X[i].z() + body.state.u[3 * i + 2]);
  return moment / sum(body.model.mass);
}

// Uniaxial strain to a fifth of the height: P = dW/dl is known, the step must follow the tissue.
std::vector<StabilityRow> confined_compression(double scale) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both)
    for (const double l : {.5, .2}) {
      const Material material{MaterialModel::neo_hookean, 3000, .45, 1000};
      const Mesh mesh = block(elements, 3, .15);
      std::vector<FixedMask> fixed(mesh.X.size(), 3);
      const double H = 3 * edge;
      std::vector<std::int32_t> top;
      for (std::size_t i = 0; i < mesh.X.size(); ++i) {
        if (mesh.X[i].z() < 1e-9) fixed[i] = 7;
        if (mesh.X[i].z() > H - 1e-9) top.push_back(static_cast<std::int32_t>(i));
      }
      Body body = make_body(
          mesh, {.materials = {material}, .solver = {.mass_damping = 100}, .fixed = fixed});
      std::vector<PrescribedNode> prescribed(top.size());
      const double duration = .5 * std::max(scale, .2);
      double reaction = 0, least_step = 1, n_steps = 0;
      const double rest = watch(body.model, body.part, body.state).stable_step;
      while (body.state.time < 1.4 * duration && is_finite(body)) {
        const Watch w = watch(body.model, body.part, body.state);
        if (!(w.least_J > 0)) break;
        const double dt = .9 * w.stable_step;
        least_step = std::min(least_step, w.stable_step / rest);
        for (int k = 0; k < 20; ++k, ++n_steps) {
          const double t = std::min(1., (body.state.time + dt) / duration);
          for (std::size_t p = 0; p < top.size(); ++p)
            prescribed[p] = {.node = top[p],
                             .u_next = Vec3(0, 0, (l - 1) * H * t * t * (3 - 2 * t))};
          compute_force(body.model, body.state, body.scratch);
          integrate(body.model, body.scratch, prescribed, dt, body.state);
        }
        reaction = 0;
        for (const PrescribedNode& node : prescribed) reaction += node.reaction.z();
      }
      // W = mu/2 (J^(-2/3) (2 + l^2) - 3) + K/2 (J - 1)^2 with J = l.
      const double mu = lame_mu(material), K = bulk_modulus(material);
      const double P = mu * std::pow(l, -2. / 3) * (l - (2 + l * l) / (3 * l)) + K * (l - 1);
      const double error = reaction / (P * H * H) - 1;
      rows.push_back(
          {text("%s, confined, pressed to %.0f %% of its height", name_of(elements), 100 * l),
           "force within 0.5 % of the closed form; the step shrinks by itself",
           text("%+.3f %%, step down to %.2f of that at rest", 100 * error, least_step),
           std::abs(error) < .005});
    }
  return rows;
}

// The apex of a tetrahedron is pushed through its base and let go.
std::vector<StabilityRow> inversion_and_recovery(double scale) {
  std::vector<StabilityRow> rows;
  for (const double J : {.1, -.2, -1.}) {
    const Mesh mesh =
        single_element(ElementType::tet4, {{0, 0, 0}, {edge, 0, 0}, {0, edge, 0}, {0, 0, edge}});
    std::vector<FixedMask> fixed = {7, 7, 7, 3};
    Body body = make_body(mesh, {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}},
                                 .solver = {.mass_damping = 30},
                                 .fixed = fixed});
    body.state.u[11] = (J - 1) * edge;
    const Watch w = watch(body.model, body.part, body.state);
    const bool is_named = w.least_J_element == 0 && std::abs(w.least_J - J) < 1e-9;
    const double dt = .02 * least_element_step(body);
    for (int k = 0; k < count(200000, std::max(scale, .1)) && is_finite(body); ++k) step(body, dt);
    const double last = 1 + body.state.u[11] / edge;
    rows.push_back({text("tet4, apex pushed to det F = %g, released", J),
                    J > 0 ? "returns to det F = 1" : "named by the watch; returns to det F = 1",
                    text("%sdet F = %.3f", is_named ? "named; " : "", last),
                    is_named && std::abs(last - 1) < .01});
  }
  return rows;
}

std::vector<StabilityRow> nodal_noise(double scale) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both)
    for (const double amount : {.1, .3}) {
      Body body = make_body(block(elements, 4, 0),
                            {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}},
                             .solver = {.mass_damping = 40}});
      shake(body.state.u, amount * edge, 7);
      const double before = stored_energy(body);
      const double J = watch(body.model, body.part, body.state).least_J;
      double dt = 0;
      for (int k = 0; k < count(40000, std::max(scale, .25)) && is_finite(body); ++k) {
        if (k % 10 == 0) dt = .5 * watch(body.model, body.part, body.state).stable_step;
        if (!(dt > 0)) break;
        step(body, dt);
      }
      rows.push_back({text("%s, noise of %.0f %% of an edge on all nodes, released",
                           name_of(elements), 100 * amount),
                      "finite; relaxes to no energy (1e-6 of the start)",
                      text("least det F %.2f at the start, %.1e of the energy left", J,
                           stored_energy(body) / before),
                      is_finite(body) && stored_energy(body) < 1e-6 * before});
    }
  return rows;
}

std::vector<StabilityRow> stiffness_jumps(double scale) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both)
    for (const double jump : {1e3, 1e4}) {
      Mesh mesh = block(elements, 4, .15);
      mesh.region_name = {"soft", "stiff"};
      for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
        const Vec3 centre = element_centre(mesh, e);
        mesh.element_region[e] = (centre - Vec3::Constant(2 * edge)).norm() < 1.2 * edge ? 1 : 0;
      }
      Body body =
          make_body(mesh, {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000},
                                         {MaterialModel::neo_hookean, 3000 * jump, .45, 1000}}});
      const Watch w = watch(body.model, body.part, body.state);
      shake(body.state.v, 1e-3, 3);
      const double grown = energy_growth(body, .9 * w.stable_step, count(20000, scale));
      rows.push_back({text("%s, inclusion %g times stiffer", name_of(elements), jump),
                      "energy within 1 % at 0.9 of the element bound; the element that governs is "
                      "in the inclusion",
                      text("energy %+.2f %%; element %d", 100 * grown, w.stable_element),
                      grown < .01 && mesh.element_region[w.stable_element] == 1});
    }
  return rows;
}

std::vector<StabilityRow> slivers(double scale) {
  std::vector<StabilityRow> rows;
  for (const double flatness : {.1, .01, .001}) {
    // One tetrahedron with its apex close to its base, glued to a regular one by the base.
    const double h = flatness * edge;
    Mesh mesh;
    mesh.X = {{0, 0, 0}, {edge, 0, 0}, {0, edge, 0}, {edge / 3, edge / 3, h}, {0, 0, -edge}};
    add_element(mesh, ElementType::tet4, std::vector<std::int32_t>{0, 1, 2, 3});
    add_element(mesh, ElementType::tet4, std::vector<std::int32_t>{0, 2, 1, 4});
    Body body = make_body(mesh, {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}}});
    const Watch w = watch(body.model, body.part, body.state);
    shake(body.state.v, 1e-3, 3);
    const double grown = energy_growth(body, .9 * w.stable_step, count(20000, scale));
    rows.push_back({text("tet4, a sliver of %g of its regular height", flatness),
                    "energy within 1 % at 0.9 of the element bound",
                    text("energy %+.2f %%, step %.1e s (element %d)", 100 * grown, w.stable_step,
                         w.stable_element),
                    w.stable_element == 0 && grown < .01});
  }
  return rows;
}

// Every element with nodes of its own: what cuts may leave.
std::vector<StabilityRow> shards(double scale) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both) {
    const BodyOptions options{.materials = {{MaterialModel::neo_hookean, 3000, .49, 1000}}};
    const Mesh whole = block(elements, 6, 0);
    Mesh parted;
    for (std::int32_t e = 0; e < whole.n_elements(); ++e) {
      std::vector<std::int32_t> corners;
      for (const std::int32_t i : whole.corners(e)) {
        corners.push_back(parted.n_nodes());
        parted.X.push_back(whole.X[i]);
      }
      add_element(parted, whole.element_type[e], corners);
    }
    Body before = make_body(whole, options);
    const double of_whole = limit_of(before);
    Body body = make_body(parted, options);
    const double limit = limit_of(body), bound = least_element_step(body);
    shake(body.state.v, 1e-3, 3);
    Body as_before = body;
    const double grown = energy_growth(body, .9 * limit, count(20000, scale));
    const double diverged = energy_growth(as_before, .9 * of_whole, 400);
    rows.push_back({text("%s, block that falls into its elements", name_of(elements)),
                    "limit found anew, not below the element bound: energy within 1 % at 0.9 of "
                    "it, which grows at 0.9 of the whole block's",
                    text("limit %.2f times shorter; energy %+.2f %%; %s", of_whole / limit,
                         100 * grown, diverged > 1 ? "grows" : "kept"),
                    grown < .01 && diverged > 1 && limit > .999 * bound});
  }
  return rows;
}

// A block that rests on its foot, and from then on hangs from it.
std::vector<StabilityRow> gravity_flip(double scale) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both) {
    const Mesh mesh = block(elements, 4, .15);
    std::vector<FixedMask> fixed;
    for (const Vec3& X : mesh.X) fixed.push_back(X.z() < 1e-9 ? 7 : 0);
    Body body = make_body(mesh, {.materials = {{MaterialModel::neo_hookean, 3000, .45, 1000}},
                                 .solver = {.gravity = Vec3(0, 0, -9.81)},
                                 .fixed = fixed});
    const bool is_at_rest = relax(body.model, {}, body.state, body.scratch).is_converged;
    const double height = centre_of(body);
    body.model.options.gravity *= -1;
    const double weight = 9.81 * sum(body.model.mass);
    double start = 0, largest_miss = 0, top = height, swing = 0;
    for (int k = 0; k < count(20000, scale); ++k) {
      const double dt = .85 * watch(body.model, body.part, body.state).stable_step;
      const double lift = weight * (centre_of(body) - height);
      const double energy = step_and_measure(body, dt) - lift;
      if (k == 0) start = energy;
      top = std::max(top, centre_of(body));
      swing = std::max(swing, lift);
      largest_miss = larger_or_nan(largest_miss, std::abs(energy - start));
    }
    rows.push_back(
        {text("%s, block at rest in its weight, which is turned round", name_of(elements)),
         "energy within 1 % of what the weight turns over",
         text("%.2f %%, swings up by %.1f mm", 100 * largest_miss / swing, 1e3 * (top - height)),
         is_at_rest && is_finite(body) && largest_miss < .01 * swing});
  }
  return rows;
}

std::vector<StabilityRow> non_finite_values(double) {
  std::vector<StabilityRow> rows;
  for (const bool is_velocity : {false, true}) {
    Body body = make_body(block(BoxElements::tet4_kuhn, 3, .1));
    (is_velocity ? body.state.v : body.state.u)[3 * 17 + 1] =
        std::numeric_limits<double>::quiet_NaN();
    const Watch w = watch(body.model, body.part, body.state);
    rows.push_back({text("a NaN %s at node 17", is_velocity ? "velocity" : "displacement"),
                    "the watch of the frame names the node", text("node %d", w.bad_node),
                    !w.is_finite && w.bad_node == 17});
  }
  return rows;
}

}  // namespace trocar
