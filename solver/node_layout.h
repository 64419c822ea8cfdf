// Whether nodal fields of the kernels lie node by node or component by component
// (Model::is_by_component): these are quicker where most blocks of hexahedra stand in rows of a
// box. Nodes of a row follow each other at every corner, so that whole registers are loaded and
// added; where a row ends within a block, the next one begins behind its last node, which lanes
// skip, or further on, where a layer of the box ends. ElementBlocks::row_break (row_order.h): the
// first lane of the second row; all lanes, if one row has them; 0: they stand anyhow. Where several
// threads meet, places of some pairs of neighbouring corners stand anyhow.
#pragma once

#include "solver/model.h"
#include "solver/stash.h"

namespace trocar {

// Decides, of a model whose runs and targets are known.
void lay_out_nodes(Model& model);

// Of a model that is laid out: which blocks hold rows of boxes along the axes alone, which are
// computed for less (element_hex8.h).
void mark_aligned(const Mesh& mesh, const Part& part, Model& model);

// Of Scratch::sum, BlockTask::sum_stride; 0: node by node.
inline std::int64_t sum_stride(const Model& model) {
  return model.is_by_component ? component_stride(model.sums.n_places) : 0;
}
inline std::int64_t n_sums(const Model& model) {
  return model.is_by_component ? 3 * sum_stride(model) : 4 * model.sums.n_places;
}

}  // namespace trocar
