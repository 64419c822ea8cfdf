#include "mesh/element_boxes.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "base/check.h"
#include "base/sort_unique.h"

namespace trocar {

namespace {

constexpr std::size_t leaf_size = 16;

// Leaves [begin, end) get the elements from first[begin] to first[end].
void split(std::span<const Vec3> middle, std::size_t begin, std::size_t end, ElementBoxes& boxes) {
  if (end - begin == 1) return;
  const std::size_t half = begin + (end - begin) / 2;
  const auto at = [&](std::size_t leaf) { return boxes.order.begin() + boxes.first[leaf]; };
  Box box;
  for (auto e = at(begin); e != at(end); ++e) box.add(middle[*e]);
  Eigen::Index axis = 0;
  box.size().maxCoeff(&axis);
  std::nth_element(at(begin), at(half), at(end), [&](std::int32_t a, std::int32_t b) {
    return middle[a][axis] < middle[b][axis];
  });
  split(middle, begin, half, boxes);
  split(middle, half, end, boxes);
}

template <class Body>
void for_elements_of_leaf(const ElementBoxes& boxes, std::size_t leaf, const Body& body) {
  for (std::int32_t k = boxes.first[leaf]; k < boxes.first[leaf + 1]; ++k) body(boxes.order[k]);
  const std::size_t n_ordered = boxes.order.size();
  for (std::int32_t e = boxes.last_added[leaf]; e >= 0; e = boxes.next_added[e - n_ordered])
    body(e);
}

void fit_leaf(const Mesh& mesh, std::size_t leaf, ElementBoxes& boxes) {
  Box& box = boxes.box[boxes.first.size() - 1 + leaf];
  box = {};
  for_elements_of_leaf(boxes, leaf,
                       [&](std::int32_t e) { box.add(element_box(mesh, e, boxes.x)); });
}

void fit_parent(std::size_t k, ElementBoxes& boxes) {
  boxes.box[k] = boxes.box[2 * k];
  boxes.box[k].add(boxes.box[2 * k + 1]);
}

// The tetrahedra of a split, all but the first, which takes its place, join its leaf.
void split_elements(std::span<const ElementSplit> splits, ElementBoxes& boxes) {
  for (const ElementSplit& split : splits) {
    const std::int32_t leaf = boxes.leaf[split.element];
    for (std::int32_t k = 1; k < split.n_tets; ++k) {
      boxes.leaf.push_back(leaf);
      std::int32_t& last = boxes.last_added[leaf];
      boxes.next_added.push_back(last);
      last = static_cast<std::int32_t>(boxes.leaf.size()) - 1;
    }
  }
}

double mean_size(const Mesh& mesh, std::span<const Vec3> x) {
  double sum = 0;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    sum += element_box(mesh, e, x).size().maxCoeff();
  return sum / std::max(1, mesh.n_elements());
}

}  // namespace

Box element_box(const Mesh& mesh, std::int32_t e, std::span<const Vec3> x) {
  Box box;
  for (const std::int32_t i : mesh.corners(e)) box.add(x[i]);
  return box;
}

ElementBoxes make_element_boxes(const Mesh& mesh, std::span<const Vec3> x) {
  const auto n = static_cast<std::size_t>(mesh.n_elements());
  const std::size_t n_leaves = std::bit_ceil(n / leaf_size + 1);
  ElementBoxes boxes{.order = std::vector<std::int32_t>(n),
                     .first = std::vector<std::int32_t>(n_leaves + 1),
                     .leaf = std::vector<std::int32_t>(n),
                     .last_added = std::vector<std::int32_t>(n_leaves, -1),
                     .box = std::vector<Box>(2 * n_leaves),
                     .size = mean_size(mesh, x)};
  std::iota(boxes.order.begin(), boxes.order.end(), 0);
  for (std::size_t k = 0; k <= n_leaves; ++k)
    boxes.first[k] = static_cast<std::int32_t>(n * k / n_leaves);
  std::vector<Vec3> middle(n);
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) middle[e] = element_box(mesh, e, x).middle();
  split(middle, 0, n_leaves, boxes);
  for (std::size_t leaf = 0; leaf < n_leaves; ++leaf)
    for (std::int32_t k = boxes.first[leaf]; k < boxes.first[leaf + 1]; ++k)
      boxes.leaf[boxes.order[k]] = static_cast<std::int32_t>(leaf);
  fit_element_boxes(mesh, x, boxes);
  return boxes;
}

void update_element_boxes(const Mesh& mesh, std::span<const Vec3> x, const BoxesEdit& edit,
                          ElementBoxes& boxes) {
  split_elements(edit.splits, boxes);
  CHECK_OP(boxes.leaf.size(), ==, mesh.element_type.size());
  boxes.x.resize(x.size());
  for (const std::int32_t i : edit.nodes) boxes.x[i] = x[i];
  std::vector<std::int32_t> changed;  // places in the tree
  for (const std::int32_t e : edit.elements) changed.push_back(boxes.leaf[e]);
  sort_unique(changed);
  for (const std::int32_t leaf : changed) fit_leaf(mesh, static_cast<std::size_t>(leaf), boxes);
  for (std::int32_t& k : changed) k += static_cast<std::int32_t>(boxes.first.size()) - 1;
  while (!changed.empty() && changed.front() > 1) {  // all of one level
    for (std::int32_t& k : changed) k /= 2;
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const std::int32_t k : changed) fit_parent(static_cast<std::size_t>(k), boxes);
  }
}

bool are_outrun(const ElementBoxes& boxes, double way) {
  return way > 0.5 * boxes.size;
}

void fit_element_boxes(const Mesh& mesh, std::span<const Vec3> x, ElementBoxes& boxes) {
  boxes.x.assign(x.begin(), x.end());
  const std::size_t n_leaves = boxes.first.size() - 1;
  for (std::size_t leaf = 0; leaf < n_leaves; ++leaf) fit_leaf(mesh, leaf, boxes);
  for (std::size_t k = n_leaves; --k > 0;) fit_parent(k, boxes);
}

// may_meet: asked of boxes in the tree.
template <class MayMeet>
static std::vector<std::int32_t> elements_of_leaves(const ElementBoxes& boxes,
                                                    const MayMeet& may_meet) {
  std::vector<std::int32_t> near;
  std::vector<std::size_t> stack{1};
  const std::size_t n_leaves = boxes.first.size() - 1;
  while (!stack.empty()) {
    const std::size_t k = stack.back();
    stack.pop_back();
    if (!may_meet(boxes.box[k])) continue;
    if (k < n_leaves) {
      stack.insert(stack.end(), {2 * k, 2 * k + 1});
      continue;
    }
    for_elements_of_leaf(boxes, k - n_leaves, [&](std::int32_t e) { near.push_back(e); });
  }
  sort_unique(near);
  return near;
}

static double margin_of(double way) {
  return way * (1 + 1e-12);  // its own rounding
}

std::vector<std::int32_t> elements_near(const Box& box, double way, const ElementBoxes& boxes) {
  return elements_of_leaves(boxes,
                            [&](const Box& leaf) { return leaf.overlaps(box, margin_of(way)); });
}

std::vector<std::int32_t> elements_near(const OrientedBox& box, double way,
                                        const ElementBoxes& boxes) {
  return elements_of_leaves(boxes,
                            [&](const Box& leaf) { return box.may_overlap(leaf, margin_of(way)); });
}

}  // namespace trocar
