// The bodies of the benches of a step.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "mesh/renumber.h"
#include "solver_body.h"

namespace trocar {

// A cube whose nodes are moved by up to a part of a cell: with a tenth no element is a
// parallelepiped. Tetrahedra in the order in which a tissue has them.
inline Mesh jittered_body(Formulation formulation, int n_elements, double part = .1) {
  const ElementType shape = shape_of(formulation);
  const int per_cell = shape == ElementType::tet4 ? 6 : (shape == ElementType::tri3 ? 2 : 1);
  const bool is_plane = shape == ElementType::tri3;
  const int n = std::max(
      1,
      static_cast<int>(std::lround(std::pow(n_elements / per_cell, is_plane ? 1. / 2 : 1. / 3))));
  Mesh mesh =
      is_plane ? make_rectangle(.1, .1, n, n)
               : make_box(Vec3(0, 0, 0), Vec3(.1, .1, .1), {n, n, n},
                          shape == ElementType::hex8 ? BoxElements::hex8 : BoxElements::tet4_kuhn);
  std::uint64_t seed = 1;
  for (Vec3& X : mesh.X)
    for (int j = 0; j < (is_plane ? 2 : 3); ++j) {
      seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
      X[j] += .1 / n * (static_cast<double>(seed >> 11) * 0x1p-53 - .5) * 2 * part;
    }
  return interleaved(mesh);
}

// How nodes and elements are numbered: as in a box; elements some ten places from where they were,
// so that none stand in rows (solver/row_order.h); anyhow, as in a bad file; that renumbered; and
// as in a box whose nodes stay in place, so that all elements are boxes along the axes.
enum class Numbering { box, near_box, any, renumbered, aligned };
inline constexpr std::array<const char*, 5> numbering_name = {"box", "near box", "any",
                                                              "renumbered", "aligned box"};

// For benches alone: what belongs to single elements stays behind.
inline void exchange_elements(Mesh& mesh, std::size_t a, std::size_t b) {
  const auto n = static_cast<std::size_t>(n_corners(mesh.element_type.front()));
  std::swap_ranges(&mesh.corner_node[n * a], &mesh.corner_node[n * a] + n,
                   &mesh.corner_node[n * b]);
}

inline Mesh numbered_body(Numbering numbering, Formulation formulation, int n_elements) {
  Mesh mesh = jittered_body(formulation, n_elements, numbering == Numbering::aligned ? 0 : .1);
  if (numbering == Numbering::box || numbering == Numbering::aligned) return mesh;
  std::mt19937_64 random(1);
  const std::size_t n = mesh.element_type.size();
  const std::size_t reach = numbering == Numbering::near_box ? 16 : n;
  for (std::size_t e = 0; e < n; ++e)
    exchange_elements(mesh, e, std::min(e + random() % reach, n - 1));
  if (numbering == Numbering::near_box) return mesh;
  std::vector<std::int32_t> number(mesh.X.size());
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), random);
  const std::vector<Vec3> X = mesh.X;
  for (std::size_t i = 0; i < X.size(); ++i) mesh.X[std::size_t(number[i])] = X[i];
  for (std::int32_t& i : mesh.corner_node) i = number[std::size_t(i)];
  return numbering == Numbering::any ? mesh : interleaved(renumbered(mesh));
}

}  // namespace trocar
