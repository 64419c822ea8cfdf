// Where on its edge a new node is put: the parts of its elements decide.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/sort_unique.h"
#include "cutting/cut_chips.h"
#include "cutting/cut_split.h"
#include "cutting/cut_thin.h"

namespace trocar {

// A new node keeps this part of its edge to either side, and more by steps where the floor wants
// it.
static constexpr double least_part = 0.3, more_part = 0.1, half = 0.5;

static double part_of(const EdgeNode& node) {
  return std::min(node.s, 1 - node.s);
}

static void set_part(double part, EdgeNode& node) {
  node.s = node.s < half ? part : 1 - part;
}

namespace {

// The least step bound of an element's parts, and the new nodes on its edges, ascending.
struct PartsOfElement {
  double step = std::numeric_limits<double>::infinity();  // [m]
  std::vector<std::size_t> node{};
};

}  // namespace

static PartsOfElement parts_of(const Mesh& mesh, std::span<const EdgeNode> nodes,
                               const ElementSplit& split) {
  PartsOfElement parts;
  for (const std::array<std::int32_t, 4>& tet : split.tets()) {
    std::array<Vec3, 4> X;
    for (std::size_t k = 0; k < 4; ++k) {
      if (tet[k] < mesh.n_nodes()) {
        X[k] = mesh.X[tet[k]];
        continue;
      }
      const auto n = static_cast<std::size_t>(tet[k] - mesh.n_nodes());
      parts.node.push_back(n);
      X[k] = position_of(mesh, nodes[n]);
    }
    parts.step = std::min(parts.step, step_bound(X, {0, 1, 2, 3}));
  }
  sort_unique(parts.node);
  return parts;
}

// Moves nodes of elements whose parts lie below the floor to the middle of their edges, those
// farthest from it first. A node that doesn't get there goes, and its edge stays whole.
static void keep_floor(const Mesh& mesh, std::span<const std::int32_t> element, double floor,
                       std::vector<EdgeNode>& nodes) {
  const auto part = [&](std::size_t n) { return part_of(nodes[n]); };
  std::vector<std::int32_t> unsure(element.begin(), element.end());
  for (;;) {
    const MeshEdit edit = split_edges(mesh, unsure, nodes);
    std::vector<std::int32_t> below;
    std::vector<std::size_t> too_near;
    for (const ElementSplit& split : edit.splits) {
      const PartsOfElement parts = parts_of(mesh, nodes, split);
      if (parts.step >= floor) continue;
      below.push_back(split.element);
      too_near.push_back(*std::ranges::min_element(parts.node, {}, part));
    }
    if (too_near.empty()) return;
    sort_unique(too_near);
    const auto in_middle =
        std::ranges::find_if(too_near, [&](std::size_t n) { return part(n) == half; });
    const bool is_one_gone = in_middle != too_near.end();
    if (is_one_gone) too_near = {*in_middle};
    std::vector<EdgeNode> changed;
    for (const std::size_t n : too_near) {
      changed.push_back(nodes[n]);
      set_part(std::min(half, part_of(nodes[n]) + more_part), nodes[n]);
    }
    if (is_one_gone) nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(too_near.front()));
    unsure = std::move(below);
    for (const ElementSplit& split : split_edges(mesh, element, std::move(changed)).splits)
      unsure.push_back(split.element);
    sort_unique(unsure);
  }
}

std::vector<EdgeNode> nodes_in_slices(const Mesh& mesh, const CutSurroundings& around,
                                      const std::vector<ThinSlice>& slices, double floor) {
  std::vector<EdgeNode> nodes;
  for (const ThinSlice& slice : slices)
    if (slice.V >= chip_volume * around.h * around.h * around.h)
      nodes.insert(nodes.end(), slice.crossing.begin(), slice.crossing.end());
  sort_unique_by(nodes, &EdgeNode::end);
  for (EdgeNode& node : nodes) set_part(std::max(least_part, part_of(node)), node);
  keep_floor(mesh, around.patch.element, floor, nodes);
  return nodes;
}

}  // namespace trocar
