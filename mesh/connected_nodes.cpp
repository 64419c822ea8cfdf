#include "mesh/connected_nodes.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/disjoint_sets.h"
#include "mesh/equal_points.h"

namespace trocar {

std::vector<std::int32_t> connected_nodes(const Mesh& mesh,
                                          std::span<const std::int32_t> elements) {
  DisjointSets pieces(mesh.X.size());
  for (const std::int32_t e : elements) {
    const std::span<const std::int32_t> corner = mesh.corners(e);
    for (const std::int32_t node : corner.subspan(1)) pieces.join(corner[0], node);
  }
  return std::move(pieces).roots();
}

std::vector<std::int32_t> connected_nodes(const Mesh& mesh) {
  std::vector<std::int32_t> all(mesh.element_type.size());
  std::iota(all.begin(), all.end(), 0);
  return connected_nodes(mesh, all);
}

std::int32_t count_pieces(const Mesh& mesh) {
  return count_pieces(connected_nodes(mesh));
}

std::int32_t count_pieces(std::span<const std::int32_t> piece) {
  std::int32_t n = 0;
  for (std::size_t i = 0; i < piece.size(); ++i) n += std::cmp_equal(piece[i], i) ? 1 : 0;
  return n;
}

std::int32_t count_unjoined(const Mesh& mesh, std::span<const std::int32_t> piece,
                            double tolerance) {
  std::vector<Vec3> rounded;
  for (const Vec3& X : mesh.X) rounded.push_back((X / tolerance).array().round());
  const std::vector<std::int32_t> first = first_equal(rounded);
  std::vector<std::uint8_t> is_unjoined(mesh.X.size());
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i)
    if (piece[i] != piece[first[i]]) is_unjoined[i] = is_unjoined[first[i]] = 1;
  return static_cast<std::int32_t>(std::count(is_unjoined.begin(), is_unjoined.end(), 1));
}

}  // namespace trocar
