// Blocks of tissue and what the stability cases measure on them.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <limits>

#include "larger_or_nan.h"
#include "solver/frequency.h"
#include "solver_body.h"
#include "stability.h"

namespace trocar {

inline std::string text(const char* format, ...) __attribute__((format(printf, 1, 2)));
inline std::string text(const char* format, ...) {
  char line[240];
  va_list values;
  va_start(values, format);
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  return line;
}

constexpr double edge = .01;  // of a cell [m]

inline Mesh block(BoxElements elements, int n, double irregularity) {
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3::Constant(n * edge), {n, n, n}, elements);
  if (irregularity > 0) jitter(mesh, irregularity, 5);
  return mesh;
}

inline const char* name_of(BoxElements elements) {
  return elements == BoxElements::hex8 ? "hex8" : "tet4";
}

constexpr BoxElements both[] = {BoxElements::hex8, BoxElements::tet4_kuhn};

// 2 / omega of the present deformation.
inline double limit_of(Body& body, double tolerance = 1e-3) {
  return 2 / search_frequency(body, {.amplitude = search_amplitude(body.model, edge),
                                     .tolerance = tolerance,
                                     .most_iterations = 300})
                 .omega;
}

inline double kinetic(const Body& body) {
  double sum = 0;
  for (std::size_t k = 0; k < body.state.v.size(); ++k)
    sum += .5 * body.model.mass[k / 3] * body.state.v[k] * body.state.v[k];
  return sum;
}

inline bool is_finite(const Body& body) {
  return std::isfinite(largest(body.state.u)) && std::isfinite(largest(body.state.v));
}

inline int count(double full, double scale) {
  return std::max(1, static_cast<int>(full * scale));
}

// Largest energy of n steps over that of the first one; looked at every 16th step.
inline double energy_growth(Body& body, double dt, int n) {
  double start = 0, most = 0;
  for (int k = 0; k < n; ++k) {
    if (k % 16 != 1) {
      step(body, dt);
      continue;
    }
    const double energy = step_and_measure(body, dt);
    if (k == 1) start = energy;
    most = larger_or_nan(most, energy);
  }
  return is_finite(body) ? most / start - 1 : std::numeric_limits<double>::infinity();
}

inline Vec3 momentum_of(const Body& body) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < body.state.v.size(); ++k)
    sum[static_cast<Eigen::Index>(k % 3)] += body.model.mass[k / 3] * body.state.v[k];
  return sum;
}

}  // namespace trocar
