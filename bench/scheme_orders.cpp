#include "bench/scheme_orders.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <span>
#include <utility>

#include "base/box.h"
#include "mesh/renumber.h"

namespace trocar {

namespace {

using Numbers = std::vector<std::int32_t>;

Numbers numbers_to(std::size_t n) {
  Numbers numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

Mesh shuffled(const Mesh& mesh) {
  std::mt19937_64 random(1);
  Numbers nodes = numbers_to(mesh.X.size()), elements = numbers_to(mesh.element_type.size());
  std::shuffle(nodes.begin(), nodes.end(), random);
  std::shuffle(elements.begin(), elements.end(), random);
  return in_orders(mesh, nodes, elements);
}

constexpr int curve_bits = 16;  // of a coordinate

// Place on Hilbert's curve through a cube of 2^curve_bits cells a side (Skilling 2004, Programming
// the Hilbert curve).
std::uint64_t place_on_curve(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1U << (curve_bits - 1); q > 1; q >>= 1)
    for (std::uint32_t& of_axis : x) {
      const std::uint32_t t = (x[0] ^ of_axis) & (q - 1);
      const bool is_inverted = (of_axis & q) != 0;
      x[0] ^= is_inverted ? q - 1 : t;
      if (!is_inverted) of_axis ^= t;
    }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1U << (curve_bits - 1); q > 1; q >>= 1)
    if ((x[2] & q) != 0) t ^= q - 1;
  std::uint64_t place = 0;
  for (int bit = curve_bits - 1; bit >= 0; --bit)
    for (const std::uint32_t of_axis : x) place = place << 1 | ((of_axis ^ t) >> bit & 1);
  return place;
}

std::uint64_t place_in(const Box& box, const Vec3& at) {
  const Vec3 share = (at - box.low) / box.size().maxCoeff();
  std::array<std::uint32_t, 3> cell;
  for (int j = 0; j < 3; ++j)
    cell[static_cast<std::size_t>(j)] =
        static_cast<std::uint32_t>(std::floor(share[j] * ((1 << curve_bits) - 1)));
  return place_on_curve(cell);
}

Numbers sorted_by(const std::vector<std::uint64_t>& key) {
  Numbers order = numbers_to(key.size());
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return std::pair(key[a], a) < std::pair(key[b], b);
  });
  return order;
}

Mesh along_curve(const Mesh& mesh) {
  const Box box = bounding_box(mesh.X);
  std::vector<std::uint64_t> of_node, of_element;
  for (const Vec3& at : mesh.X) of_node.push_back(place_in(box, at));
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    of_element.push_back(place_in(box, element_centre(mesh, e)));
  return in_orders(mesh, sorted_by(of_node), sorted_by(of_element));
}

}  // namespace

Mesh in_order(MeshOrder order, const Mesh& mesh) {
  switch (order) {
    case MeshOrder::given:
      return interleaved(mesh);
    case MeshOrder::shuffled:
      return shuffled(mesh);
    case MeshOrder::cuthill_mckee:
      return interleaved(renumbered(mesh));
    case MeshOrder::hilbert:
      return interleaved(along_curve(mesh));
  }
  return mesh;
}

}  // namespace trocar
