// Displacements of chosen material points in any mesh of the same body, by linear interpolation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace trocar {

struct SamplePoint {
  std::array<std::int32_t, 4> node{};  // -1: there is no such corner
  std::array<double, 4> weight{};      // barycentric
};

// Finds the simplex that holds each point (hexahedra count as the tetrahedra of hex_split.h). For a
// point outside, which curved surfaces leave, the nearby simplex whose least weight is largest
// extrapolates.
std::vector<SamplePoint> locate_samples(const Mesh& mesh, std::span<const Vec3> points);

// u (n_nodes * 3).
Vec3 interpolate(const SamplePoint& sample, std::span<const double> u);

// Evenly chosen nodes of the surface, at most `n_most`.
std::vector<Vec3> surface_points(const Mesh& mesh, std::size_t n_most);

}  // namespace trocar
