// Smooth indentation of a soft block, .1 x .1 x .05 m: the bottom is clamped, the top moves by
// u_z = -.01 exp(-r^2 / (2 .012^2)) and not sideways. A quarter between mirror planes is computed.
#include <cmath>

#include "study/study_statics.h"

namespace trocar {

namespace {

constexpr double layer_half_width = .05, layer_height = .05;

Outcome solve_indentation(const Case& c) {
  const StaticBox box = {
      .size = {layer_half_width, layer_half_width, layer_height},
      .n = {c.n, c.n, c.n},
      .material = {MaterialModel::neo_hookean, 3000, .49, 1000},
      .fixed =
          [](const Vec3& X) {
            if (X.z() < 1e-9) return FixedMask{7};
            return static_cast<FixedMask>((X.x() < 1e-9 ? 1 : 0) | (X.y() < 1e-9 ? 2 : 0));
          },
      .moved = [](const Vec3& X) -> std::optional<Vec3> {
        if (X.z() < layer_height - 1e-9) return std::nullopt;
        const double r2 = X.x() * X.x() + X.y() * X.y();
        return Vec3(0, 0, -.01 * std::exp(-r2 / (2 * .012 * .012)));
      }};
  return relax_box(c, box, [](const StudyBody& body) {
    return 4 * reaction_above(body, layer_height - 1e-9).z();
  });
}

}  // namespace

Problem problem_indentation() {
  return {.name = "indentation",
          .title = "Smooth indentation of a soft block",
          .quantity = "force on the indenter",
          .unit = "N",
          .reference = -.9730,
          .reference_error = .0003 / .9730,
          .source = "implicit mixed solver of third order, refined",
          .sizes = {4, 8, 16, 24},
          .size_meaning = "cells over the half width of 50 mm",
          .methods = solid_methods(),
          .factors = {1},
          .solve = solve_indentation};
}

}  // namespace trocar
