// The order in which a step adds up the corner forces of nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model.h"

namespace trocar {

struct NodeMotion;

// Fills model.sums and the lists' targets; the model has its blocks and nodes. As many runs inside
// and at the border as there are threads now.
void order_sums(Model& model);

// The same after an edit of a model whose sums were in order before it. Where no other run meets
// the nodes and no list that reads halo nodes, in time of the edit's but for copies of whole
// numbers and a look at rows. nodes: local numbers of owned ones that meet other elements than
// before, ascending; blocks: all those with elements at these nodes.
void edit_sums(std::span<const std::int32_t> nodes, std::span<const BlockPlace> blocks,
               Model& model);

// (n_lists + 1) The first block of each list, counted through all lists, and their end.
std::vector<std::int64_t> first_blocks(const Model& model);
// Of a block, counted so.
std::int32_t run_of(std::int64_t block, const SumOrder& sums);

inline std::int64_t corners_of_block(const ElementBlocks& blocks) {
  return std::ssize(blocks.corner) / blocks.n_blocks;
}

// Where the corner forces of a list are added.
inline const std::vector<std::int32_t>& targets(const ElementBlocks& blocks) {
  return blocks.target.empty() ? blocks.corner : blocks.target;
}

// Calls body(the sums of the model's precision).
template <class Body>
void with_sums(const Model& model, Scratch& scratch, const Body& body) {
  if (model.options.precision == Precision::in_single)
    body(scratch.sum_single);
  else
    body(scratch.sum);
}

// scratch.force of nodes whose sums are complete; the sums become zero. nodes: ascending. With a
// motion, they move instead.
void finish_nodes(const Model& model, std::span<const std::int32_t> node, Scratch& scratch,
                  const NodeMotion* motion = nullptr);

// Lists of the same region and formulation are one behind the other, in the order of the sums; the
// one that reads halo nodes second.
std::vector<std::size_t> lists_in_order(const std::vector<ElementBlocks>& lists);

inline bool are_one_kind(const ElementBlocks& a, const ElementBlocks& b) {
  return a.region == b.region && a.formulation == b.formulation;
}

// Calls body(list, lane) in the order of the sums: region, formulation, global element number,
// padding after the element that it repeats. However the elements are spread over ranks and lists,
// a node meets its own in this order.
template <class Body>
void for_lanes_in_order(const std::vector<ElementBlocks>& lists, const Body& body) {
  const std::vector<std::size_t> order = lists_in_order(lists);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t a = order[k];
    const bool is_pair = k + 1 < order.size() && are_one_kind(lists[a], lists[order[k + 1]]);
    const std::size_t b = is_pair ? order[++k] : a;
    const auto& first = lists[a].element_local;
    const auto& second = lists[b].element_local;
    const std::size_t n = first.size(), m = is_pair ? second.size() : 0;
    for (std::size_t i = 0, j = 0; i < n || j < m;)
      if (j == m || (i < n && first[i] < second[j]))
        body(a, static_cast<std::int64_t>(i++));
      else
        body(b, static_cast<std::int64_t>(j++));
  }
}

}  // namespace trocar
