// An elastic layer bonded to its ground, into which something rigid is pressed.
#pragma once

namespace trocar {

inline constexpr double layer_E = 3000, layer_nu = .49;
inline constexpr double plane_strain_E = layer_E / (1 - layer_nu * layer_nu);
// What its thickness adds to the half space (Dimitriadis et al. 2002, eq. 12, 13).
inline constexpr double alpha0 =
    -(1.2876 - 1.4678 * layer_nu + 1.3442 * layer_nu * layer_nu) / (1 - layer_nu);
inline constexpr double beta0 =
    (.6387 - 1.0277 * layer_nu + 1.5164 * layer_nu * layer_nu) / (1 - layer_nu);

}  // namespace trocar
