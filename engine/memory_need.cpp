#include "engine/memory_need.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/heap.h"
#include "base/host.h"
#include "base/number_text.h"

namespace trocar {

namespace {

constexpr double of_program = 30e6, of_node = 250;  // [bytes]
constexpr double surely = 0.8;                      // of what is expected

double bytes_of_hexahedron(const SceneSolver& solver) {
  const bool is_single = solver.precision == Precision::in_single;
  if (solver.hexahedron == Formulation::hex8_full) return is_single ? 510 : 850;
  return is_single ? 210 : 400;
}

std::string gigabytes(double bytes) {
  return short_text(bytes / 1e9) + " GB";
}

}  // namespace

BodySize size_of(const SceneShape& shape) {
  const bool is_plane =
      shape.kind == ShapeKind::rectangle || shape.kind == ShapeKind::triangular_rectangle;
  const std::int64_t x = shape.cells[0], y = shape.kind == ShapeKind::cylinder ? x : shape.cells[1],
                     z = shape.cells[2];
  if (is_plane) return {.n_nodes = x * y, .n_others = 2 * (x - 1) * (y - 1)};  // nodes a side
  const std::int64_t a = x, b = shape.kind == ShapeKind::ball ? x : y,
                     c = shape.kind == ShapeKind::ball ? x : z;
  BodySize size{.n_nodes = (a + 1) * (b + 1) * (c + 1)};
  if (shape.elements == BoxElements::hex8)
    size.n_hexahedra = a * b * c;
  else
    size.n_others = (shape.elements == BoxElements::tet4_kuhn ? 6 : 5) * a * b * c;
  return size;
}

BodySize size_of(const Mesh& mesh) {
  const auto n = std::ranges::count(mesh.element_type, ElementType::hex8);
  return {.n_nodes = mesh.n_nodes(), .n_hexahedra = n, .n_others = mesh.n_elements() - n};
}

MemoryNeed memory_need(const BodySize& size, const SceneSolver& solver, int n_ranks) {
  const double of_other = solver.precision == Precision::in_single ? 140 : 190;
  const double of_elements = bytes_of_hexahedron(solver) * static_cast<double>(size.n_hexahedra) +
                             of_other * static_cast<double>(size.n_others);
  return {.of_whole = of_program + of_node * static_cast<double>(size.n_nodes),
          .of_part = of_elements / n_ranks};
}

double memory_for_a_rank(const Communicator& communicator) {
  const std::vector<std::string> hosts = communicator.all_gather(host_name());
  const auto here = static_cast<double>(std::ranges::count(hosts, host_name()));
  return communicator.all_min(std::min(memory_of_host() / here, memory_of_process()));
}

void check_memory(const BodySize& size, const SceneSolver& solver, int n_ranks, double left) {
  const MemoryNeed need = memory_need(size, solver, n_ranks);
  const double whole = need.of_whole + need.of_part;
  if (surely * whole <= left) return;
  const std::string where = n_ranks == 1 ? "" : " on each of " + std::to_string(n_ranks) + " ranks";
  throw SharedMachineError(
      "a body of " + std::to_string(size.n_nodes) + " nodes and " +
      std::to_string(size.n_hexahedra + size.n_others) + " elements needs about " +
      gigabytes(whole) + where + ", " + gigabytes(need.of_whole) +
      " of it for the mesh, which every rank holds, and " + gigabytes(need.of_part) +
      " for its part of the model, but only " + gigabytes(left) +
      " are free: take a coarser mesh, solver.precision = \"single\", or more hosts");
}

}  // namespace trocar
