// Motions of bodies: stepping to a time, periods of modes from their amplitudes.
#pragma once

#include <functional>

#include "verification_statics.h"

namespace trocar {

// Adds to scratch.force at the present time; empty: nothing.
using AddForce = std::function<void(Body& body)>;

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

void forced_step(Body& body, double dt, const AddForce& add_force = {});

// Steps to time t with `factor` of the stable step of the deformed elements, looked at every 20
// steps; calls after_step(body) after each.
template <class AfterStep>
void advance(Body& body, double t, double factor, const AfterStep& after_step) {
  while (body.state.time < t * (1 - 1e-12)) {
    const double left = t - body.state.time;
    const double stable = factor * watch(body.model, body.part, body.state).stable_step;
    const int n = static_cast<int>(std::ceil(left / stable));
    for (int k = 0; k < std::min(n, 20); ++k) {
      forced_step(body, left / n);
      after_step(body);
    }
  }
}

void advance(Body& body, double t, double factor);

template <class Field>
void set_velocity(Body& body, const Field& field) {
  for (std::int32_t i = 0; i < body.model.n_owned; ++i) {
    const Vec3 v = field(body.mesh.X[i]);
    for (int j = 0; j < 3; ++j) body.state.v[3 * i + j] = v[j];
  }
}

// Share of a mode in the displacement.
template <class Mode>
double amplitude(const Body& body, const Mode& mode) {
  double dot = 0, norm = 0;
  for (std::int32_t i = 0; i < body.model.n_owned; ++i) {
    const Vec3 m = mode(body.mesh.X[i]);
    dot += body.mass[i] * m.dot(Vec3::Map(&body.state.u[3 * i]));
    norm += body.mass[i] * m.squaredNorm();
  }
  return dot / norm;
}

// From the first and the 21st zero crossing of a small free vibration that starts in the mode: over
// ten periods, because the mode of the mesh differs a little from the exact one.
template <class Mode>
double measured_period(Body& body, const Mode& mode, double factor) {
  displace(body, [&](const Vec3& X) { return Vec3(1e-6 * mode(X)); });
  const double dt = factor * least_element_step(body);
  std::vector<double> crossings;
  double before = amplitude(body, mode);
  while (crossings.size() < 21) {
    step(body, dt);
    const double now = amplitude(body, mode);
    if (before * now <= 0) crossings.push_back(body.state.time - dt * now / (now - before));
    before = now;
  }
  return (crossings[20] - crossings[0]) / 10;
}

// log2 of the ratio of errors of a mesh and of one twice as fine.
double order_between(double coarse, double fine);

}  // namespace trocar
