// The order in which a step adds up the corner forces of nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model.h"

namespace trocar {

struct NodeMotion;

// Fills model.sums and the lists' targets; the model has its blocks and nodes. As many runs as
// there are threads now.
void order_sums(Model& model);

// The same after an edit of a model whose sums were in order before it, around which no element
// reads halo nodes. Where no other run meets the nodes, in time of the edit's but for copies of
// whole numbers and a look at rows. nodes: local numbers of owned ones that meet other elements
// than before, ascending; blocks: all those with elements at these nodes.
void edit_sums(std::span<const std::int32_t> nodes, std::span<const BlockPlace> blocks,
               Model& model);

// Blocks with corners that are not among the first n_owned nodes; ascending.
std::vector<BlockPlace> blocks_with_halo(const Model& model, std::int32_t n_owned);

// (n_lists + 1) The first block of each list, counted through all lists, and their end.
std::vector<std::int64_t> first_blocks(const Model& model);
// Of a block, counted so.
std::int32_t run_of(std::int64_t block, const SumOrder& sums);

inline std::int64_t corners_of_block(const ElementBlocks& blocks) {
  return std::ssize(blocks.corner) / blocks.n_blocks;
}

// [corner][lane] Where the corner forces of a block are added.
inline const std::int32_t* targets(const ElementBlocks& blocks, std::int64_t block) {
  const std::int64_t n = corners_of_block(blocks);
  if (blocks.target_block.empty() || blocks.target_block[block] < 0)
    return blocks.corner.data() + block * n;
  return blocks.target.data() + blocks.target_block[block] * n;
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

// Adds the sums of consecutive places, from `place` on, at their nodes; stride: sum_stride.
void add_places(double* sum, std::int64_t stride, std::int64_t place,
                std::span<const std::int32_t> node);
void add_places(float* sum, std::int64_t stride, std::int64_t place,
                std::span<const std::int32_t> node);

// Calls body(list, lane) in the order of the sums: region, formulation, global element number,
// padding after the element that it repeats. However the elements are spread over ranks, a node
// meets its own in this order.
template <class Body>
void for_lanes_in_order(const std::vector<ElementBlocks>& lists, const Body& body) {
  for (std::size_t list = 0; list < lists.size(); ++list)
    for (std::int64_t lane = 0; lane < std::ssize(lists[list].element_local); ++lane)
      body(list, lane);
}

}  // namespace trocar
