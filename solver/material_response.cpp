#include "solver/material_response.h"

#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "solver/material_setup.h"
#include "solver/material_stress.h"

namespace trocar {

namespace {

// A displacement gradient H = F - I and how F changes along the path.
struct PathPoint {
  Mat3 H = Mat3::Zero(), dF = Mat3::Zero();
};

// F = diag(s, 1/sqrt(s), 1/sqrt(s))
PathPoint stretched(double s) {
  const double across = 1 / std::sqrt(s);
  return {.H = Vec3(s - 1, across - 1, across - 1).asDiagonal(),
          .dF = Vec3(1, -0.5 * across / s, -0.5 * across / s).asDiagonal()};
}

// F = I + g e1 (x) e2
PathPoint sheared(double g) {
  PathPoint point;
  point.H(0, 1) = g;
  point.dF(0, 1) = 1;
  return point;
}

// P : dF/ds, the nominal stress that does the work of the path. [Pa]
double stress_along(const Material& material, const PathPoint& at) {
  return first_piola_stress(material, unit_fibre(material), at.H).cwiseProduct(at.dF).sum();
}

constexpr double grows = std::numeric_limits<double>::infinity();

// The first of `n` steps from `from` to `to` in which stress moves against them; `grows` if none.
template <class Path>
double first_softening(const Material& material, Path path, double from, double to) {
  constexpr int n = 80;
  double before = stress_along(material, path(from));
  for (int k = 1; k <= n; ++k) {
    const double s = from + (to - from) * k / n;
    const double stress = stress_along(material, path(s));
    if (!((stress - before) * (to - from) > 0)) return s;
    before = stress;
  }
  return grows;
}

}  // namespace

std::string softening_of(const Material& material) {
  if (material.model == MaterialModel::linear ||
      material.model == MaterialModel::st_venant_kirchhoff)
    return {};
  std::string text;
  const auto look = [&](double at, const char* strain) {
    if (text.empty() && at < grows)
      text = std::string("its stress falls beyond a ") + strain + " of " + short_text(at);
  };
  look(first_softening(material, stretched, 1, largest_stretch), "stretch");
  look(first_softening(material, stretched, 1, least_stretch), "compression to a stretch");
  look(first_softening(material, sheared, 0, largest_shear), "shear");
  return text;
}

}  // namespace trocar
